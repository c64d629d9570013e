#pragma once

#include <vector>

#include "planner/scene_query/object_path.h"

namespace tubetwin {

/// Poses of the tool at the waypoints after the first, X_NE, when it holds a tube at `X_NE_grasp`
/// and the tube goes along `way`. Where the tool does not point down at the end, it then turns
/// about E, the shortest way, until it does: that is how it weighs and places.
std::vector<RigidTransform> ToolPath(const ObjectPath& way, const RigidTransform& X_NE_grasp);

/// Whether the tool points down, to within 0.01 rad: below what weighing would notice. In N or B.
bool PointsDown(const RigidTransform& X_NE);

/// The pose turned about E, the shortest way, until the tool points down; unchanged where it does
/// to within 0.01 rad.
RigidTransform Upright(const RigidTransform& X_NE);

/// A tool's way in two parts, between which the load is weighed for the first time.
struct SplitPath {
  std::vector<RigidTransform> first, rest;
};
/// Cut where E has gone `cut_m` of the legs from `X_NE_grasp` on; where the tool turns in the leg
/// that would be cut or does not point down after it, at the first pose later that points down.
SplitPath SplitAt(const std::vector<RigidTransform>& X_NE, const RigidTransform& X_NE_grasp,
                  double cut_m);

}  // namespace tubetwin
