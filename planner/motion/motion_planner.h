#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hw_bridge/cell/checked_trajectory.h"
#include "models/clearance.h"

namespace tubetwin {

/// Why and where a motion was refused. Nothing was sent anywhere.
struct MotionRejection {
  enum class Why { kUnreachable, kJointLimit, kSingular, kJump, kCollision, kLimits };
  Why why = Why::kUnreachable;
  std::string reason;     ///< "leg 1 of 3 at 42 %: finger 3.1 mm from bin wall, 5.0 asked"
  double fraction = 0.0;  ///< Of the whole motion, 0 to 1.
  int joint = -1;         ///< 0-based, -1 when it is no single joint's fault.
};
using MotionResult = std::variant<CheckedTrajectory, MotionRejection>;

/// How a motion may run. A value; copy and change what differs.
struct MotionOptions {
  // Limits of E along the path: linear, and angular where the path turns. Joint limits slow the
  // whole segment further. Joint moves keep the linear ones too.
  double speed_m_s = 0.50;
  double acceleration_m_s2 = 2.5;
  double jerk_m_s3 = 30.0;
  double turn_speed_rad_s = 1.5;
  double turn_acceleration_rad_s2 = 6.0;
  double turn_jerk_rad_s3 = 60.0;
  /// Share of the arm's joint speed, acceleration and jerk limits that may be used.
  double joint_speed_share = 0.8;
  double joint_acceleration_share = 0.9;

  /// Between the pads, for the clearance of the fingers; fully open when not given.
  std::optional<double> opening_m;
  /// Smallest clearance of everything but the fingers in the bin. A start that is nearer already is
  /// allowed as long as the motion does not go nearer still.
  double clearance_m = 0.005;
  /// Smallest clearance of the fingers to the bin's floor and walls: 0.001 for the way to a grasp,
  /// whose pads end 2 mm over the floor.
  double finger_clearance_m = 0.005;
  double joint_margin_rad = 0.035;  ///< Kept to every joint limit (2 degrees).
  double manipulability = 0.02;     ///< Smallest one along lines and tilts (models/arm/arm.h).
  /// Transfers only: height of E over the bin floor while travelling; the layout's carry height
  /// when not given.
  std::optional<double> travel_height_m;
};

struct FollowContext;

/// Plans every motion of the cell: straight lines, tilts, joint moves, transfers. Each result runs
/// from rest to rest, was followed sample by sample with one branch of the inverse kinematics, is
/// free of collision and jerk limited, and is sampled every 10 ms. Immutable; thread safe.
///
///     const MotionPlanner motion(cell.model, cell.bin);
///     const MotionResult result = motion.PlanLine(q, X_BE_above, options);
///     if (const auto* rejection = std::get_if<MotionRejection>(&result)) ...
class MotionPlanner {
 public:
  /// `model` must outlive this; the bin is copied.
  MotionPlanner(const CellModel& model, const Bin& bin);

  /// Straight line of E with the orientation turning evenly (slerp) on the same path parameter.
  MotionResult PlanLine(const JointVector& q_start, const RigidTransform& X_BE_goal,
                        const MotionOptions& options) const;

  /// Straight lines through all poses, standing still at each.
  MotionResult PlanPolyline(const JointVector& q_start, const std::vector<RigidTransform>& X_BE,
                            const MotionOptions& options) const;

  /// E stands still while the tool turns by `rotation_B` (axis times angle in radians, frame B).
  MotionResult PlanTilt(const JointVector& q_start, const Vector3& rotation_B,
                        const MotionOptions& options) const;

  /// All joints together along a straight line in joint space.
  MotionResult PlanJoint(const JointVector& q_start, const JointVector& q_goal,
                         const MotionOptions& options) const;

  /// From anywhere to anywhere: E straight up to the travel height, a joint move in the working
  /// family to above the goal (higher when something is in the way), straight down to the goal. The
  /// goal's tool points down, nearly.
  MotionResult PlanTransfer(const JointVector& q_start, const RigidTransform& X_BE_goal,
                            const MotionOptions& options) const;

  /// Joints of the working family with E at X_BE (tool pointing down, nearly); q6 the nearest to
  /// `q6_near_rad`. Nothing when out of reach or beyond the limits less 2 degrees.
  std::optional<JointVector> Reach(const RigidTransform& X_BE, double q6_near_rad = 0.0) const;

  /// Where a transfer to X_BE begins its way straight down: over the goal at the travel height, or
  /// at the goal where that is higher.
  RigidTransform OverGoal(const RigidTransform& X_BE, const MotionOptions& options) const;

  /// X_BE at joints q.
  RigidTransform PoseOfE(const JointVector& q) const;

  /// X_BE that puts the scanner at X_BS; for one on a stand, where the tool is out of its view.
  RigidTransform PoseOfEForScan(const RigidTransform& X_BS) const;

  const CellModel& model() const { return model_; }
  const ClearanceChecker& clearance() const { return clearance_; }

 private:
  FollowContext Following(const MotionOptions& options) const;

  const CellModel& model_;
  const ArmModel& arm_;
  const CellLayout& layout_;
  Bin bin_;
  ClearanceChecker clearance_;
};

/// Joints at the end of a trajectory.
inline JointVector EndOf(const CheckedTrajectory& trajectory) {
  return trajectory.trajectory().points.back().q;
}

}  // namespace tubetwin
