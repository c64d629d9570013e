#include "tests/contract/device_contract.h"

#include <cmath>

#include "models/gripper_spec.h"
#include "tests/contract/advance.h"
#include "tests/support/arm_motions.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

/// Two counts of the gripper's register.
constexpr double kOpening_m = 0.0008;
/// A sample older than this is not the newest one of a sensor of 7000 to 100 Hz.
constexpr TimeNs kOldest = std::chrono::milliseconds(25);

}  // namespace

void CheckClockContract(Cell& cell) {
  const TimeNs before = cell.clock.Now();
  cell.clock.AdvanceTo(before + 5 * kControlPeriod);
  const TimeNs after = cell.clock.Now();
  CHECK(after >= before + 5 * kControlPeriod);
  cell.clock.AdvanceTo(before);  // In the past: nothing happens.
  CHECK(cell.clock.Now() >= after);
  CHECK(cell.clock.Now() < after + std::chrono::milliseconds(100));
}

// Long function: one arm goes through all states in turn; each step starts where the last one
// ended.
void CheckArmContract(Cell& cell) {
  const ArmState start = cell.arm.State();
  REQUIRE(start.mode == ArmMode::kReady);
  CHECK(start.done);
  CHECK(start.fault.empty());

  // Far from where the arm is: refused, with the reason, and nothing moves.
  const CommandResult far = cell.arm.Start(Moved(start.q + 0.01 * JointVector::Ones(), 0.01, 0.5));
  CHECK_FALSE(far.accepted());
  CHECK_FALSE(far.reason.empty());
  CHECK_FALSE(cell.arm.Append(Moved(start.q, 0.01, 0.5)).accepted());
  cell.arm.Stop(StopKind::kFast);  // Nothing runs: nothing happens.
  Wait(cell, 0.05);
  CHECK(cell.arm.State().mode == ArmMode::kReady);
  CHECK(Farthest(cell.arm.State().q, start.q) < kStanding_rad);

  // A motion runs on its way, in its time, and ends where it should.
  const CheckedTrajectory out = Moved(start.q, 0.04, 0.6);
  REQUIRE(cell.arm.Start(out).accepted());
  CHECK(cell.arm.State().planned_s == Approx(0.6));
  double progress_s = 0.0;
  TimeNs time = cell.arm.State().time;
  AdvanceUntil(cell, [&] {
    const ArmState state = cell.arm.State();
    CHECK(state.progress_s >= progress_s);
    CHECK(state.time >= time);
    progress_s = state.progress_s;
    time = state.time;
    return state.mode != ArmMode::kMoving || progress_s > 0.2;
  });
  REQUIRE(cell.arm.State().mode == ArmMode::kMoving);
  CHECK_FALSE(cell.arm.State().done);
  CHECK_FALSE(cell.arm.Start(out).accepted());  // Still moving.
  // What is streamed goes on from the end.
  const JointVector turn = out.trajectory().points.back().q;
  CHECK_FALSE(cell.arm.Append(Moved(turn + 0.01 * JointVector::Ones(), 0.01, 0.5)).accepted());
  REQUIRE(cell.arm.Append(Moved(turn, -0.02, 0.4)).accepted());
  CHECK(cell.arm.State().planned_s == Approx(1.0));
  ArmState end = WaitUntilStill(cell);
  CHECK(end.mode == ArmMode::kReady);
  CHECK(end.done);
  CHECK(end.progress_s == Approx(1.0));
  Wait(cell, 0.1);
  CHECK(Farthest(cell.arm.State().q, start.q + 0.02 * JointVector::Ones()) < kStanding_rad);

  // Both stops end short of the goal and leave the arm ready, but not done.
  JointVector goal = start.q + 0.02 * JointVector::Ones();
  for (const StopKind kind : {StopKind::kOnPath, StopKind::kFast}) {
    REQUIRE(cell.arm.Start(Moved(goal, -0.04, 1.0)).accepted());
    AdvanceUntil(cell, [&] { return cell.arm.State().progress_s > 0.4; });
    cell.arm.Stop(kind);
    end = WaitUntilStill(cell);
    CHECK(end.mode == ArmMode::kReady);
    CHECK_FALSE(end.done);
    CHECK(end.progress_s < 0.95);
    Wait(cell, 0.1);
    const JointVector stands = cell.arm.State().q;
    CHECK(Farthest(stands, goal) > 0.005);
    CHECK(Farthest(stands, goal) < 0.039);
    REQUIRE(cell.arm.Start(Moved(stands, goal[0] - stands[0], 1.0)).accepted());
    CHECK(WaitUntilStill(cell).done);
    Wait(cell, 0.1);
    goal = cell.arm.State().q;
  }
  REQUIRE(cell.arm.Start(Moved(goal, start.q[0] - goal[0], 1.0)).accepted());
  CHECK(WaitUntilStill(cell).done);
  Wait(cell, 0.1);
}

