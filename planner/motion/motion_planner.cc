#include "planner/motion/motion_planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "models/base/error.h"
#include "planner/motion/path_follow.h"

namespace tubetwin {
namespace {

using Why = MotionRejection::Why;
using Segment = std::variant<JointTrajectory, MotionRejection>;

constexpr double kNoMove_m = 1e-7;
constexpr double kNoTurn_rad = 1e-7;
constexpr double kRaise_m = 0.05;  // a blocked transfer is tried this much higher
constexpr int kRaises = 3;

/// The limits of E as limits of a path parameter that runs from 0 to 1.
PathLimits LineLimits(const MotionOptions& o, double length_m, double angle_rad) {
  const double length = std::max(length_m, 1e-6), angle = std::max(angle_rad, 1e-6);
  return {std::min(o.speed_m_s / length, o.turn_speed_rad_s / angle),
          std::min(o.acceleration_m_s2 / length, o.turn_acceleration_rad_s2 / angle),
          std::min(o.jerk_m_s3 / length, o.turn_jerk_rad_s3 / angle)};
}

JointTrajectory StandStill(const JointVector& q) {
  TrajectoryPoint a, b;
  a.q = b.q = q;
  b.time_s = 0.01;
  return {{a, b}};
}

Segment FollowAndTime(const FollowContext& context, const JointPath& path,
                      const JointVector& q_start, const PathLimits& limits) {
  const auto followed = FollowPath(context, path, q_start);
  if (const auto* rejection = std::get_if<MotionRejection>(&followed)) return *rejection;
  return TimePath(context, path, std::get<std::vector<PathPoint>>(followed), limits);
}

Segment LineSegment(const FollowContext& context, const JointVector& q_start, const Vector3& move_B,
                    const Vector3& rotation_B) {
  const double length_m = move_B.norm(), angle_rad = rotation_B.norm();
  if (length_m < kNoMove_m && angle_rad < kNoTurn_rad) return StandStill(q_start);
  const RigidTransform X_BE_start = FlangePose(context.arm, q_start) * context.X_FE;
  const LinePath path(context.arm, context.X_FE, X_BE_start, move_B, rotation_B);
  return FollowAndTime(context, path, q_start, LineLimits(context.options, length_m, angle_rad));
}

Segment LineSegmentTo(const FollowContext& context, const JointVector& q_start,
                      const RigidTransform& X_BE_goal) {
  const RigidTransform X_BE_start = FlangePose(context.arm, q_start) * context.X_FE;
  const Eigen::AngleAxisd turn(Matrix3(X_BE_goal.linear() * X_BE_start.linear().transpose()));
  return LineSegment(context, q_start, X_BE_goal.translation() - X_BE_start.translation(),
                     turn.angle() * turn.axis());
}

Segment JointSegment(const FollowContext& context, const JointVector& q_start,
                     const JointVector& q_goal) {
  const JointVector move = q_goal - q_start;
  if (move.cwiseAbs().maxCoeff() < kNoTurn_rad) return StandStill(q_start);
  const MotionOptions& o = context.options;
  const StraightJointPath path(context.arm, context.X_FE, q_start, q_goal);
  PathLimits limits = LineLimits(o, path.LargestStepOfE(), 0.0);
  for (int i = 0; i < kNumJoints; ++i) {
    const ArmModel::Joint& joint = context.arm.joints[i];
    const double step = std::max(std::abs(move[i]), 1e-9);
    const double share = o.joint_acceleration_share;
    limits.speed = std::min(limits.speed, o.joint_speed_share * joint.max_speed_rad_s / step);
    limits.acceleration =
        std::min(limits.acceleration, share * joint.max_acceleration_rad_s2 / step);
    limits.jerk = std::min(limits.jerk, share * joint.max_jerk_rad_s3 / step);
  }
  return FollowAndTime(context, path, q_start, limits);
}

/// Segments run one after the other, standing still in between.
class Chain {
 public:
  Chain(const ArmModel& arm, const JointVector& q_start, int legs)
      : arm_(arm), q_(q_start), legs_(legs) {}

  /// Where the next segment starts.
  const JointVector& q() const { return q_; }

  /// False when the segment was refused; Take() then says why and where.
  bool Add(Segment segment) {
    if (const auto* refused = std::get_if<MotionRejection>(&segment)) {
      rejection_ = *refused;
      const std::string leg =
          legs_ == 1 ? ""
                     : "leg " + std::to_string(leg_ + 1) + " of " + std::to_string(legs_) + " ";
      rejection_.reason = leg + "at " + std::to_string(std::lround(100 * refused->fraction)) +
                          " %: " + refused->reason;
      rejection_.fraction = (leg_ + refused->fraction) / legs_;
      return false;
    }
    const auto& points = std::get<JointTrajectory>(segment).points;
    const double offset_s = all_.duration_s();
    for (std::size_t i = all_.points.empty() ? 0 : 1; i < points.size(); ++i) {
      all_.points.push_back(points[i]);
      all_.points.back().time_s += offset_s;
    }
    q_ = all_.points.back().q;
    ++leg_;
    return true;
  }

  MotionResult Take() {
    if (!rejection_.reason.empty()) return rejection_;
    auto checked = CheckTrajectory(arm_, std::move(all_));
    if (const auto* refused = std::get_if<TrajectoryRejection>(&checked)) {
      return MotionRejection{Why::kLimits, refused->reason, 0.0, refused->joint};
    }
    return std::get<CheckedTrajectory>(std::move(checked));
  }

