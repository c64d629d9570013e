#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tubetwin {

/// The entry of `known` with the smallest edit distance to `name`; empty when `known` is empty.
std::string NearestName(std::string_view name, const std::vector<std::string>& known);

/// "a, b, c".
std::string Join(const std::vector<std::string>& parts, std::string_view separator = ", ");

/// Shortest decimal text that reads back as the same double ("0.25", "1e-05").
std::string Number(double value);

}  // namespace tubetwin
