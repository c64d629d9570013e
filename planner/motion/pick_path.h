#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hw_bridge/cell/devices.h"
#include "planner/motion/motion_planner.h"

namespace tubetwin {

// What arm and fingers do, as data: made once, checked whole, then run as it was checked. Search,
// ranking, picking, nudging, resolution, placing and recovery all describe their motions so and in
// no other way.

/// Where a straight segment ends, frame B: at the pose `X` of E; or, `relative`, where the
/// displacement `X` takes E from where the segment starts: X_BE_goal = X * X_BE_start.
struct PathGoal {
  RigidTransform X = RigidTransform::Identity();
  bool relative = false;

  RigidTransform X_BE(const RigidTransform& X_BE_start) const {
    return relative ? X * X_BE_start : X;
  }
};
/// E goes by `move_B` (metres) and keeps its orientation.
PathGoal By(const Vector3& move_B);
/// E goes to a pose.
PathGoal To(const RigidTransform& X_BE);

// The kinds of segments.

/// From anywhere to anywhere by MotionPlanner::PlanTransfer.
struct Transfer {
  RigidTransform X_BE = RigidTransform::Identity();
  bool direct = false;  ///< All joints straight to the goal where that is free.
};
/// E along straight lines through all goals, standing still at each. Relative goals count from the
/// segment's start, not from the goal before.
struct Follow {
  std::vector<PathGoal> goals;
};
/// One straight line that ends at contact: where the force along the motion exceeds the limit.
struct GuardedLine {
  PathGoal goal;
  double force_limit_N = 8.0;
};
/// E stands still while the tool turns by `rotation_B` (axis times angle in radians, frame B).
struct Turn {
  Vector3 rotation_B = Vector3::Zero();
};
/// The fingers move. `expected_opening_m`: between the pads afterwards, for the clearance of what
/// follows: that of the command, or what is to be held.
struct MoveFingers {
  GripperCommand command;
  double expected_opening_m = 0.0;
};
/// Time passes.
struct Pause {
  double duration_s = 0.0;
};

/// One segment: what is done, within which limits, and what it is called in refusals.
struct PathSegment {
  std::variant<Transfer, Follow, GuardedLine, Turn, MoveFingers, Pause> what;
  /// Limits and clearances of a motion; its opening is set by Check.
  MotionOptions options;
  std::string label;
  /// Stages are run one by one, so that something can be measured in between. They count from 0 in
  /// the order of the segments. Contact ends its stage.
  int stage = 0;
};

/// What arm and fingers do, segment by segment. An aggregate; makers are in planner/pick,
/// planner/resolution and planner/cycle.
struct PickPath {
  std::vector<PathSegment> segments;

  int num_stages() const { return segments.empty() ? 0 : segments.back().stage + 1; }
};

/// Where a path begins: the arm's joints and the opening between the pads.
struct PathStart {
  JointVector q = JointVector::Zero();
  double opening_m = 0.0;
};

/// A path every motion of which was planned and checked, each from where the one before ends. Only
/// Check makes one.
class CheckedPath {
 public:
  struct Segment {
    PathSegment segment;
    PathStart start;  ///< Where the arm then stands, by the plan.
    /// Of a motion; none: fingers and pauses.
    std::optional<CheckedTrajectory> trajectory;
  };
  const std::vector<Segment>& segments() const { return segments_; }
  int num_stages() const { return segments_.empty() ? 0 : segments_.back().segment.stage + 1; }
  /// Where the arm stands behind the last segment.
  const PathStart& end() const { return end_; }

 private:
  friend class PathChecker;
  std::vector<Segment> segments_;
  PathStart end_;
};

/// A checked path, or the first refusal: its reason begins with the segment's label.
using PathCheck = std::variant<CheckedPath, MotionRejection>;

/// Plans every motion of `path` from `start` on, with all limits and clearances that the planner
/// keeps. Pure; thread safe.
PathCheck Check(const MotionPlanner& planner, const PickPath& path, const PathStart& start);

/// What stands against a path from wherever the arm may be, for asking about many: its first
/// motion, which must be a transfer, is only checked from over its goal at carry height down to it.
/// Nothing: all of it can be run once the arm is there. Pure; thread safe.
std::optional<MotionRejection> RefusalFromOver(const MotionPlanner& planner, const PickPath& path);

/// One motion from `start`, as Check plans it. Precondition: the segment moves the arm.
MotionResult PlanSegment(const MotionPlanner& planner, const PathSegment& segment,
                         const PathStart& start);
/// Whether a segment moves the arm.
bool MovesArm(const PathSegment& segment);

/// What a check refused; nothing: it passed.
const MotionRejection* RefusalOf(const PathCheck& check);

}  // namespace tubetwin
