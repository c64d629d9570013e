#pragma once

#include <string>

namespace tubetwin {

/// Fingerprint of the running program's own file: two builds that differ in a byte have different
/// ones, copies of one build the same. Read once. Throws as ReadFile().
const std::string& BuildId();

}  // namespace tubetwin
