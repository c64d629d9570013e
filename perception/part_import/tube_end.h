#pragma once

#include <vector>

#include "models/base/frames.h"
#include "models/base/polyline.h"

namespace tubetwin {

/// A point moved inwards along its normal onto the axis it belongs to, and that normal (unit).
struct AxisPoint {
  Vector3 a, n;
};

/// Unit direction out of a line's first or last end, over its last `window_m` (or all of it).
Vector3 OutwardAt(const Polyline& line, bool first, double window_m);

/// Moves an end along `t` (unit, outwards) to where the axis points stop, those at most `beside_m`
/// beside it. Ends that are cut askew or rounded are measured in their middle: the furthest point
/// counts in each of eight sectors. Nodes less than half of `step_m` before the new end go.
void MoveEnd(Polyline& line, bool first, const Vector3& t, const std::vector<AxisPoint>& points,
             double radius_m, double beside_m, double step_m);

}  // namespace tubetwin
