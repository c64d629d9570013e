#pragma once

#include <vector>

#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// One place for each cell of 5 mm, with at least a few of `points_N`, that lies on no tube, to a
/// tenth of a millimetre. `points_N`: what is neither floor nor wall.
std::vector<Vector3> FindUnexplained(const std::vector<Eigen::Vector3f>& points_N,
                                     const std::vector<PerceivedTube>& tubes, double radius_m);

}  // namespace tubetwin
