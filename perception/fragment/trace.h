#pragma once

#include <vector>

#include "models/base/polyline.h"
#include "perception/fragment/axis_space.h"

namespace tubetwin {

/// A component, or a part of one, in order along its curve.
struct Trace {
  Polyline line_N;          ///< Means of successive slices.
  std::vector<int> voxels;  ///< Of space.voxels, those near the line.
};

/// Orders the voxels of one component by their distance, measured within the component, from one of
/// its two remotest voxels. Branches that lie off the resulting curve are traced as curves of their
/// own. Pieces shorter than `shortest_m` are dropped.
std::vector<Trace> TraceComponent(const AxisSpace& space, const std::vector<int>& component,
                                  double step_m, double shortest_m);

}  // namespace tubetwin
