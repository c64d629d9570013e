#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tubetwin {

/// What `--units` takes: "m", "mm", "cm", "in".
const std::vector<std::string>& LengthUnits();

/// Metres per unit, by one of LengthUnits() or as people write it ("millimetres", "Inch"); nothing
/// for any other word.
std::optional<double> MetresPer(std::string_view unit);

/// Metres per unit that a comment of a file states: its words are "units" or "unit", perhaps with
/// ":" or "=", and a unit ("units: mm"). Nothing for any other comment.
std::optional<double> UnitOfComment(const std::vector<std::string_view>& words);

}  // namespace tubetwin
