#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/twin_cell/cell_fixture.h"
#include "twin/cell/gripper_body.h"

namespace tubetwin::test {
namespace {

constexpr double kCount_m = 0.085 / 227.0;  ///< One count of the position register.

Pile FartherTube() { return OneTube("pvc_a", Vector3(0, 0.2, 0.0126)); }

/// Sum of the normal forces on one pad.
double PadForce(Bench& bench, const char* pad) {
  const mjModel& model = bench.impl().world.model();
  const mjData& data = bench.impl().world.data();
  const int geom = IdOf(model, mjOBJ_GEOM, pad);
  double sum_N = 0.0;
  for (int i = 0; i < data.ncon; ++i) {
    if (data.contact[i].geom[0] != geom && data.contact[i].geom[1] != geom) continue;
    mjtNum force[6];
    mj_contactForce(&model, &data, i, force);
    sum_N += force[0];
  }
  return sum_N;
}

}  // namespace

TEST_CASE("closing on nothing ends at the requested position with its opening") {
  Bench bench(FartherTube());
  const GripperState closed = MoveGripper(bench.cell(), {0.0, 0.15, 60.0}).state;
  CHECK(closed.object == GripperObject::kAtPosition);
  CHECK(closed.opening_m <= kCount_m);
  const GripperState half = MoveGripper(bench.cell(), {0.040, 0.15, 60.0}).state;
  CHECK(half.object == GripperObject::kAtPosition);
  // The servo is soft where the tips' weight pulls on it: one count, and one of rounding.
  CHECK(half.opening_m == Approx(0.040).margin(2 * kCount_m));
  const double counts = half.opening_m / kCount_m;
  CHECK(counts == Approx(std::round(counts)).margin(1e-6));
}

TEST_CASE("fingers move at the set speed within the device's range") {
  Bench bench(FartherTube());
  double opening_m = 0.085;
  for (const double speed_m_s : {0.020, 0.150}) {
    const double target_m = opening_m > 0.04 ? 0.010 : 0.075;
    const TimeNs start = bench.cell().clock.Now();
    bench.cell().gripper.Command({target_m, speed_m_s, 60.0});
    const double middle_m = 0.5 * (opening_m + target_m);
    const bool closing = target_m < opening_m;
    while ((bench.impl().gripper.TrueOpening() > middle_m) == closing) {
      bench.cell().clock.AdvanceTo(bench.cell().clock.Now() + kControlPeriod);
      REQUIRE(Seconds(bench.cell().clock.Now() - start) < 5.0);
    }
    const double expected_s = std::abs(opening_m - middle_m) / speed_m_s;
    // The fingers' own start takes the servo's 15 ms.
    CHECK(Seconds(bench.cell().clock.Now() - start) ==
          Approx(expected_s).margin(0.03 + 0.02 * expected_s));
    Wait(bench.cell(), 3.0);
    opening_m = bench.impl().gripper.TrueOpening();
  }
}

TEST_CASE("each pad presses a tube with the set force, clamped to the device's range") {
  const double radius_m = LoadPart("pvc_a").radius_m;
  for (const auto& [asked_N, expected_N] : {std::pair{60.0, 60.0}, {5.0, 20.0}, {500.0, 235.0}}) {
    Bench bench(OneTube("pvc_a", Vector3(0, 0, radius_m)));
    const GripperState state = bench.GraspAt(Vector3(0, 0, radius_m), asked_N);
    CHECK(state.object == GripperObject::kContactClosing);
    CHECK(state.opening_m == Approx(2 * radius_m).margin(0.001));
    // Registers are bytes: half a count of 0.84 N; and the tips' weight on the slanted guide.
    CHECK(PadForce(bench, kPadLeftGeom) == Approx(expected_N).margin(1.5));
    CHECK(PadForce(bench, kPadRightGeom) == Approx(expected_N).margin(1.5));
  }
}

TEST_CASE("the pads stand where PadRetreat says at every opening and under load") {
  const double radius_m = LoadPart("pvc_a").radius_m;
  Bench bench(OneTube("pvc_a", Vector3(0, 0, radius_m)));
  const auto pad_error_m = [&] {
    const CellWorld& world = bench.impl().world;
    const Vector3 p_BPad(world.data().geom_xpos +
                         3 * IdOf(world.model(), mjOBJ_GEOM, kPadLeftGeom));
    const double z_E = (bench.X_BE().inverse() * p_BPad).z();
    return std::abs(z_E + PadRetreat(PaperCell().gripper, bench.impl().gripper.TrueOpening()));
  };
  constexpr double kPadHeight_m = 0.0005;
  double worst_m = 0.0;
  for (double opening_m = 0.085; opening_m >= 0.0; opening_m -= 0.005) {
    MoveGripper(bench.cell(), {opening_m, 0.15, 60.0});
    worst_m = std::max(worst_m, pad_error_m());
  }
  INFO("worst " << worst_m * 1e3 << " mm");
  CHECK(worst_m < kPadHeight_m);
  MoveGripper(bench.cell(), {0.085, 0.15, 60.0});
  bench.GraspAt(Vector3(0, 0, radius_m), 235.0);
  CHECK(pad_error_m() < kPadHeight_m);
}

TEST_CASE("a lost tube lets the fingers go on to the request") {
  const double radius_m = LoadPart("pvc_a").radius_m;
  Bench bench(OneTube("pvc_a", Vector3(0, 0, radius_m)));
  REQUIRE(bench.GraspAt(Vector3(0, 0, radius_m)).object == GripperObject::kContactClosing);
  // Somebody takes the tube away.
  CellWorld& world = bench.impl().world;
  const int joint = IdOf(world.model(), mjOBJ_JOINT, "tube3_free");
  world.data().qpos[world.model().jnt_qposadr[joint] + 2] += 1.0;
  Wait(bench.cell(), 0.05);
  CHECK(bench.cell().gripper.State().object == GripperObject::kMoving);
  Wait(bench.cell(), 1.0);
  CHECK(bench.cell().gripper.State().object == GripperObject::kAtPosition);
  CHECK(bench.cell().gripper.State().opening_m <= kCount_m);
}

TEST_CASE("state says moving from the command on") {
  Bench bench(FartherTube());
  CHECK(bench.cell().gripper.State().object == GripperObject::kAtPosition);
  bench.cell().gripper.Command({0.0, 0.1, 60.0});
  CHECK(bench.cell().gripper.State().object == GripperObject::kMoving);
  CHECK(bench.cell().gripper.State().requested_m == 0.0);
}

}  // namespace tubetwin::test
