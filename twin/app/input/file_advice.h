#pragma once

#include <string>

#include "models/base/error.h"
#include "scenes/pile.h"

namespace tubetwin {

/// Which verb takes a file of that name, as a line of its own for the message of one that does not;
/// empty where none does.
std::string AdviceFor(const std::string& file);

/// LoadPile(), whose refusal says which verb takes the file instead.
Pile LoadGivenPile(const std::string& file, const PileOverrides& overrides);

}  // namespace tubetwin
