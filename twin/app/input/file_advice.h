#pragma once

#include <string>
#include <vector>

#include "models/base/error.h"
#include "scenes/pile.h"

namespace tubetwin {

/// Which verb takes a file of that name, as a line of its own for the message of one that does not;
/// empty where none does.
std::string AdviceFor(const std::string& file);

/// As a line of its own for an Error(kConfig) about a TOML file of a command line that is of
/// another kind than was asked for: what it is, and what takes it. Empty where it is of no known
/// kind. `verb`: "tubetwin run"; `words`: the whole command line after the program's name.
std::string AdviceForWords(const std::string& message, const std::string& verb,
                           const std::vector<std::string>& words);

/// LoadPile(), whose refusal says which verb takes the file instead.
Pile LoadGivenPile(const std::string& file, const PileOverrides& overrides);

}  // namespace tubetwin
