// Inverse kinematics of any arm: what its method finds, checked and put in order, and the choice
// among it.

#include <algorithm>
#include <cmath>
#include <optional>

#include "models/arm/arm.h"
#include "models/arm/inverse/geometry.h"
#include "models/arm/inverse/inverse_method.h"
#include "models/arm/inverse/pose_steps.h"
#include "models/base/rotation.h"

namespace tubetwin {
namespace {

constexpr double kSameSolution_rad = 1e-6;  // closer ones are one solution found twice
constexpr double kFamilyStep_rad = 0.035;   // InverseWorking: tilt per continuation step
constexpr double kFamilyJump_rad = 0.35;    // a larger joint step means another branch
constexpr double kFollowStep_m = 0.05;      // InverseWorking without all branches: per step
constexpr double kFollowStep_rad = 0.10;

/// Into (-pi, pi], or a full turn further where only that is within the limits.
void WrapIntoRange(const ArmModel& arm, JointVector& q) {
  for (int i = 0; i < kNumJoints; ++i) {
    q[i] = WrapToPi(q[i]);
    const double lower = arm.joints[i].lower_rad, upper = arm.joints[i].upper_rad;
    if (q[i] < lower && q[i] + 2 * kPi <= upper) q[i] += 2 * kPi;
    if (q[i] > upper && q[i] - 2 * kPi >= lower) q[i] -= 2 * kPi;
  }
}

/// Each joint moved by full turns to where it is nearest to q_near within [lower, upper] less the
/// margin; nothing when a joint has no place there.
std::optional<JointVector> NearestWithinLimits(const ArmModel& arm, const JointVector& q,
                                               const JointVector& q_near, double margin_rad) {
  JointVector out;
  for (int i = 0; i < kNumJoints; ++i) {
    double best = 0.0, best_distance = -1.0;
    for (int turn = -2; turn <= 2; ++turn) {
      const double value = q[i] + 2 * kPi * turn;
      if (value < arm.joints[i].lower_rad + margin_rad) continue;
      if (value > arm.joints[i].upper_rad - margin_rad) continue;
      const double distance = std::abs(value - q_near[i]);
      if (best_distance < 0.0 || distance < best_distance) {
        best = value;
        best_distance = distance;
      }
    }
    if (best_distance < 0.0) return std::nullopt;
    out[i] = best;
  }
  return out;
}

}  // namespace

std::vector<JointVector> InverseAll(const ArmModel& arm, const RigidTransform& X_BF) {
  const InverseMethod& method = MethodOf(arm);
  method.check(arm);  // Arms can be made without a file, too.
  std::vector<JointVector> solutions;
  for (JointVector q : method.solve(arm, X_BF)) {
    if (PoseError(FlangePose(arm, q), X_BF) > kPoseTolerance) {
      const auto polished = PolishJoints(arm, X_BF, q, 4);
      if (!polished) continue;
      q = *polished;
    }
    WrapIntoRange(arm, q);
    const bool known = std::any_of(
        solutions.begin(), solutions.end(),
        [&](const JointVector& other) { return LargestDifference(q, other) < kSameSolution_rad; });
    if (!known) solutions.push_back(q);
  }
  std::sort(solutions.begin(), solutions.end(), [](const JointVector& a, const JointVector& b) {
    return std::lexicographical_compare(a.data(), a.data() + kNumJoints, b.data(),
                                        b.data() + kNumJoints);
  });
  return solutions;
}

InverseNearResult InverseNear(const ArmModel& arm, const RigidTransform& X_BF,
                              const JointVector& q_near, double margin_rad) {
  using Status = InverseNearResult::Status;
  if (const auto q = PolishJoints(arm, X_BF, q_near, 6)) {
    if ((*q - q_near).cwiseAbs().maxCoeff() < kNewtonReach_rad) {
      const auto inside = NearestWithinLimits(arm, *q, q_near, margin_rad);
      if (inside && (*inside - *q).cwiseAbs().maxCoeff() < 1e-9) return {Status::kFound, *inside};
    }
  }
  const auto all = InverseAll(arm, X_BF);
  if (all.empty()) return {Status::kUnreachable, q_near};
  InverseNearResult best{Status::kOutsideLimits, q_near};
  double best_distance = 0.0;
  for (const JointVector& q : all) {
    const auto inside = NearestWithinLimits(arm, q, q_near, margin_rad);
    if (!inside) continue;
    const double distance = (*inside - q_near).cwiseAbs().maxCoeff();
    if (best.status == Status::kFound && distance >= best_distance) continue;
    best = {Status::kFound, *inside};
    best_distance = distance;
  }
  return best;
}

namespace {

/// The family's posture, turned about axis 1 until its wrist points to the target's.
JointVector PostureTowards(const ArmModel& arm, const Vector3& p_BW) {
  JointVector q = arm.working.q;
  const Vector3 p_BPosture = LinkPoses(arm, q)[kNumJoints].translation();
  const Vector3& p_B1 = arm.joints[0].origin_in_parent_m;
  q[0] += AngleAbout(arm.joints[0].axis, p_BPosture - p_B1, p_BW - p_B1);
  return q;
}

/// Where link 4 begins, seen from link 1.
Vector3 ForearmSeenFromTurret(const ArmModel& arm, const JointVector& q) {
  const auto X_BL = LinkPoses(arm, q);
  return X_BL[1].inverse() * X_BL[4].translation();
}

/// How far each joint is from the family's posture. Joint 1 follows the target, so what counts of
/// it is the side of axis 1 on which the forearm is: in front or behind.
JointVector FromPosture(const ArmModel& arm, const JointVector& q) {
  JointVector off;
  for (int i = 1; i < kNumJoints; ++i) off[i] = std::abs(WrapToPi(q[i] - arm.working.q[i]));
  off[0] = std::abs(AngleAbout(arm.joints[0].axis, ForearmSeenFromTurret(arm, arm.working.q),
                               ForearmSeenFromTurret(arm, q)));
  return off;
}

bool InFamily(const ArmModel& arm, const JointVector& q) {
  return (FromPosture(arm, q).array() <= arm.working.within_rad.array()).all();
}

/// The family's member among all solutions.
std::optional<JointVector> ChooseOfAll(const ArmModel& arm, const RigidTransform& X_BF) {
  std::optional<JointVector> best;
  double best_distance = 0.0;
  for (const JointVector& q : InverseAll(arm, X_BF)) {
    if (!InFamily(arm, q)) continue;
    const double distance = arm.working.weight.dot(FromPosture(arm, q));
    if (best && distance >= best_distance) continue;
    best = q;
    best_distance = distance;
  }
  return best;
}

/// From the posture to the pose by Newton steps along a straight way; nothing when that leaves the
/// reach, jumps or ends outside the family.
std::optional<JointVector> FollowFromPosture(const ArmModel& arm, const RigidTransform& X_BF,
                                             JointVector q) {
  RigidTransform X_BNow = FlangePose(arm, q);
  // The turn about the flange's axis is joint 6's alone.
  const Vector3 x_now = X_BNow.linear().transpose() * X_BF.linear().col(0);
  const Vector3 axis = arm.X_6F.linear().transpose() * arm.joints[kNumJoints - 1].axis;
  q[kNumJoints - 1] += std::copysign(1.0, axis.z()) * std::atan2(x_now.y(), x_now.x());
  X_BNow = FlangePose(arm, q);
  const Vector3 way = X_BF.translation() - X_BNow.translation();
  const Eigen::AngleAxisd turn(Matrix3(X_BF.linear() * X_BNow.linear().transpose()));
  const int steps =
      1 + static_cast<int>(std::max(way.norm() / kFollowStep_m, turn.angle() / kFollowStep_rad));
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const Matrix3 R = Eigen::AngleAxisd(share * turn.angle(), turn.axis()) * X_BNow.linear();
    const RigidTransform X_BNext =
        i == steps ? X_BF : MakeTransform(R, X_BNow.translation() + share * way);
    const auto next = PolishJoints(arm, X_BNext, q, 8);
    if (!next || (*next - q).cwiseAbs().maxCoeff() > kFamilyJump_rad) return std::nullopt;
    q = *next;
  }
  if (!InFamily(arm, q)) return std::nullopt;
  WrapIntoRange(arm, q);
  return q;
}

/// The family's member for a tool along the vertical.
std::optional<JointVector> WorkingVertical(const ArmModel& arm, const RigidTransform& X_BF,
                                           const Vector3& p_BW) {
  if (MethodOf(arm).costly) {
    if (const auto q = FollowFromPosture(arm, X_BF, PostureTowards(arm, p_BW))) return q;
  }
  return ChooseOfAll(arm, X_BF);
}

}  // namespace

