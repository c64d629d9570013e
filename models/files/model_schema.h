#pragma once

#include <string>
#include <vector>

namespace tubetwin {

/// JSON Schema (draft 2020-12) of a file that describes a cell, one of its devices or a part: type,
/// unit, allowed values and meaning of every key, its default, or that it is required. What no
/// single key can say (rows that must rise, masses that fit their inertia) the readers check.
/// `kind`: one of ModelFileKinds(). Throws Error(kUsage) for another.
std::string ModelFileSchema(const std::string& kind);

/// "cell", "arm", "gripper", "wrist", "scanner", "part".
std::vector<std::string> ModelFileKinds();

}  // namespace tubetwin