 private:
  const ArmModel& arm_;
  JointVector q_;
  int legs_, leg_ = 0;
  JointTrajectory all_;
  MotionRejection rejection_;
};

RigidTransform AtHeight(RigidTransform X_BE, double z_m) {
  X_BE.translation().z() = z_m;
  return X_BE;
}

}  // namespace

MotionPlanner::MotionPlanner(const CellModel& model, const Bin& bin)
    : model_(model), arm_(model.arm), layout_(model.layout), bin_(bin), clearance_(model, bin) {}

FollowContext MotionPlanner::Following(const MotionOptions& options) const {
  return {arm_, layout_.X_FE, clearance_, options,
          options.opening_m.value_or(model_.gripper.stroke_m)};
}

RigidTransform MotionPlanner::PoseOfE(const JointVector& q) const {
  return FlangePose(arm_, q) * layout_.X_FE;
}

RigidTransform MotionPlanner::OverGoal(const RigidTransform& X_BE,
                                       const MotionOptions& options) const {
  const double travel_z_m =
      bin_.X_BN.translation().z() + options.travel_height_m.value_or(layout_.carry_height_m);
  return AtHeight(X_BE, std::max(travel_z_m, X_BE.translation().z()));
}

RigidTransform MotionPlanner::PoseOfEForScan(const RigidTransform& X_BS) const {
  if (layout_.scanner_mount == CellLayout::ScannerMount::kStand) {
    return MakeTransform(RotX(kPi), layout_.p_BClear);
  }
  const RigidTransform X_SE = layout_.X_FS.inverse() * layout_.X_FE;
  return X_BS * X_SE;
}

std::optional<JointVector> MotionPlanner::Reach(const RigidTransform& X_BE,
                                                double q6_near_rad) const {
  const auto inverse = InverseWorking(arm_, X_BE * layout_.X_FE.inverse(), q6_near_rad);
  if (inverse.status != InverseNearResult::Status::kFound) return std::nullopt;
  const double margin = MotionOptions().joint_margin_rad;
  for (int i = 0; i < kNumJoints; ++i) {
    if (inverse.q[i] < arm_.joints[i].lower_rad + margin) return std::nullopt;
    if (inverse.q[i] > arm_.joints[i].upper_rad - margin) return std::nullopt;
  }
  return inverse.q;
}

MotionResult MotionPlanner::PlanLine(const JointVector& q_start, const RigidTransform& X_BE_goal,
                                     const MotionOptions& options) const {
  const FollowContext context = Following(options);
  Chain chain(arm_, q_start, 1);
  chain.Add(LineSegmentTo(context, q_start, X_BE_goal));
  return chain.Take();
}

MotionResult MotionPlanner::PlanPolyline(const JointVector& q_start,
                                         const std::vector<RigidTransform>& X_BE,
                                         const MotionOptions& options) const {
  TT_CHECK(!X_BE.empty());
  const FollowContext context = Following(options);
  Chain chain(arm_, q_start, static_cast<int>(X_BE.size()));
  for (const RigidTransform& goal : X_BE) {
    if (!chain.Add(LineSegmentTo(context, chain.q(), goal))) break;
  }
  return chain.Take();
}

MotionResult MotionPlanner::PlanTilt(const JointVector& q_start, const Vector3& rotation_B,
                                     const MotionOptions& options) const {
  const FollowContext context = Following(options);
  Chain chain(arm_, q_start, 1);
  chain.Add(LineSegment(context, q_start, Vector3::Zero(), rotation_B));
  return chain.Take();
}

MotionResult MotionPlanner::PlanJoint(const JointVector& q_start, const JointVector& q_goal,
                                      const MotionOptions& options) const {
  const FollowContext context = Following(options);
  Chain chain(arm_, q_start, 1);
  chain.Add(JointSegment(context, q_start, q_goal));
  return chain.Take();
}

MotionResult MotionPlanner::PlanTransfer(const JointVector& q_start,
                                         const RigidTransform& X_BE_goal,
                                         const MotionOptions& options) const {
  const FollowContext context = Following(options);
  const RigidTransform X_BE_start = PoseOfE(q_start);
  const double travel_z_m =
      bin_.X_BN.translation().z() + options.travel_height_m.value_or(layout_.carry_height_m);
  std::optional<MotionResult> first;
  for (int raise = 0; raise <= kRaises; ++raise) {
    const double z_m = travel_z_m + raise * kRaise_m;
    const double start_z_m = std::max(z_m, X_BE_start.translation().z());
    const double above_z_m = std::max(z_m, X_BE_goal.translation().z());
    const auto q_above = Reach(AtHeight(X_BE_goal, above_z_m), q_start[5]);
    if (!q_above) continue;
    Chain chain(arm_, q_start, 3);
    const bool done =
        chain.Add(LineSegmentTo(context, chain.q(), AtHeight(X_BE_start, start_z_m))) &&
        chain.Add(JointSegment(context, chain.q(), *q_above)) &&
        chain.Add(LineSegmentTo(context, chain.q(), X_BE_goal));
    MotionResult result = chain.Take();
    if (done) return result;
    if (!first) first = std::move(result);
  }
  if (!first) {
    return MotionRejection{Why::kUnreachable, "no joints put the tool above the goal", 0.34, -1};
  }
  return *std::move(first);
}

}  // namespace tubetwin