InverseNearResult InverseWorking(const ArmModel& arm, const RigidTransform& X_BF,
                                 double q6_near_rad) {
  using Status = InverseNearResult::Status;
  // Tilt the tool back to the vertical about the wrist W (origin of the last link), where the
  // family is plain, and follow it from there.
  const Vector3 axis_B = X_BF.linear().col(2);
  const Vector3 pole_B = axis_B.z() > 0 ? Vector3::UnitZ() : Vector3(-Vector3::UnitZ());
  const Eigen::AngleAxisd tilt(RotationBetween(pole_B, axis_B));
  const Vector3 p_BW = (X_BF * arm.X_6F.inverse()).translation();
  const auto pose_at = [&](double share) {
    const Matrix3 R = Eigen::AngleAxisd((share - 1.0) * tilt.angle(), tilt.axis()).matrix();
    return Translation(p_BW) * MakeTransform(R, Vector3::Zero()) * Translation(-p_BW) * X_BF;
  };
  const auto start = WorkingVertical(arm, pose_at(0.0), p_BW);
  if (!start) return {Status::kUnreachable, JointVector::Zero()};
  JointVector q = *start;
  const int steps = tilt.angle() < 1e-9 ? 0 : 1 + static_cast<int>(tilt.angle() / kFamilyStep_rad);
  for (int i = 1; i <= steps; ++i) {
    const auto next = PolishJoints(arm, pose_at(static_cast<double>(i) / steps), q, 8);
    if (!next || (*next - q).cwiseAbs().maxCoeff() > kFamilyJump_rad) {
      return {Status::kUnreachable, JointVector::Zero()};
    }
    q = *next;
  }
  JointVector q_near = q;
  q_near[5] = q6_near_rad;
  const auto inside = NearestWithinLimits(arm, q, q_near, 0.0);
  if (!inside) return {Status::kOutsideLimits, q};
  return {Status::kFound, *inside};
}

}  // namespace tubetwin
