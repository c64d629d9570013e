#include "planner/cycle/motion_executor.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

constexpr double kPushed_rad = 0.0005;  ///< Far above the servo's own standing error.
constexpr double kSettle_s = 0.05;  ///< After a motion, before the next: the servo's lag dies out.

}  // namespace

MotionExecutor::MotionExecutor(Cell& cell)
    : cell_(cell), planner_(cell.arm_model, cell.layout, cell.bin), q_(cell.arm.State().q) {}

RigidTransform MotionExecutor::X_BE() const { return planner_.PoseOfE(q_); }

JointVector MotionExecutor::q() const { return q_; }

bool MotionExecutor::Reaches(const RigidTransform& X_BE) const {
  return planner_.Reach(X_BE, q_[5]).has_value();
}

JointVector MotionExecutor::Start() {
  // Something may have pushed the arm off where the last motion ended: go on from where it is.
  const JointVector measured = cell_.arm.State().q;
  if ((measured - q_).cwiseAbs().maxCoeff() > kPushed_rad) q_ = measured;
  return q_;
}

MotionOptions MotionExecutor::Options(double speed_m_s, double acceleration_m_s2) const {
  MotionOptions options;
  options.speed_m_s = speed_m_s;
  options.acceleration_m_s2 = least_ramp_s_ > 0.0
                                  ? std::min(acceleration_m_s2, speed_m_s / least_ramp_s_)
                                  : acceleration_m_s2;
  options.opening_m = opening_m_;
  options.finger_clearance_m = kFingerClearance_m;
  return options;
}

WaitOutcome MotionExecutor::Run(const MotionResult& planned, const char* what) {
  if (const auto* rejection = std::get_if<MotionRejection>(&planned)) {
    throw MoveFailure(MoveFailure::Kind::kRejected, std::string(what) + ": " + rejection->reason);
  }
  const CheckedTrajectory& trajectory = std::get<CheckedTrajectory>(planned);
  const WaitOutcome outcome = RunTrajectory(cell_, trajectory);
  if (outcome.status != WaitOutcome::Status::kDone) {
    throw MoveFailure(outcome, what);
  }
  q_ = EndOf(trajectory);
  Wait(cell_, kSettle_s);
  return outcome;
}

void MotionExecutor::Transfer(const RigidTransform& X_BE, double speed_m_s,
                              double acceleration_m_s2, bool either_yaw) {
  MotionOptions options = Options(speed_m_s, acceleration_m_s2);
  options.either_yaw = either_yaw;
  Run(planner_.PlanTransfer(Start(), X_BE, options), "transfer");
}

void MotionExecutor::Joint(const RigidTransform& X_BE, bool either_yaw) {
  MotionOptions options;
  options.opening_m = opening_m_;
  options.either_yaw = either_yaw;
  const auto q_goal = planner_.Reach(X_BE, q_[5]);
  if (q_goal) {
    const MotionResult direct = planner_.PlanJoint(Start(), *q_goal, options);
    if (std::holds_alternative<CheckedTrajectory>(direct)) {
      Run(direct, "joint move");
      return;
    }
  }
  Run(planner_.PlanTransfer(Start(), X_BE, options), "transfer");
}

void MotionExecutor::Line(const RigidTransform& X_BE, double speed_m_s, double acceleration_m_s2,
                          double finger_clearance_m) {
  MotionOptions options = Options(speed_m_s, acceleration_m_s2);
  options.finger_clearance_m = finger_clearance_m;
  Run(planner_.PlanLine(Start(), X_BE, options), "line");
}

WaitOutcome MotionExecutor::GuardedLine(const RigidTransform& X_BE, double speed_m_s,
                                        double force_limit_N) {
  // Guarded ends are near by intent: pads over the tray, a tube over the floor.
  MotionOptions options = Options(speed_m_s, 0.5);
  options.clearance_m = kFingerClearance_m;
  const MotionResult planned = planner_.PlanLine(Start(), X_BE, options);
  if (const auto* rejection = std::get_if<MotionRejection>(&planned)) {
    throw MoveFailure(MoveFailure::Kind::kRejected, "guarded line: " + rejection->reason);
  }
  const CheckedTrajectory& trajectory = std::get<CheckedTrajectory>(planned);
  const WaitOutcome outcome = RunGuarded(cell_, trajectory, force_limit_N);
  if (outcome.status == WaitOutcome::Status::kDone) {
    q_ = EndOf(trajectory);
  } else if (outcome.status == WaitOutcome::Status::kContact) {
    Wait(cell_, kSettle_s);
    q_ = cell_.arm.State().q;
  } else {
    throw MoveFailure(outcome, "guarded line");
  }
  return outcome;
}

void MotionExecutor::Legs(const std::vector<RigidTransform>& X_BE, double speed_m_s,
                          double turn_speed_rad_s, double acceleration_m_s2) {
  if (X_BE.empty()) return;
  MotionOptions options = Options(speed_m_s, acceleration_m_s2);
  options.turn_speed_rad_s = turn_speed_rad_s;
  Run(planner_.PlanPolyline(Start(), X_BE, options), "lift");
}

bool MotionExecutor::TiltsFrom(const RigidTransform& X_BE,
                               const std::vector<Vector3>& rotations_B) const {
  MotionOptions options = Options(0.25, 1.0);
  const MotionResult line = planner_.PlanLine(q_, X_BE, options);
  const auto* there = std::get_if<CheckedTrajectory>(&line);
  if (there == nullptr) return false;
  options = MotionOptions();
  options.opening_m = opening_m_;
  for (const Vector3& rotation_B : rotations_B) {
    const MotionResult tilt = planner_.PlanTilt(EndOf(*there), rotation_B, options);
    if (std::holds_alternative<MotionRejection>(tilt)) return false;
  }
  return true;
}

void MotionExecutor::Tilt(const Vector3& rotation_B, double speed_rad_s) {
  MotionOptions options;
  options.turn_speed_rad_s = speed_rad_s;
  options.turn_acceleration_rad_s2 = speed_rad_s / 0.3;  // Ramps of 0.3 s.
  options.opening_m = opening_m_;
  Run(planner_.PlanTilt(Start(), rotation_B, options), "tilt");
}

}  // namespace tubetwin
