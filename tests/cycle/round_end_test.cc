// When a round is over, and why.

#include <algorithm>

#include "tests/support/catch.h"
#include "tests/support/fake_round.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

using test::FakeRound;
using test::FakeTube;
using test::FakeWorld;
using test::MotionKind;
using test::TwoTubes;

/// A tube along a wall of the small bin: no finger fits between them.
Polyline AtTheWall() {
  const double y = 0.18 - kRadius - 0.001;
  return StraightLine({-0.11, y, kRadius}, {0.12, y, kRadius});
}

TEST_CASE("An empty bin is looked at and nothing else happens", "[unit]") {
  FakeWorld world({});
  FakeRound round(world);
  round.Run();
  CHECK(round.end() == "empty");
  CHECK(round.notes.attempts.empty());
  CHECK(world.CountMotions(MotionKind::kDown) == 0);
  CHECK(world.scans == 1);
}

TEST_CASE("A bin with something in it that is no tube is not called empty", "[unit]") {
  FakeWorld world({TwoTubes()[0]});
  world.boxes_N = {{{0.10, 0.05, 0.0}, {0.16, 0.10, 0.03}}};
  FakeRound round(world);
  round.Run();
  INFO(round.attempts_text());
  CHECK(world.Count(FakeTube::Place::kTray) == 1);
  CHECK(round.end() == "no_plan");
  CHECK(round.report.placed_believed == 1);
  CHECK_FALSE(round.report.reason.empty());
  // Looked at again before that is said: before the pick, after it, once more.
  CHECK(world.scans == 3);
}

TEST_CASE("Nobody waits for ever: so many attempts for each tube, and ten", "[unit]") {
  FakeWorld world({TwoTubes()[0]});
  for (int k = 0; k < 20; ++k) world.Grab(0);
  FakeRound round(world);
  round.setup.cycle.attempts_per_tube = 2;
  round.Run();
  CHECK(round.end() == "attempt_limit");
  REQUIRE(round.notes.attempts.size() == 12);
  CHECK(round.notes.attempts.back().attempt == 12);
}

TEST_CASE("Who is asked to stop at the beginning does nothing at all", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  round.Run(0);
  CHECK(round.end() == "interrupted");
  CHECK(world.log.empty());
}

TEST_CASE("Who is asked to stop in an attempt ends it first", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  bool asked = false;
  round.setup.stop_requested = [&] { return asked; };
  world.During(MotionKind::kLift, 1, [&] { asked = true; });
  round.Run();
  CHECK(round.end() == "interrupted");
  REQUIRE(round.notes.attempts.size() == 1);
  CHECK(round.outcome(0) == "placed");
}

TEST_CASE("Tubes that no plan can take are named with the reason", "[unit]") {
  FakeWorld world({AtTheWall()});
  FakeRound round(world);
  round.Run();
  INFO(round.attempts_text());
  CHECK(round.end() == "no_plan");
  REQUIRE(round.notes.attempts.size() == 1);
  CHECK(round.outcome(0) == "no_plan");
  CHECK_FALSE(round.attempt(0).plan.has_value());
  CHECK_FALSE(round.attempt(0).rejections.empty());
  CHECK_THAT(round.report.reason, Catch::StartsWith("tube 0: "));
  CHECK_THAT(round.report.reason, !Catch::Contains("no candidate"));
  CHECK(world.CountMotions(MotionKind::kDown) == 0);
}

TEST_CASE("A tube at the wall is pushed to where it can be grasped, and then picked", "[unit]") {
  FakeWorld world({AtTheWall()});
  FakeRound round(world);
  round.setup.planner.nudges = 2;
  round.Run();
  INFO(round.attempts_text());
  CHECK(round.end() == "empty");
  REQUIRE(round.notes.attempts.size() == 1);
  CHECK(round.outcome(0) == "placed");
  REQUIRE_FALSE(round.attempt(0).nudges.empty());
  const NudgeReport& nudge = round.attempt(0).nudges.front();
  CHECK(nudge.contact);
  CHECK(nudge.press_N > 1.0);
  CHECK(nudge.direction_N.y() < -0.9);
  CHECK(nudge.rejected.empty());
}

TEST_CASE("Where pushing does not help it is done so often as allowed, and no more", "[unit]") {
  FakeWorld world({AtTheWall()});
  world.rolls = 0.0;
  FakeRound round(world);
  round.setup.planner.nudges = 2;
  round.Run();
  INFO(round.attempts_text());
  CHECK(round.end() == "no_plan");
  REQUIRE(round.notes.attempts.size() == 1);
  CHECK(round.attempt(0).nudges.size() == 2);
  CHECK(world.scans == 3);
}

/// A long bin over which four views look, and a tube near either end.
Bin LongBin() {
  Bin bin;
  bin.size_m = {0.77, 0.30, 0.09};
  return bin;
}

Polyline Across(double x_m, double slope_m = 0.0) {
  return StraightLine({x_m - slope_m, -0.11, kRadius}, {x_m + slope_m, 0.12, kRadius});
}

