#pragma once

#include <string>
#include <vector>

#include "models/base/polyline.h"

namespace tubetwin {

/// A tube as the plain-text formats know it.
struct TextTube {
  int id = 0;
  Polyline centerline_N;
  double radius_m = 0.0;  ///< 0 where the format has none (CSV).
};

/// `tube,index,x,y,z` with that header line; indices count from 0 within a tube, a tube's rows
/// stand together. Throws Error(kBadData) naming `source`, line, value and what is allowed.
std::vector<TextTube> ParsePileCsv(const std::string& text, const std::string& source);

/// The public set's tube_configurations: tube count; per tube `id nodes edges`, node lines
/// `id x y z radius`, edge lines of 13 fields `name n1 n2 order radius centre quaternion length`;
/// the chain follows the edges by `order`. Branching tubes are refused. Throws like ParsePileCsv.
std::vector<TextTube> ParsePileConfiguration(const std::string& text, const std::string& source);

}  // namespace tubetwin
