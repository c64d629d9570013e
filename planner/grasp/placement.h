#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "models/base/frames.h"
#include "models/base/polyline.h"
#include "models/layout.h"

namespace tubetwin {

/// Where a held tube goes: E over the slot, and where the tube should then lie.
struct PlacementPose {
  int slot = 0;  ///< Index in Slots().
  /// The tube touches what lies below it, or falls from as high as the fingers need.
  RigidTransform X_BE = RigidTransform::Identity();
  Vector3 slot_centre_T = Vector3::Zero();  ///< Where the tube's centre is meant to be.
  Polyline line_T;                          ///< The tube then, frame T.
  double raised_m = 0.0;  ///< How much higher than on the bare tray: it lies across another.
};

/// Direction of a tube from its own points: first principal axis, its sign along the end-to-end
/// chord; the chord itself where both largest axes are nearly equal (U shapes). Unit vector, frame
/// of `line`.
Vector3 PrincipalDirection(const Polyline& line);

/// Centres of the slots, frame T: 55 mm apart along the tray's x; two rows where `extent_y_m`, the
/// tube's size along the tray's y, leaves room for them, one otherwise.
std::vector<Vector3> Slots(const CellLayout& layout, double extent_y_m);

/// Chooses the slot and the sense of the tube's direction (both are equal) that keep the tube
/// farthest from those that lie already (`placed_T`) and from toppling off the tray, then the
/// smaller slot, then the smaller turn from `yaw_near_rad`. Its direction lies along the tray's y,
/// its centre on the slot's centre as far as E stays in its zone. `line_E`: the held tube's
/// centerline relative to E; tool vertical. `min_height_E_m`: as low as E may go over the tray.
/// Long pads that hold a tube high up let it fall by what they reach below it. `reachable` says
/// which poses of E the arm can take; nothing when it can take none.
std::optional<PlacementPose> PlanPlacement(
    const CellLayout& layout, const Polyline& line_E, double radius_m, double min_height_E_m,
    const std::vector<Polyline>& placed_T, double yaw_near_rad,
    const std::function<bool(const RigidTransform& X_BE)>& reachable);

/// Yaw of a vertical tool: angle of E's x axis about B's z, with E's z pointing down.
double ToolYaw(const Matrix3& R_BE);
/// Rotation of a vertical tool with that yaw.
Matrix3 VerticalTool(double yaw_rad);

}  // namespace tubetwin
