#pragma once

#include <vector>

#include "models/base/frames.h"
#include "models/base/json_fwd.h"

namespace tubetwin {

/// Where a tube goes from where it lies, frame N: at waypoint k every point p of it is at
/// pivot + waypoint + rotation * (p - pivot). The first waypoint is zero and not turned.
struct ObjectPath {
  std::vector<Vector3> waypoints_N;             ///< Of the pivot, metres.
  std::vector<Eigen::Quaterniond> rotations_N;  ///< One for each waypoint, or none: not turned.
  Vector3 pivot_N = Vector3::Zero();            ///< Without meaning where nothing turns.

  bool turns() const { return !rotations_N.empty(); }
};

/// The path of one of a scene's tubes.
struct TubePath : ObjectPath {
  int tube = 0;
};

/// Takes points from where they lie to where they are at waypoint `k`. Precondition: k exists.
RigidTransform PoseAt(const ObjectPath& path, std::size_t k);

/// Such poses along the path, the first and every waypoint among them. Between waypoints the pivot
/// goes straight and the rotation evenly; points within `reach_m` of the pivot move by `step_m` at
/// most from one pose to the next.
std::vector<RigidTransform> PosesAlong(const ObjectPath& path, double step_m, double reach_m);

/// Whether a rotation turns the vertical by more than an angle.
bool IsTurnedOver(const Eigen::Quaterniond& rotation, double more_than_deg = 1.0);
/// Whether the tube is turned over so far, by more than 45 degrees, that others slide off it.
bool ShedsByTilting(const ObjectPath& path);

/// Writes `waypoints_m` and, where the path turns, `rotations_wxyz` and `pivot_m` into an object.
void AddObjectPath(const ObjectPath& path, Json& json);
/// Reads what AddObjectPath wrote. Throws Error(kBadData).
ObjectPath ObjectPathFromJson(const JsonView& view);

}  // namespace tubetwin
