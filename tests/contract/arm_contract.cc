#include "tests/contract/arm_contract.h"

#include <cmath>

#include "models/base/error.h"
#include "tests/contract/advance.h"
#include "tests/support/arm_motions.h"
#include "tests/support/catch.h"

namespace tubetwin::test {
namespace {

/// To and fro along a smooth curve, a point every 5 ms, at rest at both ends.
CheckedTrajectory Waving(const JointVector& from, double by_rad, double duration_s) {
  JointTrajectory trajectory;
  const int steps = static_cast<int>(std::lround(duration_s / 0.005));
  for (int k = 0; k <= steps; ++k) {
    TrajectoryPoint point;
    point.time_s = duration_s * k / steps;
    for (int i = 0; i < kNumJoints; ++i) {
      // (1 - cos)/2, once or twice: at rest at the ends, and back at the start.
      const double w = (1 + i % 2) * 2 * kPi / duration_s;
      point.q[i] = from[i] + by_rad * 0.5 * (1 - std::cos(w * point.time_s));
      point.qd[i] = by_rad * 0.5 * w * std::sin(w * point.time_s);
    }
    if (k == 0 || k == steps) point.qd.setZero();
    trajectory.points.push_back(point);
  }
  return Checked(std::move(trajectory));
}

/// There, at rest and ready.
void Run(Cell& cell, const CheckedTrajectory& trajectory) {
  const CommandResult started = cell.arm.Start(trajectory);
  INFO(started.reason);
  REQUIRE(started.accepted());
  const ArmState state = WaitUntilStill(cell);
  INFO(state.fault);
  REQUIRE(state.mode == ArmMode::kReady);
  CHECK(state.done);
  Wait(cell, 0.1);
}

}  // namespace

void CheckArmStarts(ArmContractRig& rig) {
  Cell& cell = rig.cell();
  const JointVector start = cell.arm.State().q;
  for (int i = 0; i < kNumJoints; ++i) {
    CAPTURE(i);
    const JointVector unit = JointVector::Unit(i);
    const CommandResult far = cell.arm.Start(Moved(start + Radians(0.25) * unit, 0.02, 0.5));
    CHECK_FALSE(far.accepted());
    CHECK_THAT(far.reason, Catch::Matchers::Contains("joint " + std::to_string(i + 1)));
  }
  CHECK(cell.arm.State().mode == ArmMode::kReady);
  // Beside the path by less: it goes where the path goes.
  Run(cell, Moved(start + Radians(0.1) * JointVector::Ones(), 0.02, 0.6));
  CHECK(Farthest(cell.arm.State().q, start + (Radians(0.1) + 0.02) * JointVector::Ones()) <
        kStanding_rad);
  // The end of one is the start of the next, though the arm stands a little beside it.
  Run(cell, Moved(start + (Radians(0.1) + 0.02) * JointVector::Ones(), -0.02, 0.6));
}

void CheckArmFollows(ArmContractRig& rig) {
  Cell& cell = rig.cell();
  const JointVector start = cell.arm.State().q;
  const CheckedTrajectory wave = Waving(start, 0.12, 1.6);
  REQUIRE(cell.arm.Start(wave).accepted());
  constexpr int kPieces = 3;
  for (int k = 1; k < kPieces; ++k) REQUIRE(cell.arm.Append(wave).accepted());
  const double planned_s = kPieces * wave.duration_s();
  CHECK(cell.arm.State().planned_s == Approx(planned_s));
  double progress_s = 0.0, farthest_rad = 0.0;
  AdvanceUntil(cell, [&] {
    const ArmState state = cell.arm.State();
    CHECK(state.progress_s >= progress_s);
    CHECK(state.progress_s <= planned_s + 1e-9);
    CHECK(state.planned_s == Approx(planned_s));
    progress_s = state.progress_s;
    // On the path, where the cell's watch looks for it: up to a second behind.
    double off_rad = 1.0;
    for (double t = progress_s + 0.2; t > progress_s - 1.0; t -= 0.01) {
      const double in_piece_s = std::fmod(std::clamp(t, 0.0, planned_s), wave.duration_s());
      off_rad = std::min(off_rad, Farthest(state.q, Sample(wave.trajectory(), in_piece_s).q));
    }
    farthest_rad = std::max(farthest_rad, off_rad);
    return state.mode != ArmMode::kMoving;
  });
  CHECK(farthest_rad < 0.01);
  const ArmState state = cell.arm.State();
  CHECK(state.mode == ArmMode::kReady);
  CHECK(state.done);
  CHECK(state.progress_s == Approx(planned_s));
  Wait(cell, 0.1);
  CHECK(Farthest(cell.arm.State().q, start) < kStanding_rad);
}

void CheckArmStops(ArmContractRig& rig) {
  Cell& cell = rig.cell();
  const JointVector start = cell.arm.State().q;
  for (const StopKind second : {StopKind::kOnPath, StopKind::kFast}) {
    REQUIRE(cell.arm.Start(Moved(cell.arm.State().q, 0.2, 1.6)).accepted());
    AdvanceUntil(cell, [&] { return cell.arm.State().progress_s > 0.4; });
    cell.arm.Stop(StopKind::kOnPath);
    const JointVector goal = cell.arm.State().q;
    CHECK_FALSE(cell.arm.Append(Moved(goal, 0.01, 0.5)).accepted());
    cell.arm.Stop(second);
    const ArmState state = WaitUntilStill(cell);
    CHECK(state.mode == ArmMode::kReady);
    CHECK_FALSE(state.done);
    CHECK(state.progress_s < 1.55);
    cell.arm.Stop(second);
    Wait(cell, 0.2);
    const JointVector stands = cell.arm.State().q;
    CHECK(Farthest(stands, state.q) < kStanding_rad);
    // On the path: all joints have gone as far.
    const JointVector way = stands - (stands[0] - start[0]) * JointVector::Ones() - start;
    CHECK(way.cwiseAbs().maxCoeff() < 0.005);
    Run(cell, Moved(stands, start[0] - stands[0], 1.6));
  }
}

void CheckArmProtectiveStop(ArmContractRig& rig) {
  Cell& cell = rig.cell();
  const JointVector start = cell.arm.State().q;
  REQUIRE(cell.arm.Start(Moved(start, 0.2, 1.6)).accepted());
  AdvanceUntil(cell, [&] { return cell.arm.State().progress_s > 0.3; });
  CHECK_FALSE(cell.arm.Recover().accepted());  // It moves.
  rig.Block(true);
  ArmState state = WaitUntilStill(cell);
  CHECK(state.mode == ArmMode::kProtectiveStop);
  CHECK_FALSE(state.fault.empty());
  CHECK_FALSE(state.done);
  CHECK(state.progress_s < 1.6);
  rig.Block(false);
  Wait(cell, 0.5);
  CHECK(cell.arm.State().mode == ArmMode::kProtectiveStop);
  const JointVector stands = cell.arm.State().q;
  const CommandResult refused = cell.arm.Start(Moved(stands, 0.02, 0.5));
  CHECK_FALSE(refused.accepted());
  CHECK_THAT(refused.reason, Catch::Matchers::Contains("protective stop"));
  CHECK_FALSE(cell.arm.Append(Moved(stands, 0.02, 0.5)).accepted());
  const WaitOutcome recovered = RecoverArm(cell);
  INFO(recovered.reason);
  REQUIRE(recovered.status == WaitOutcome::Status::kDone);
  Wait(cell, 0.2);
  state = cell.arm.State();
  CHECK(state.fault.empty());
  CHECK(state.done);
  CHECK(Farthest(state.q, stands) < kStanding_rad);
  Run(cell, Moved(state.q, start[1] - state.q[1], 1.6));
}

}  // namespace tubetwin::test
