// One attempt after the other in a fake world: what the fingers may close on, and what is made of
// it. The first test shows how such a test is written.

#include <algorithm>

#include "models/gripper_spec.h"
#include "tests/support/catch.h"
#include "tests/support/fake_round.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

using test::FakeMotion;
using test::FakeRound;
using test::FakeTube;
using test::FakeWorld;
using test::MotionKind;
using test::TwoTubes;

/// Distance of two grasps, or 1 m where the motion after them is another one.
double Apart_m(const PickPlan& a, const PickPlan& b) {
  if (a.motion.name != b.motion.name) return 1.0;
  return (a.grasp.X_NG.translation() - b.grasp.X_NG.translation()).norm();
}

TEST_CASE("A bin is emptied tube by tube, each laid on the tray", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  round.Run();
  INFO(round.attempts_text());
  CHECK(round.end() == "empty");
  REQUIRE(round.notes.attempts.size() == 2);
  CHECK(round.report.placed_believed == 2);
  CHECK(world.Count(FakeTube::Place::kTray) == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(round.outcome(k) == "placed");
    CHECK(round.attempt(k).attempt == 1);
    CHECK(round.attempt(k).tubes_in_bin == 2 - static_cast<int>(k));
    CHECK(round.attempt(k).detection->outcome == HeldOutcome::kOne);
    CHECK_FALSE(round.attempt(k).resolution_used);
  }
  CHECK(world.CountMotions(MotionKind::kTilt) == 0);
  CHECK(world.scans == 3);  // Before each pick and of the empty bin.
}

TEST_CASE("Every tube lies in a slot of its own, where it was meant to lie", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  round.Run();
  REQUIRE(world.Count(FakeTube::Place::kTray) == 2);
  CHECK(ClosestOfLines(world.tubes[0].line_T, world.tubes[1].line_T).distance_m > 0.04);
  for (std::size_t k = 0; k < 2; ++k) REQUIRE(round.attempt(k).slot_centre_T);
  for (const FakeTube& tube : world.tubes) {
    for (const Vector3& p_T : tube.line_T) CHECK(p_T.z() == Approx(0.0125).margin(0.008));
    const Vector3 centre_T = CurveCentre(tube.line_T);
    CHECK(std::any_of(round.notes.attempts.begin(), round.notes.attempts.end(),
                      [&](const AttemptReport& attempt) {
                        return (*attempt.slot_centre_T - centre_T).head<2>().norm() < 0.01;
                      }));
  }
}

TEST_CASE("A load that swings is weighed when it has come to rest", "[unit]") {
  FakeWorld world(TwoTubes());
  world.swing_N = 1.5;  // More than two tubes weigh.
  world.During(MotionKind::kCarry, 1, [&] { world.swing_N = 0.0; });
  FakeRound round(world);
  round.Run(1);
  INFO(round.attempts_text());
  CHECK(round.outcome(0) == "placed");
  CHECK(round.attempt(0).detection->force_N == Approx(world.part.mass_kg * kGravity).epsilon(0.15));
}

TEST_CASE("A hose is set in motion no faster than it swings", "[unit]") {
  Part hose = FakeWorld::ShortTube();
  hose.mass_kg = 0.2;
  hose.bending_stiffness_Nm2 = 0.005;  // One period is 0.3 s.
  double lift_s = 0.0;
  for (const char* kind : {"rigid", "hose"}) {
    CAPTURE(kind);
    hose.kind = kind;
    FakeWorld world(TwoTubes(), FakeWorld::SmallBin(), hose);
    FakeRound round(world);
    round.Run(1);
    INFO(round.attempts_text());
    REQUIRE(round.outcome(0) == "placed");
    const double lifted_s = world.MotionsOf(MotionKind::kLift).at(1).duration_s;
    if (lift_s > 0.0) CHECK(lifted_s > lift_s + 0.03);
    lift_s = lifted_s;
  }
}