TEST_CASE("Every scan is taken from the place that was chosen for it", "[unit]") {
  FakeWorld world({Across(-0.30, 0.02), Across(0.0, -0.02), Across(0.30, 0.01)}, LongBin());
  FakeRound round(world);
  round.setup.scan.overhead_m = 0.0;
  const std::vector<RigidTransform> wanted_BS =
      ScanPoses(round.setup.scan, world.model, world.cell.bin, world.part.radius_m);
  int astray = 0;
  const auto look = world.scanner.look;
  world.scanner.look = [&] {
    const OrganizedCloud cloud = look();
    const Vector3 p_BS = world.cell.bin.X_BN * cloud.X_NS.translation();
    const bool right = std::any_of(
        wanted_BS.begin(), wanted_BS.end(),
        [&](const RigidTransform& X_BS) { return (X_BS.translation() - p_BS).norm() < 0.002; });
    if (!right) ++astray;
    return cloud;
  };
  round.Run();
  CAPTURE(world.scans, astray);
  CHECK(astray == 0);
}

TEST_CASE("After a placed tube only the views that saw it are taken again", "[unit]") {
  FakeWorld world({Across(-0.30), Across(0.30)}, LongBin());
  FakeRound round(world);
  round.setup.scan.overhead_m = 0.0;
  std::vector<int> scans;
  round.notes.on_plan = [&] { scans.push_back(world.scans); };
  round.Run();
  INFO(round.attempts_text());
  CHECK(round.end() == "empty");
  REQUIRE(scans.size() == 2);
  CHECK(scans[0] == 4);
  CHECK(scans[1] > 4);
  CHECK(scans[1] < 8);
  CHECK(world.Count(FakeTube::Place::kTray) == 2);
}

TEST_CASE("What touched the taken tube may have moved: views that see it are taken again too",
          "[unit]") {
  const double wall_y = 0.15 - kRadius - 0.001;
  for (const bool touches : {true, false}) {
    CAPTURE(touches);
    // The tube along the wall cannot be grasped, and reaches to where the taken one is not seen.
    const double end_y = wall_y - 2 * kRadius - (touches ? 0.003 : 0.030);
    FakeWorld world({StraightLine({-0.20, end_y - 0.24, kRadius}, {-0.20, end_y, kRadius}),
                     StraightLine({-0.21, wall_y, kRadius}, {0.03, wall_y, kRadius})},
                    LongBin());
    FakeRound round(world);
    round.setup.scan.overhead_m = 0.0;
    std::vector<int> scans;
    round.notes.on_scene = [&] { scans.push_back(world.scans); };
    round.Run();
    INFO(round.attempts_text());
    REQUIRE(round.outcome(0) == "placed");
    REQUIRE(scans.size() >= 2);
    CHECK(scans[1] - scans[0] == (touches ? 3 : 2));
  }
}

TEST_CASE("With rescan_all, and after an attempt that failed, every view is taken again",
          "[unit]") {
  for (const bool all : {true, false}) {
    CAPTURE(all);
    FakeWorld world({Across(-0.30), Across(0.30)}, LongBin());
    if (!all) world.Grab(0);
    FakeRound round(world);
    round.setup.scan.overhead_m = 0.0;
    round.setup.scan.rescan_all = all;
    std::vector<int> scans;
    round.notes.on_plan = [&] { scans.push_back(world.scans); };
    round.Run(2);
    CHECK(scans == std::vector<int>{4, 8});
  }
}

TEST_CASE("Before a bin is called empty all views are taken again", "[unit]") {
  FakeWorld world({Across(-0.30)}, LongBin());
  FakeRound round(world);
  round.setup.scan.overhead_m = 0.0;
  round.Run();
  CHECK(round.end() == "empty");
  // Four, those near the tube, and then all again.
  CHECK(world.scans > 8);
}

TEST_CASE("Without a plan all is looked at again before anything is pushed or given up", "[unit]") {
  const double x = 0.385 - kRadius - 0.001;
  FakeWorld world({Across(-0.30), Across(x)}, LongBin());
  FakeRound round(world);
  round.setup.scan.overhead_m = 0.0;
  int before = 0;
  round.notes.on_attempt_end = [&] {
    if (before == 0) before = world.scans;
  };
  round.Run();
  INFO(round.attempts_text());
  CHECK(round.outcome(0) == "placed");
  CHECK(round.end() == "no_plan");
  CHECK(world.scans - before > 4);  // Some of the views, and then all.
}

TEST_CASE("More tubes than can be left are what an old view still shows: all is looked at again",
          "[unit]") {
  FakeWorld world({Across(-0.30), Across(0.30)}, LongBin());
  FakeRound round(world);
  round.setup.scan.overhead_m = 0.0;
  // A tube that was hidden comes to light where the first one was taken.
  round.notes.on_attempt_end = [&] {
    if (round.notes.attempts.size() == 1) {
      world.tubes.push_back({FakeTube::Place::kBin, Across(-0.25), {}, {}});
      world.tubes.push_back({FakeTube::Place::kBin, Across(-0.32), {}, {}});
    }
  };
  std::vector<int> scans;
  round.notes.on_plan = [&] { scans.push_back(world.scans); };
  round.Run(2);
  REQUIRE(scans.size() == 2);
  CHECK(scans[1] > 8);
}

}  // namespace
}  // namespace tubetwin
