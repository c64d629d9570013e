#pragma once

#include <functional>

#include "models/base/config/config.h"
#include "models/base/json_fwd.h"

namespace tubetwin {

/// Sets the fields that a visit list names from a JSON object; absent ones keep their values.
/// Throws Error(kBadData) naming file and path for an unknown key, a wrong type or a value outside
/// its range.
void ReadJsonInto(const JsonView& object, const std::function<void(ConfigVisitor&)>& visit);

/// All fields of a visit list as a JSON object, in the list's order.
Json WriteJson(const std::function<void(ConfigVisitor&)>& visit);

}  // namespace tubetwin
