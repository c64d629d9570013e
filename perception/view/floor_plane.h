#pragma once

#include <optional>
#include <vector>

#include "models/base/frames.h"
#include "models/base/random.h"

namespace tubetwin {

/// Points of one or several views in one frame C, thinned, with the places that they were seen
/// from.
struct Sighting {
  std::vector<Vector3> p_C;
  std::vector<int> view_of;  ///< Of each point.
  /// Of each view; nothing where S is not the place that the points were seen from.
  std::vector<std::optional<Vector3>> eye_C;
};

/// A plane of frame C: normal . p = offset_m on it.
struct FloorPlane {
  Vector3 normal = Vector3::UnitZ();
  double offset_m = 0.0;
  double Height(const Vector3& p_C) const { return normal.dot(p_C) - offset_m; }
};

/// Points this close to a plane may be on it.
inline constexpr double kOnPlane_m = 0.003;

/// Least squares through those of the points that are within kOnPlane_m of `plane`.
FloorPlane Polished(const FloorPlane& plane, const std::vector<Vector3>& p_C);

/// Up to `count` planes with most points, by random triples, those of one plane taken away before
/// the next is looked for. The normal points to where the views were seen from; where that is not
/// known both directions are listed.
std::vector<FloorPlane> FindPlanes(const Sighting& sighting, int count, RandomStream stream);

/// Axes of a plane with z along its normal and x as far along C's x as it can be: X_CP.
RigidTransform PlaneFrame(const FloorPlane& plane);

}  // namespace tubetwin