TEST_CASE("A pick is approach, guarded descent, closing, two lifts, carry, lay and retreat",
          "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  round.Run(1);
  REQUIRE(round.outcome(0) == "placed");
  std::string order;
  for (const FakeMotion& motion : world.motions) order += std::string(ToString(motion.kind)) + " ";
  // To the view and to above the grasp; fast and guarded, to the grasp and onto the tray.
  CHECK(order == "across across down down lift lift carry lay lay up ");
  const PickPlan& plan = *round.attempt(0).plan;
  const FakeMotion& guarded = world.MotionsOf(MotionKind::kDown).back();
  // The pads move forward as they close: they meet the tube where the plan wants them.
  const RigidTransform X_BE =
      world.cell.bin.X_BN * plan.grasp.X_NG *
      Translation(0, 0, PadRetreat(PaperCell().gripper, 2 * world.part.radius_m));
  CHECK((guarded.X_BE_to.translation() - X_BE.translation()).norm() < 5e-4);
  const std::vector<FakeMotion> lifts = world.MotionsOf(MotionKind::kLift);
  const double first_m = (lifts[0].X_BE_to.translation() - lifts[0].X_BE_from.translation()).norm();
  CHECK(first_m == Approx(round.setup.cycle.first_lift_m).epsilon(0.01));
  const double whole_m = (lifts[1].X_BE_to.translation() - lifts[0].X_BE_from.translation()).norm();
  CHECK(whole_m == Approx(round.setup.planner.lift_m).epsilon(0.01));
}

TEST_CASE("The fingers open as planned, close with the force of the configuration and let go wider",
          "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  round.setup.cycle.grip_force_N = 77.0;
  std::vector<GripperCommand> commands;
  const auto move = world.gripper.on_command;
  world.gripper.on_command = [&](const GripperCommand& command) {
    commands.push_back(command);
    move(command);
  };
  round.Run(1);
  REQUIRE(round.outcome(0) == "placed");
  REQUIRE(commands.size() == 3);
  CHECK(commands[0].opening_m == Approx(round.attempt(0).plan->grasp.opening_m));
  CHECK(commands[1].opening_m == 0.0);
  CHECK(commands[1].force_N == 77.0);
  CHECK(commands[2].opening_m > 2 * world.part.radius_m + 0.01);
}

TEST_CASE("Each attempt tares with empty fingers and an upright tool over the grasp", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  round.Run(2);
  REQUIRE(round.notes.references_K.size() == 2);
  for (const Wrench& reference_K : round.notes.references_K) {
    CHECK(reference_K.force_N.z() ==
          Approx((PaperCell().gripper.mass_kg + PaperCell().gripper.coupling_mass_kg) * kGravity)
              .epsilon(1e-6));
  }
}

TEST_CASE("The arm is told what it carries from the closing to the letting go", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  std::vector<double> carried_kg, empty_kg;
  world.After(MotionKind::kLift, 1, [&] { carried_kg.push_back(world.arm.payload_kg); });
  world.After(MotionKind::kLay, 1, [&] { carried_kg.push_back(world.arm.payload_kg); });
  world.After(MotionKind::kDown, 1, [&] { empty_kg.push_back(world.arm.payload_kg); });
  round.Run(1);
  CHECK(carried_kg == std::vector<double>(2, world.part.mass_kg));
  CHECK(empty_kg == std::vector<double>(1, 0.0));
  CHECK(world.arm.payload_kg == 0.0);
}

TEST_CASE("The cell is proven by its first placed tube and by nothing less", "[unit]") {
  FakeWorld world(TwoTubes());
  world.Grab(0);
  FakeRound round(world);
  std::vector<bool> proven;
  round.notes.on_attempt_end = [&] { proven.push_back(world.cell.proven); };
  round.Run(2);
  REQUIRE(round.outcome(1) == "placed");
  CHECK_FALSE(proven[0]);
  CHECK(world.cell.proven);
}

TEST_CASE("Fingers that close on nothing give the grasp up and try another one", "[unit]") {
  FakeWorld world(TwoTubes());
  world.Grab(0);
  FakeRound round(world);
  round.Run(2);
  INFO(round.attempts_text());
  CHECK(round.outcome(0) == "nothing_held");
  CHECK(round.attempt(0).reason == "the fingers closed on nothing");
  CHECK(round.outcome(1) == "placed");
  CHECK(round.attempt(1).attempt == 2);
  REQUIRE(round.notes.plans.size() == 2);
  CHECK(Apart_m(round.notes.plans[0], round.notes.plans[1]) >= 0.015);
}

