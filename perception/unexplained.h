#pragma once

#include <vector>

#include "perception/tube_scene.h"

namespace tubetwin {

/// Cells of 5 mm, with at least a few of `points_N` each, that lie on no tube. `points_N`: what is
/// neither floor nor wall.
int CountUnexplained(const std::vector<Eigen::Vector3f>& points_N,
                     const std::vector<PerceivedTube>& tubes, double radius_m);

}  // namespace tubetwin
