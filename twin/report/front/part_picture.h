#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/polyline.h"
#include "models/bin.h"

namespace tubetwin {

/// Shapes of a part below each other as inline SVG, each turned so that most of it is seen, to
/// scale and with a measure. Empty without a shape of any length.
std::string PartPictureSvg(const std::vector<Polyline>& shapes, double radius_m);

/// A pile in its bin from above as inline SVG, to scale; the upper over the lower. Empty without
/// tubes.
std::string PilePictureSvg(const std::vector<Polyline>& tubes_N, double radius_m, const Bin& bin);

/// The same of what was perceived, in the colours of the classes (0 free, 1 weak, 2 strong), with a
/// ring where it is to be grasped.
struct SeenTube {
  Polyline line_N;
  int tube_class = 0;
  bool is_target = false;
};
std::string SeenPictureSvg(const std::vector<SeenTube>& tubes, const std::optional<Vector3>& p_NG,
                           const Bin& bin);

}  // namespace tubetwin
