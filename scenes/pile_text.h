#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/polyline.h"

namespace tubetwin {

/// A tube as the plain-text formats know it.
struct TextTube {
  int id = 0;
  Polyline centerline_N;
  double radius_m = 0.0;  ///< 0 where the file has none.
};

/// CSV with a header line that names at least tube, index, x, y and z, in any order, beside any
/// other columns; a `radius` is the tube's. Columns are set apart by comma, semicolon, tab or
/// blanks, decimal commas are read where they separate nothing. Indices count from 0 or 1 within
/// each tube; rows may come in any order (tubes then are sorted by id). Lengths are in `unit_m`
/// metres where given, else as the header says ("x_mm", "x [mm]"), else in metres. Throws
/// Error(kBadData) naming `source`, line, value and what is allowed.
std::vector<TextTube> ParsePileCsv(const std::string& text, const std::string& source,
                                   std::optional<double> unit_m = std::nullopt);

/// The public set's tube_configurations: tube count; per tube `id nodes edges`, node lines
/// `id x y z radius`, edge lines of 13 fields `name n1 n2 order radius centre quaternion length`;
/// the chain follows the edges by `order`. Branching tubes are refused. Throws like ParsePileCsv.
std::vector<TextTube> ParsePileConfiguration(const std::string& text, const std::string& source,
                                             std::optional<double> unit_m = std::nullopt);

}  // namespace tubetwin