TEST_CASE("A grasp that failed is tried again where no other is left", "[unit]") {
  FakeWorld world({TwoTubes()[0]});
  world.Grab(0);
  FakeRound round(world);
  round.setup.planner.max_plans = 1;
  round.Run(2);
  CHECK(round.outcome(0) == "nothing_held");
  CHECK(round.outcome(1) == "placed");
  CHECK(Apart_m(round.notes.plans.at(0), round.notes.plans.at(1)) < 0.015);
}

TEST_CASE("What failed before a placed tube may be tried again after it", "[unit]") {
  FakeWorld world(TwoTubes());
  world.Grab(0);
  FakeRound round(world);
  // The first tube's only plan fails, the other tube is placed; then there are more plans for the
  // first one, and the one that failed is the best again.
  round.setup.planner.plans_per_tube = 1;
  round.notes.on_attempt_end = [&] {
    if (round.notes.attempts.size() == 2) round.setup.planner.plans_per_tube = 3;
  };
  round.Run(3);
  INFO(round.attempts_text());
  REQUIRE(round.outcome(2) == "placed");
  CHECK(round.attempt(1).attempt == 2);
  CHECK(round.attempt(2).attempt == 1);
  const auto place = [&](std::size_t k) {
    return round.notes.plans.at(k).grasp.X_NG.translation();
  };
  CHECK((place(0) - place(2)).norm() < 0.002);
}

TEST_CASE("Something met well above the grasp ends the descent, and the fingers do not close",
          "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  world.obstacle_height_m = 0.030;
  round.notes.on_attempt_end = [&] { world.obstacle_height_m.reset(); };
  bool closed = false;
  const auto move = world.gripper.on_command;
  world.gripper.on_command = [&](const GripperCommand& command) {
    closed = closed || (command.opening_m < 0.004 && world.obstacle_height_m);
    move(command);
  };
  round.Run(2);
  INFO(round.attempts_text());
  CHECK(round.outcome(0) == "nothing_held");
  CHECK_THAT(round.attempt(0).reason,
             Catch::Contains("met something") && Catch::Contains("mm above the grasp"));
  CHECK_FALSE(closed);
  CHECK(round.outcome(1) == "placed");
}

TEST_CASE("Something met just above the grasp is the tube itself", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  world.After(MotionKind::kDown, 1,
              [&] { world.obstacle_height_m = world.X_NE().translation().z() - 0.008; });
  round.Run(1);
  INFO(round.attempts_text());
  CHECK(round.outcome(0) == "placed");
  const FakeMotion& lift = world.MotionsOf(MotionKind::kLift).front();
  const FakeMotion& guarded = world.MotionsOf(MotionKind::kDown).at(1);
  CHECK(lift.X_BE_from.translation().z() > guarded.X_BE_to.translation().z() + 0.0005);
}

TEST_CASE("A tube that slips out on the way up is noticed by weight and by the fingers", "[unit]") {
  for (const int lift : {1, 2}) {
    CAPTURE(lift);
    FakeWorld world(TwoTubes());
    world.After(MotionKind::kLift, lift, [&] { world.Fall(1); });
    FakeRound round(world);
    round.Run(2);
    INFO(round.attempts_text());
    CHECK(round.outcome(0) == "nothing_held");
    CHECK(round.attempt(0).reason == "the tube slipped out of the fingers");
    CHECK(world.MotionsOf(MotionKind::kCarry).size() == 1);  // Of the second attempt.
    CHECK(round.outcome(1) == "placed");
    CHECK(Apart_m(round.notes.plans.at(0), round.notes.plans.at(1)) >= 0.015);
  }
}

