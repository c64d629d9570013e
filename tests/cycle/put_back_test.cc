// What hangs in the fingers and is not to be placed goes back into the bin, whatever its walls are.

#include <algorithm>
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/fake_round.h"

namespace tubetwin {
namespace {

using test::FakeRound;
using test::FakeWorld;
using test::TwoTubes;

Bin BinOf(double shorter_m, double wall_m) {
  Bin bin;
  bin.size_m = {0.5, shorter_m, wall_m};
  return bin;
}

/// Two tubes are taken, stay together, and are put back into a bin of some size.
struct PutBackInto : test::CycleNotes {
  PutBackInto(double shorter_m, double wall_m)
      : world(TwoTubes(), BinOf(shorter_m, wall_m)), round(world) {
    world.Grab(2);
    round.setup.resolution.strategy = "plus45";
    round.setup.stop_requested = [this] { return !attempts.empty(); };
    RunPickCycle(world.cell, round.setup, *this);
    round.CheckFaults();
    for (std::size_t k = first; k < world.motions.size(); ++k) {
      const RigidTransform X_NE = world.cell.bin.X_BN.inverse() * world.motions[k].X_BE_to;
      if (X_NE.translation().z() >= height_m) continue;
      height_m = X_NE.translation().z();
      const Matrix3 turn = world.motions[k].X_BE_to.linear() * X_BE.linear().transpose();
      turn_deg = Degrees(std::atan2(turn(1, 0), turn(0, 0)));
    }
  }
  void OnStep(const std::string& caption) override {
    if (caption != "putting back") return;
    first = world.motions.size();
    X_BE = world.X_BE();
  }

  FakeWorld world;
  FakeRound round;
  std::size_t first = 0;  ///< Motion of putting back.
  RigidTransform X_BE;    ///< Where that began.
  double height_m = 1.0;  ///< The lowest that E went to then, over the floor,
  double turn_deg = 0.0;  ///< and how far the tool was turned there.
};

TEST_CASE(
    "What is put back is let go low over the floor, the tool turned where it fits no other way",
    "[unit]") {
  const PutBackInto wide(0.4, 0.12), narrow(0.25, 0.15);
  for (const PutBackInto* into : {&wide, &narrow}) {
    CHECK(into->attempts.at(0).outcome == AttemptOutcome::kPutBack);
    CHECK(into->world.held() == 0);
    CAPTURE(into == &wide, into->turn_deg);
    CHECK(into->height_m < 0.055);
  }
  CHECK(std::abs(wide.turn_deg) < 1.0);
  CHECK(std::abs(narrow.turn_deg) > 40.0);
}

TEST_CASE("Where the tool fits no lower it lets go higher, and what is held is no fault",
          "[unit]") {
  for (const double shorter_m : {0.4, 0.32, 0.25}) {
    CAPTURE(shorter_m);
    const PutBackInto deep(shorter_m, 0.25);
    CHECK(deep.attempts.at(0).outcome == AttemptOutcome::kPutBack);
    CHECK(deep.world.held() == 0);
    CHECK(deep.height_m > 0.1);
    CHECK(deep.height_m < 0.25 + 0.07);
  }
}

}  // namespace
}  // namespace tubetwin
