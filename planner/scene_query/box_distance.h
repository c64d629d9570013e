#pragma once

#include "models/base/frames.h"
#include "models/base/polyline.h"

namespace tubetwin {

/// A box at X_AB in some frame A, metres.
struct OrientedBox {
  RigidTransform X_AB = RigidTransform::Identity();
  Vector3 half_m = Vector3::Zero();
};

/// Exact distance between a segment and a box, 0 when they meet. The squared distance along the
/// segment is convex and quadratic between the (at most six) points where it crosses a face plane,
/// so each piece is minimised in closed form.
double SegmentBoxDistance(const Vector3& p_AP, const Vector3& p_AQ, const OrientedBox& box);

/// Smallest distance of a line (at least one point) to a box; stops looking at pieces that cannot
/// come nearer than `enough_m` and returns at most that.
double LineBoxDistance(const Polyline& line_A, const OrientedBox& box, double enough_m);

/// Whether a point is inside.
bool Contains(const OrientedBox& box, const Vector3& p_AP);

}  // namespace tubetwin