TEST_CASE("Fingers that hold something without weight keep it, and the round ends", "[unit]") {
  Part feather = FakeWorld::ShortTube();
  feather.mass_kg = 0.005;
  FakeWorld world(TwoTubes(), FakeWorld::SmallBin(), feather);
  FakeRound round(world);
  round.setup.part.mass_kg = 0.055;
  round.Run(1);
  CHECK(round.outcome(0) == "fault");
  CHECK_THAT(round.attempt(0).reason, Catch::Contains("the wrist weighs 0.0 N, the gripper says "
                                                      "that it holds something of 25.0 mm"));
  CHECK(world.held() == 1);
}

TEST_CASE("A tube lost while it is carried stops the arm, and the round goes on", "[unit]") {
  FakeWorld world(TwoTubes());
  world.During(MotionKind::kCarry, 1, [&] { world.Fall(1); });
  FakeRound round(world);
  round.Run(2);
  INFO(round.attempts_text());
  CHECK(round.outcome(0) == "dropped");
  CHECK_THAT(round.attempt(0).reason, Catch::Contains("while a tube was carried"));
  CHECK(world.arm.stopped == 1);
  CHECK(world.CountMotions(MotionKind::kLay) == 2);  // Of the second attempt.
  CHECK(round.outcome(1) == "placed");
  CHECK_FALSE(world.cell.carried_opening_m);
}

TEST_CASE("A tube that is gone over the tray is noticed before anything is laid", "[unit]") {
  FakeWorld world(TwoTubes());
  world.After(MotionKind::kCarry, 1, [&] { world.Fall(1); });
  FakeRound round(world);
  round.Run(2);
  INFO(round.attempts_text());
  CHECK(round.outcome(0) == "dropped");
  CHECK(round.attempt(0).reason == "nothing hangs in the fingers over the tray");
  CHECK(world.CountMotions(MotionKind::kLay) == 2);
  CHECK(round.outcome(1) == "placed");
}

TEST_CASE("Where fingers say that the tube is lost and the wrist still weighs it, nothing opens",
          "[unit]") {
  FakeWorld world(TwoTubes());
  world.During(MotionKind::kCarry, 1, [&] {
    world.gripper.state.object = GripperObject::kAtPosition;
    world.gripper.state.opening_m = 0.0;
  });
  FakeRound round(world);
  round.Run();
  CHECK(round.end() == "fault");
  CHECK(round.outcome(0) == "fault");
  CHECK_THAT(round.report.reason, Catch::Contains("wrist and gripper disagree: the wrist weighs "
                                                  "0.5 N, the gripper says that it stands at "
                                                  "0.0 mm and holds nothing"));
  CHECK(world.held() == 1);
}

TEST_CASE("After a tube was laid nothing is waited for but the arm", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  round.Run(2);
  REQUIRE(round.outcome(1) == "placed");
  for (std::size_t k = 1; k + 1 < world.motions.size(); ++k) {
    const FakeMotion& up = world.motions[k];
    if (world.motions[k - 1].kind != MotionKind::kLay || up.kind != MotionKind::kUp) continue;
    const double waited_s = Seconds(world.motions[k + 1].began - up.began) - up.duration_s;
    CHECK(waited_s < 0.3);
  }
}

TEST_CASE("With several in the fingers and nothing to be done about it, all go back", "[unit]") {
  FakeWorld world(TwoTubes());
  world.Grab(2);
  FakeRound round(world);
  round.setup.resolution.strategy = "none";
  round.Run(2);
  INFO(round.attempts_text());
  CHECK(round.outcome(0) == "put_back");
  CHECK(round.attempt(0).detection->outcome == HeldOutcome::kSeveral);
  CHECK(round.outcome(1) == "placed");
  CHECK(Apart_m(round.notes.plans.at(0), round.notes.plans.at(1)) >= 0.015);
}

TEST_CASE("With end_at_several the round ends there and then, all still in the fingers", "[unit]") {
  FakeWorld world(TwoTubes());
  world.Grab(2);
  FakeRound round(world);
  round.setup.cycle.end_at_several = true;
  round.Run();
  CHECK(round.end() == "stored");
  CHECK(round.notes.several.size() == 1);
  CHECK(round.notes.attempts.empty());
  CHECK(world.held() == 2);
  CHECK(world.motions.back().kind == MotionKind::kLift);
}

}  // namespace
}  // namespace tubetwin