void CheckGripperContract(Cell& cell) {
  const double stroke_m = PaperCell().gripper.stroke_m;
  CHECK(cell.gripper.State().activated);
  CHECK(cell.gripper.State().fault == 0);
  for (const double opening_m : {0.5 * stroke_m, 0.2 * stroke_m, stroke_m}) {
    CAPTURE(opening_m);
    cell.gripper.Command({opening_m, 0.1, 60.0});
    CHECK(cell.gripper.State().object == GripperObject::kMoving);
    AdvanceUntil(cell, [&] { return cell.gripper.State().object != GripperObject::kMoving; });
    const GripperState state = cell.gripper.State();
    CHECK(state.object == GripperObject::kAtPosition);
    CHECK(std::abs(state.opening_m - opening_m) < kOpening_m);
    CHECK(std::abs(state.requested_m - opening_m) < kOpening_m);
    CHECK(state.time <= cell.clock.Now());
  }
  // Beyond the range: as far as it goes.
  cell.gripper.Command({2.0 * stroke_m, 10.0, 1e4});
  AdvanceUntil(cell, [&] { return cell.gripper.State().object != GripperObject::kMoving; });
  CHECK(std::abs(cell.gripper.State().opening_m - stroke_m) < kOpening_m);
}

void CheckWristContract(Cell& cell) {
  TimeNs newest = cell.wrist.Read().time;
  for (int i = 0; i < 50; ++i) {
    cell.clock.AdvanceTo(cell.clock.Now() + kControlPeriod);
    const WrenchSample sample = cell.wrist.Read();
    CHECK(sample.time >= newest);
    CHECK(cell.clock.Now() - sample.time < kOldest);
    CHECK_FALSE(sample.saturated);
    CHECK(sample.wrench_K.force_N.allFinite());
    CHECK(sample.wrench_K.torque_Nm.allFinite());
    newest = sample.time;
  }
}

void CheckScannerContract(Cell& cell) {
  REQUIRE(cell.scanner.Status() == ScanStatus::kIdle);
  REQUIRE(cell.scanner.Trigger().accepted());
  CHECK(cell.scanner.Status() == ScanStatus::kBusy);
  const CommandResult twice = cell.scanner.Trigger();
  CHECK_FALSE(twice.accepted());
  CHECK_FALSE(twice.reason.empty());
  AdvanceUntil(cell, [&] { return cell.scanner.Status() != ScanStatus::kBusy; });
  REQUIRE(cell.scanner.Status() == ScanStatus::kReady);
  const OrganizedCloud cloud_S = cell.scanner.Take();
  CHECK(cell.scanner.Status() == ScanStatus::kIdle);
  CHECK(cloud_S.organized());
  CHECK(cloud_S.size() == static_cast<std::size_t>(cloud_S.width) * cloud_S.height);
  std::size_t valid = 0;
  for (const Eigen::Vector3f& p : cloud_S.p_SP) {
    valid += IsValid(p) ? 1 : 0;
    if (IsValid(p) != p.allFinite()) FAIL("a point is valid in part");
  }
  CHECK(valid > cloud_S.size() / 100);
  const Matrix3 R_NS = cloud_S.X_NS.linear();
  CHECK((R_NS * R_NS.transpose() - Matrix3::Identity()).norm() < 1e-9);
}

void CheckDeviceContracts(Cell& cell) {
  CheckClockContract(cell);
  CheckArmContract(cell);
  CheckGripperContract(cell);
  CheckWristContract(cell);
  CheckScannerContract(cell);
}

}  // namespace tubetwin::test
