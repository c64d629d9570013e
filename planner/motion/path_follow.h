#pragma once

#include <variant>
#include <vector>

#include "planner/motion/joint_path.h"
#include "planner/motion/motion_planner.h"

namespace tubetwin {

/// What following a path needs to know about the cell. References outlive the call.
struct FollowContext {
  const ArmModel& arm;
  const RigidTransform& X_FE;
  const ClearanceChecker& clearance;
  const MotionOptions& options;
  double opening_m;  ///< Between the pads.
};

/// Follows the path from q_start on one branch and checks limits, singularity, jumps and clearances
/// at every piece. The points of the path at equal steps of u, or why and where not.
std::variant<std::vector<PathPoint>, MotionRejection> FollowPath(const FollowContext& context,
                                                                 const JointPath& path,
                                                                 const JointVector& q_start);

/// Runs a followed path from rest to rest as fast as `limits` and the joints' shares of
/// `context.options` allow, sampled every 10 ms at most. `points` as FollowPath returned them.
JointTrajectory TimePath(const FollowContext& context, const JointPath& path,
                         const std::vector<PathPoint>& points, const PathLimits& limits);

}  // namespace tubetwin
