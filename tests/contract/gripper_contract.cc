#include "tests/contract/gripper_contract.h"

#include <cmath>

#include "tests/contract/advance.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

constexpr double kCount_m = 0.085 / 227.0;  ///< One count of the position register.
/// The servo is soft where the tips' weight pulls on it: one count, and one of rounding.
constexpr double kStands_m = 2 * kCount_m;

const GripperSpec& kSpec = PaperCell().gripper;

/// Commands, and what the state says when it first says no longer that it moves.
GripperState MoveTo(Cell& cell, const GripperCommand& command) {
  cell.gripper.Command(command);
  CHECK(cell.gripper.State().object == GripperObject::kMoving);
  GripperState state;
  AdvanceUntil(cell, [&] {
    state = cell.gripper.State();
    return state.object != GripperObject::kMoving;
  });
  CHECK(state.activated);
  CHECK(state.fault == 0);
  return state;
}

double CountsOff(double opening_m) {
  const double counts = opening_m / kCount_m;
  return std::abs(counts - std::round(counts));
}

}  // namespace

void CheckGripperMoves(GripperContractRig& rig) {
  Cell& cell = rig.cell();
  rig.TakeTubeAway();
  CHECK(cell.gripper.State().object == GripperObject::kAtPosition);
  // Where it is already, too: a caller waits for the end of what it has asked for.
  for (const double opening_m : {0.04, 0.04, 0.0, 0.085}) {
    CAPTURE(opening_m);
    const GripperState state = MoveTo(cell, {opening_m, 0.15, 60.0});
    CHECK(state.object == GripperObject::kAtPosition);
    CHECK(std::abs(state.opening_m - opening_m) <= kStands_m);
    CHECK(std::abs(rig.TrueOpening_m() - opening_m) <= kStands_m);
    const double stands_m = rig.TrueOpening_m();
    Wait(cell, 0.1);
    CHECK(std::abs(rig.TrueOpening_m() - stands_m) < 0.5 * kCount_m);
  }
  // On its way it is told to turn round, and does.
  cell.gripper.Command({0.0, 0.05, 60.0});
  AdvanceUntil(cell, [&] { return cell.gripper.State().opening_m < 0.06; });
  CHECK(cell.gripper.State().object == GripperObject::kMoving);
  const GripperState turned = MoveTo(cell, {0.08, 0.15, 60.0});
  CHECK(turned.object == GripperObject::kAtPosition);
  CHECK(std::abs(turned.opening_m - 0.08) <= kStands_m);
  // Of many at once the newest counts.
  for (int i = 1; i <= 20; ++i) cell.gripper.Command({0.003 * i, 0.15, 60.0});
  CHECK(std::abs(cell.gripper.State().requested_m - 0.06) <= 0.5 * kCount_m + 1e-9);
  CHECK(std::abs(MoveTo(cell, {0.06, 0.15, 60.0}).opening_m - 0.06) <= kStands_m);
}

void CheckGripperClamps(GripperContractRig& rig) {
  Cell& cell = rig.cell();
  rig.TakeTubeAway();
  CHECK(std::abs(MoveTo(cell, {-1.0, 0.15, 60.0}).opening_m) <= kStands_m);
  CHECK(cell.gripper.State().requested_m == 0.0);
  CHECK(cell.gripper.State().object == GripperObject::kAtPosition);
  double began_s = rig.DeviceTime_s();
  CHECK(std::abs(MoveTo(cell, {1.0, 100.0, 1e5}).opening_m - kSpec.stroke_m) <= kStands_m);
  CHECK(cell.gripper.State().requested_m == Approx(kSpec.stroke_m));
  CHECK(rig.DeviceTime_s() - began_s > 0.98 * kSpec.stroke_m / kSpec.max_speed_m_s);
  // The slowest is not none.
  const double from_m = rig.TrueOpening_m();
  began_s = rig.DeviceTime_s();
  cell.gripper.Command({0.0, 0.0, 0.0});
  AdvanceUntil(cell, [&] { return rig.TrueOpening_m() < from_m - 0.01; });
  const double speed_m_s = (from_m - rig.TrueOpening_m()) / (rig.DeviceTime_s() - began_s);
  CHECK(speed_m_s < 1.1 * kSpec.min_speed_m_s);
  MoveTo(cell, {kSpec.stroke_m, 0.15, 60.0});
}

void CheckGripperState(GripperContractRig& rig) {
  Cell& cell = rig.cell();
  rig.TakeTubeAway();
  const TimeNs began = cell.gripper.State().time;
  for (const double opening_m : {0.0123, 0.0777}) {
    CAPTURE(opening_m);
    cell.gripper.Command({opening_m, 0.05, 60.0});
    const double requested_m = cell.gripper.State().requested_m;
    CHECK(std::abs(requested_m - opening_m) <= 0.5 * kCount_m + 1e-9);
    TimeNs time = cell.gripper.State().time;
    double last_m = cell.gripper.State().opening_m, way_m = 0.0;
    AdvanceUntil(cell, [&] {
      const GripperState state = cell.gripper.State();
      CHECK(CountsOff(state.opening_m) < 1e-6);
      CHECK(state.requested_m == requested_m);
      CHECK(state.time >= time);
      CHECK(state.time <= cell.clock.Now());
      way_m += std::abs(state.opening_m - last_m);
      last_m = state.opening_m;
      time = state.time;
      return state.object != GripperObject::kMoving;
    });
    CHECK(way_m > 0.05);  // It was seen on its way.
    CHECK(way_m < 0.08);  // One way.
    const double true_m = rig.TrueOpening_m();
    CHECK(std::abs(cell.gripper.State().opening_m - true_m) <= 0.51 * kCount_m);
  }
  // One that stands is still heard of.
  const TimeNs before = cell.gripper.State().time;
  CHECK(before > began);
  AdvanceUntil(cell, [&] { return cell.gripper.State().time > before; });
}

void CheckGripperHolds(GripperContractRig& rig) {
  Cell& cell = rig.cell();
  constexpr double kForce_N = 1.5;  // Half a count of 0.84 N; the tips' weight on their guide.
  for (const auto& [asked_N, expected_N] : {std::pair{60.0, 60.0}, {5.0, 20.0}, {500.0, 235.0}}) {
    CAPTURE(asked_N);
    const GripperState held = MoveTo(cell, {0.0, 0.05, asked_N});
    CHECK(held.object == GripperObject::kContactClosing);
    CHECK(std::abs(held.opening_m - rig.tube_diameter_m()) < 0.001);
    CHECK(held.requested_m == 0.0);
    Wait(cell, 0.3);  // The tube may yet slip to where it is held.
    CHECK(std::abs(rig.PadForce_N() - expected_N) < kForce_N);
    CHECK(cell.gripper.State().object == GripperObject::kContactClosing);
    CHECK(MoveTo(cell, {kSpec.stroke_m, 0.15, 60.0}).object == GripperObject::kAtPosition);
  }
  REQUIRE(MoveTo(cell, {0.0, 0.05, 60.0}).object == GripperObject::kContactClosing);
  rig.TakeTubeAway();
  AdvanceUntil(cell, [&] { return cell.gripper.State().object != GripperObject::kContactClosing; });
  AdvanceUntil(cell, [&] { return cell.gripper.State().object == GripperObject::kAtPosition; });
  CHECK(cell.gripper.State().opening_m <= kStands_m);
  CHECK(std::abs(rig.TrueOpening_m()) <= kStands_m);
  CHECK(cell.gripper.State().fault == 0);
}

}  // namespace tubetwin::test
