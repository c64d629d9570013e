#include "tests/support/fake_cell.h"

#include <algorithm>

#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {

FakeCell::FakeCell() : cell{clock, arm, gripper, wrist, scanner, model, Bin(), SafetyLimits()} {
  arm.q << 0, 0.3, 1.5, 0, -1.2, 0;
}

void FakeCell::Clock::AdvanceTo(TimeNs t) {
  while (now_ < t) {
    now_ += kControlPeriod;
    if (each_period) each_period();
  }
}

void FakeCell::FakeArm::Update() const {
  if (!silent) newest_ = clock_.Now();
  if (!moving_) return;
  if (!stuck) progress_s_ = Seconds(clock_.Now() - began_);
  if (progress_s_ < trajectory_.duration_s() && mode == ArmMode::kReady) return;
  moving_ = false;
  done_ = progress_s_ >= trajectory_.duration_s();
}

ArmState FakeCell::FakeArm::State() const {
  Update();
  ArmState state;
  state.time = newest_;
  state.mode = moving_ ? ArmMode::kMoving : mode;
  state.q = trajectory_.points.empty() ? q : Sample(trajectory_, progress_s_).q;
  state.q += moving_ ? offset : pushed;
  state.progress_s = progress_s_;
  state.planned_s = trajectory_.duration_s();
  state.done = done_;
  state.fault = fault;
  if (lie) lie(state);
  return state;
}

CommandResult FakeCell::FakeArm::Start(const CheckedTrajectory& trajectory) {
  ++started;
  if (mode != ArmMode::kReady) return {CommandResult::Status::kRejected, "not ready"};
  trajectory_ = trajectory.trajectory();
  last_planned_s = trajectory.duration_s();
  began_ = clock_.Now();
  progress_s_ = 0.0;
  moving_ = true;
  done_ = false;
  if (on_start) on_start(trajectory);
  return {};
}

void FakeCell::FakeArm::Stop(StopKind kind) {
  ++stopped;
  last_stop = kind;
  Update();
  moving_ = false;
}

CommandResult FakeCell::FakeArm::Recover() {
  ++recovered;
  if (!recovers) return {};
  mode = ArmMode::kReady;
  fault.clear();
  return {};
}

void FakeCell::FakeGripper::Command(const GripperCommand& command) {
  ++commands;
  state.opening_m = state.requested_m = command.opening_m;
  state.object = GripperObject::kAtPosition;
  if (on_command) on_command(command);
}

GripperState FakeCell::FakeGripper::State() const {
  if (!silent) newest_ = clock_.Now();
  GripperState now = state;
  now.time = newest_;
  if (lie) lie(now);
  return now;
}

WrenchSample FakeCell::FakeWrist::Read() const {
  if (!silent) newest_ = clock_.Now();
  WrenchSample sample{newest_, weigh ? weigh() : load_K, saturated, {}};
  if (lie) lie(sample);
  return sample;
}

CommandResult FakeCell::FakeScanner::Trigger() {
  ++triggered;
  status_ = failures > 0 ? ScanStatus::kFailed : ScanStatus::kReady;
  failures = std::max(0, failures - 1);
  return {};
}

OrganizedCloud FakeCell::FakeScanner::Take() {
  status_ = ScanStatus::kIdle;
  return look ? look() : OrganizedCloud();
}

CheckedTrajectory FakeCell::Move(double angle_rad, double duration_s) const {
  JointTrajectory trajectory;
  trajectory.points.resize(2);
  trajectory.points[0].q = arm.State().q;
  trajectory.points[1].q = arm.State().q + angle_rad * JointVector::Ones();
  trajectory.points[1].time_s = duration_s;
  const auto checked = CheckTrajectory(model.arm, trajectory);
  if (const auto* rejected = std::get_if<TrajectoryRejection>(&checked)) FAIL(rejected->reason);
  return std::get<CheckedTrajectory>(checked);
}

}  // namespace tubetwin::test
