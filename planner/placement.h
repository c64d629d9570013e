#pragma once

#include "hw_bridge/base/frames.h"
#include "hw_bridge/base/polyline.h"
#include "models/layout.h"

namespace tubetwin {

/// Where a held tube goes: E over the slot, and where the tube should then lie.
struct PlacementPose {
  RigidTransform X_BE = RigidTransform::Identity();  ///< Tube's lowest point at the surface.
  Vector3 slot_centre_T = Vector3::Zero();           ///< Where the tube's centre is meant to be.
};

/// Direction of a tube from its own points: first principal axis, its sign along the end-to-end
/// chord; the chord itself where both largest axes are nearly equal (U shapes). Unit vector, frame
/// of `line`.
Vector3 PrincipalDirection(const Polyline& line);

/// Number of slots side by side on the tray.
int SlotCount(const CellLayout& layout);

/// Lays the `index`-th tube (from 0; slots are used again from the first when all are full) into
/// its slot: direction along the tray's y, centre on the slot's centre as far as E stays in its
/// zone. `line_E`: the held tube's centerline relative to E; tool vertical. Both senses of the
/// direction are equal for a tube: the yaw nearer to `yaw_near_rad` is taken.
PlacementPose PlanPlacement(const CellLayout& layout, const Polyline& line_E, double radius_m,
                            int index, double yaw_near_rad);

/// Yaw of a vertical tool: angle of E's x axis about B's z, with E's z pointing down.
double ToolYaw(const Matrix3& R_BE);
/// Rotation of a vertical tool with that yaw.
Matrix3 VerticalTool(double yaw_rad);

}  // namespace tubetwin
