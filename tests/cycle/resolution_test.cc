// Every strategy against every way in which it may end: what the arm was seen to do, what came of
// it, and that the next attempt goes on.

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/fake_round.h"

namespace tubetwin {
namespace {

using test::FakeMotion;
using test::FakeRound;
using test::FakeTube;
using test::FakeWorld;
using test::MotionKind;
using test::TwoTubes;

/// What a strategy does as long as several hang in the fingers.
struct Strategy {
  std::string name;
  std::vector<double> tilts_deg;  ///< About the axis, from the vertical.
  bool across = false;            ///< The axis is across the load's torque, not along it.
  bool lowers = false;            ///< It lets down and lifts again instead.

  bool moves() const { return lowers || !tilts_deg.empty(); }
  /// The motion in which things happen to the tubes, and how often it is made.
  MotionKind kind() const { return lowers ? MotionKind::kLower : MotionKind::kTilt; }
  int times() const { return lowers ? 1 : static_cast<int>(tilts_deg.size()); }
};

std::vector<Strategy> AllStrategies() {
  return {{"none", {}, false, false},
          {"plus45", {45.0}, false, false},
          {"plus45_minus45", {45.0, -45.0}, false, false},
          {"perpendicular", {45.0, -45.0}, true, false},
          {"putback", {}, false, true}};
}

std::vector<Strategy> MovingStrategies() {
  std::vector<Strategy> out;
  for (const Strategy& strategy : AllStrategies()) {
    if (strategy.moves()) out.push_back(strategy);
  }
  return out;
}

/// A round whose first grasp takes two tubes.
struct SeveralRound {
  explicit SeveralRound(const Strategy& strategy) : world(TwoTubes()), round(world) {
    world.Grab(2);
    round.setup.resolution.strategy = strategy.name;
  }
  FakeWorld world;
  FakeRound round;
};

/// The first attempt ended so, and the second one places a tube.
void CheckEnds(const FakeRound& round, const Strategy& strategy, const std::string& outcome,
               const std::string& reason) {
  INFO(round.attempts_text());
  CHECK(round.outcome(0) == outcome);
  CHECK_THAT(round.attempt(0).reason, Catch::Contains(reason));
  CHECK(round.attempt(0).detection->outcome == HeldOutcome::kSeveral);
  CHECK(round.attempt(0).resolution_used == strategy.moves());
  CHECK(round.attempt(0).strategy == strategy.name);
  CHECK(round.outcome(1) == "placed");
}

TEST_CASE("Every strategy of the registry is tried here", "[unit]") {
  std::vector<std::string> tried, known;
  for (const Strategy& strategy : AllStrategies()) tried.push_back(strategy.name);
  for (const ResolutionStrategy& strategy : ResolutionStrategies()) known.push_back(strategy.name);
  CHECK(tried == known);
}

TEST_CASE("Several that stay in the fingers are put back, whatever was tried", "[unit]") {
  for (const Strategy& strategy : AllStrategies()) {
    CAPTURE(strategy.name);
    SeveralRound several(strategy);
    several.round.Run(2);
    CheckEnds(several.round, strategy, "put_back", "several tubes hung in the fingers");
    const auto outcome = several.round.attempt(0).resolution_outcome;
    CHECK(outcome.has_value() == strategy.moves());
    if (outcome) CHECK(*outcome == HeldOutcome::kSeveral);
    CHECK(several.world.CountMotions(MotionKind::kTilt) ==
          static_cast<int>(strategy.tilts_deg.size()));
    CHECK(several.world.Count(FakeTube::Place::kTray) == 1);  // By the second attempt.
    CHECK(several.world.Count(FakeTube::Place::kBin) == 1);
  }
}

TEST_CASE("What is left alone by a strategy is placed", "[unit]") {
  for (const Strategy& strategy : MovingStrategies()) {
    for (int k = 1; k <= strategy.times(); ++k) {
      CAPTURE(strategy.name, k);
      SeveralRound several(strategy);
      several.world.After(strategy.kind(), k, [&] { several.world.Fall(1); });
      several.round.Run(2);
      CheckEnds(several.round, strategy, "placed", "");
      CHECK(several.round.attempt(0).resolution_outcome == HeldOutcome::kOne);
      CHECK(several.world.Count(FakeTube::Place::kTray) == 2);
      // Nothing more is tried than was needed.
      CHECK(several.world.CountMotions(strategy.kind()) == k);
    }
  }
}

TEST_CASE("A strategy in which all tubes fall has nothing to place", "[unit]") {
  for (const Strategy& strategy : MovingStrategies()) {
    for (int k = 1; k <= strategy.times(); ++k) {
      CAPTURE(strategy.name, k);
      SeveralRound several(strategy);
      several.world.After(strategy.kind(), k, [&] { several.world.Fall(2); });
      several.round.Run(2);
      CheckEnds(several.round, strategy, "nothing_held", "the tube slipped out of the fingers");
      CHECK(several.round.attempt(0).resolution_outcome == HeldOutcome::kNone);
      CHECK(several.world.CountMotions(MotionKind::kTilt) == (strategy.lowers ? 0 : k));
    }
  }
}

TEST_CASE("A tube that a strategy left alone may still be lost on the way", "[unit]") {
  for (const Strategy& strategy : MovingStrategies()) {
    CAPTURE(strategy.name);
    SeveralRound several(strategy);
    several.world.After(strategy.kind(), 1, [&] { several.world.Fall(1); });
    several.world.During(MotionKind::kCarry, 1, [&] { several.world.Fall(1); });
    several.round.Run(2);
    CheckEnds(several.round, strategy, "dropped", "while a tube was carried");
    CHECK(several.round.attempt(0).resolution_outcome == HeldOutcome::kOne);
  }
}

/// A stop in the middle of a strategy's first motion, or when it is over (the next one meets it),
/// and a person who says that it may go on.
void StopAndGoOn(const Strategy& strategy, bool half) {
  CAPTURE(strategy.name, half);
  SeveralRound several(strategy);
  FakeWorld& world = several.world;
  const auto stop = [&] { world.StopArm(ArmMode::kProtectiveStop, "a person came near"); };
  half ? world.During(strategy.kind(), 1, stop) : world.After(strategy.kind(), 1, stop);
  int asked = 0;
  several.round.setup.acknowledge = [&](const std::string& what) {
    ++asked;
    CHECK_THAT(what, Catch::Contains("a person came near"));
    CHECK(world.held() == 2);
    return Acknowledgement::kGoOn;
  };
  several.round.Run(2);
  INFO(several.round.attempts_text());
  CHECK(asked == 1);
  CHECK(world.Count(FakeTube::Place::kLost) == 0);
  REQUIRE(several.round.notes.attempts.size() == 2);
  CheckEnds(several.round, strategy, "fault", "protective stop");
}

TEST_CASE("A stop during putback: on a person's word all go back and the round goes on", "[unit]") {
  for (const bool half : {true, false}) StopAndGoOn(AllStrategies().back(), half);
}

TEST_CASE("A stop during a tilt: on a person's word all go back and the round goes on", "[unit]") {
  for (const Strategy& strategy : MovingStrategies()) {
    if (strategy.lowers) continue;
    for (const bool half : {true, false}) StopAndGoOn(strategy, half);
  }
}

TEST_CASE("A stop during a strategy ends the round with all in the fingers if nobody is there",
          "[unit]") {
  for (const Strategy& strategy : MovingStrategies()) {
    CAPTURE(strategy.name);
    SeveralRound several(strategy);
    FakeWorld& world = several.world;
    world.During(strategy.kind(), 1,
                 [&] { world.StopArm(ArmMode::kProtectiveStop, "a person came near"); });
    several.round.Run();
    CHECK(several.round.end() == "fault");
    CHECK(several.round.notes.attempts.size() == 1);
    CHECK(world.held() == 2);
    CHECK(world.CountMotions(strategy.kind()) == 1);
  }
}

TEST_CASE("A strategy whose way is refused puts all back", "[unit]") {
  for (const Strategy& strategy : AllStrategies()) {
    CAPTURE(strategy.name);
    SeveralRound several(strategy);
    several.world.model.layout.p_BTilt = {1.6, 0.0, 0.575};  // Out of reach.
    several.round.Run(2);
    CheckEnds(several.round, strategy, "put_back", "");
    CHECK_FALSE(several.round.attempt(0).resolution_outcome.has_value());
    CHECK(several.world.CountMotions(MotionKind::kTilt) == 0);
    CHECK(several.world.Count(FakeTube::Place::kLost) == 0);
  }
}

/// Takes from every joint what no motion of the round needed but the tilts.
void ForbidTilts(FakeWorld& world, const Strategy& strategy) {
  SeveralRound sample(strategy);
  sample.round.Run(2);
  JointVector low = JointVector::Constant(10.0), high = -low;
  for (const FakeMotion& motion : sample.world.motions) {
    if (motion.kind == MotionKind::kTilt || motion.kind == MotionKind::kTiltBack) continue;
    for (const TrajectoryPoint& point : motion.trajectory.points) {
      low = low.cwiseMin(point.q);
      high = high.cwiseMax(point.q);
    }
  }
  for (int k = 0; k < kNumJoints; ++k) {
    world.model.arm.joints[k].lower_rad = low[k] - 0.05;
    world.model.arm.joints[k].upper_rad = high[k] + 0.05;
  }
}

TEST_CASE("Tilts that the arm cannot make at the station put all back", "[unit]") {
  for (const Strategy& strategy : MovingStrategies()) {
    if (strategy.lowers) continue;
    CAPTURE(strategy.name);
    SeveralRound several(strategy);
    ForbidTilts(several.world, strategy);
    several.round.Run(2);
    CheckEnds(several.round, strategy, "put_back", "");
    CHECK_THAT(several.round.attempt(0).reason, !Catch::Contains("several tubes hung"));
    CHECK_FALSE(several.round.attempt(0).resolution_outcome.has_value());
    CHECK(several.world.CountMotions(MotionKind::kTilt) == 0);
    CHECK(several.world.Count(FakeTube::Place::kLost) == 0);
  }
}

TEST_CASE("Tilts go about the load's torque or across it, one by one, and come back", "[unit]") {
  for (const Strategy& strategy : MovingStrategies()) {
    if (strategy.lowers) continue;
    CAPTURE(strategy.name);
    SeveralRound several(strategy);
    FakeWorld& world = several.world;
    Vector3 torque_E = Vector3::Zero();  // E and K are parallel.
    world.After(MotionKind::kLift, 2, [&] { torque_E = world.HeldTorque_K(); });
    several.round.Run(1);
    REQUIRE(torque_E.head<2>().norm() > 0.02);
    Vector3 axis_E = Vector3(torque_E.x(), torque_E.y(), 0.0).normalized();
    // Across the torque in the frame B, whose z points the other way.
    if (strategy.across) axis_E = -Vector3::UnitZ().cross(axis_E);
    const std::vector<FakeMotion> away = world.MotionsOf(MotionKind::kTilt);
    const std::vector<FakeMotion> back = world.MotionsOf(MotionKind::kTiltBack);
    REQUIRE(away.size() == strategy.tilts_deg.size());
    REQUIRE(back.size() == away.size());
    for (std::size_t k = 0; k < away.size(); ++k) {
      const Vector3 wanted_E = Radians(strategy.tilts_deg[k]) * axis_E;
      CHECK((away[k].rotation_E() - wanted_E).norm() < Radians(1.0));
      CHECK((back[k].rotation_E() + away[k].rotation_E()).norm() < Radians(0.1));
      CHECK(away[k].X_BE_from.translation().isApprox(world.model.layout.p_BTilt, 1e-3));
    }
  }
}

TEST_CASE("The first tilt about the torque lets the heavy side go down", "[unit]") {
  SeveralRound several({"plus45", {45.0}, false, false});
  FakeWorld& world = several.world;
  double level_m = 0.0, tilted_m = 0.0;  // Height of the tubes' common centre of mass.
  const auto height_m = [&] {
    double sum_m = 0.0;
    for (const FakeTube& tube : world.tubes) sum_m += (world.X_BE() * CurveCentre(tube.line_E)).z();
    return 0.5 * sum_m - world.X_BE().translation().z();
  };
  world.After(MotionKind::kLift, 2, [&] { level_m = height_m(); });
  world.After(MotionKind::kTilt, 1, [&] { tilted_m = height_m(); });
  several.round.Run(1);
  CHECK(tilted_m < level_m - 0.01);
}

TEST_CASE("Angle and speed of the tilts are those of the configuration", "[unit]") {
  for (const double speed_deg_s : {10.0, 40.0}) {
    SeveralRound several({"plus45", {30.0}, false, false});
    several.round.setup.resolution.angle_deg = 30.0;
    several.round.setup.resolution.speed_deg_s = speed_deg_s;
    several.round.Run(1);
    const std::vector<FakeMotion> away = several.world.MotionsOf(MotionKind::kTilt);
    REQUIRE(away.size() == 1);
    CHECK(Degrees(away[0].rotation_E().norm()) == Approx(30.0).epsilon(0.01));
    CHECK(away[0].duration_s > 30.0 / speed_deg_s);
    CHECK(away[0].duration_s < 30.0 / speed_deg_s + 1.5);
  }
}

TEST_CASE("A tilted load gets time to slide before the tool comes back", "[unit]") {
  SeveralRound several({"plus45", {45.0}, false, false});
  several.round.Run(1);
  const FakeMotion away = several.world.MotionsOf(MotionKind::kTilt).at(0);
  const FakeMotion back = several.world.MotionsOf(MotionKind::kTiltBack).at(0);
  CHECK(Seconds(back.began - away.began) - away.duration_s > 0.9);
}

TEST_CASE("Putback lets the load down into the bin at the station and takes it up again",
          "[unit]") {
  SeveralRound several({"putback", {}, false, true});
  FakeWorld& world = several.world;
  world.After(MotionKind::kLower, 1, [&] { world.Fall(1); });
  several.round.Run(1);
  const FakeMotion down = world.MotionsOf(MotionKind::kLower).at(0);
  const FakeMotion up = world.MotionsOf(MotionKind::kLift).back();
  CHECK(down.X_BE_from.translation().isApprox(world.model.layout.p_BTilt, 1e-3));
  CHECK(down.X_BE_to.translation().z() ==
        Approx(world.cell.bin.X_BN.translation().z() + 0.10).margin(1e-3));
  CHECK(up.X_BE_to.translation().isApprox(world.model.layout.p_BTilt, 1e-3));
  CHECK(world.CountMotions(MotionKind::kTilt) == 0);
}

}  // namespace
}  // namespace tubetwin
