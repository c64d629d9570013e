#include "planner/motion/path_builder.h"

#include <algorithm>

namespace tubetwin {
namespace {

constexpr double kGuardedAcceleration_m_s2 = 0.5;
constexpr double kTurnRamp_s = 0.3;

}  // namespace

MotionOptions NearGrasp(double speed_m_s, double acceleration_m_s2, double ramp_s) {
  MotionOptions options;
  options.speed_m_s = speed_m_s;
  options.acceleration_m_s2 =
      ramp_s > 0.0 ? std::min(acceleration_m_s2, speed_m_s / ramp_s) : acceleration_m_s2;
  options.finger_clearance_m = kGraspClearance_m;
  return options;
}

PathBuilder& PathBuilder::NextStage() {
  ++stage_;
  return *this;
}

PathBuilder& PathBuilder::Add(const std::string& label, const MotionOptions& options,
                              decltype(PathSegment::what) what) {
  path_.segments.push_back({std::move(what), options, label, stage_});
  return *this;
}

PathBuilder& PathBuilder::Close(const std::string& label, double force_N, double held_m) {
  return Add(label, {}, tubetwin::MoveFingers{{0.0, config_.grip_speed_m_s, force_N}, held_m});
}

PathBuilder& PathBuilder::Open(const std::string& label, double opening_m) {
  return Add(
      label, {},
      tubetwin::MoveFingers{{opening_m, config_.grip_speed_m_s, config_.grip_force_N}, opening_m});
}

PathBuilder& PathBuilder::Transfer(const std::string& label, const RigidTransform& X_BE) {
  return Add(label,
             NearGrasp(config_.transfer_speed_m_s, config_.transfer_acceleration_m_s2, ramp_s_),
             tubetwin::Transfer{X_BE});
}

PathBuilder& PathBuilder::Line(const std::string& label, const PathGoal& goal, double speed_m_s) {
  if (speed_m_s <= 0.0) speed_m_s = config_.approach_speed_m_s;
  return Add(label, NearGrasp(speed_m_s, config_.transfer_acceleration_m_s2, ramp_s_),
             Follow{{goal}});
}

PathBuilder& PathBuilder::GuardedLine(const std::string& label, const PathGoal& goal,
                                      double speed_m_s, double force_limit_N) {
  // Guarded ends are near by intent: pads over the tray, a tube over the floor.
  MotionOptions options = NearGrasp(speed_m_s, kGuardedAcceleration_m_s2, ramp_s_);
  options.clearance_m = kGraspClearance_m;
  return Add(label, options, tubetwin::GuardedLine{goal, force_limit_N});
}

PathBuilder& PathBuilder::Turn(const std::string& label, const Vector3& rotation_B,
                               double speed_rad_s) {
  MotionOptions options;
  options.turn_speed_rad_s = speed_rad_s;
  options.turn_acceleration_rad_s2 = speed_rad_s / kTurnRamp_s;
  return Add(label, options, tubetwin::Turn{rotation_B});
}

PathBuilder& PathBuilder::Pause(const std::string& label, double duration_s) {
  return Add(label, {}, tubetwin::Pause{duration_s});
}

}  // namespace tubetwin
