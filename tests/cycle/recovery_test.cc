// Motions that are refused, devices that stop or fall silent, and who may say that it goes on.

#include <algorithm>

#include "tests/support/catch.h"
#include "tests/support/fake_round.h"

namespace tubetwin {
namespace {

using test::FakeRound;
using test::FakeTube;
using test::FakeWorld;
using test::MotionKind;
using test::TwoTubes;

/// A kind of motion, which of them, and whether a tube hangs in the fingers then.
struct Moment {
  MotionKind kind;
  int nth;
  bool held;
};

std::vector<Moment> MomentsOfAPick() {
  return {{MotionKind::kAcross, 1, false}, {MotionKind::kAcross, 2, false},
          {MotionKind::kDown, 1, false},   {MotionKind::kDown, 2, false},
          {MotionKind::kLift, 1, true},    {MotionKind::kLift, 2, true},
          {MotionKind::kCarry, 1, true},   {MotionKind::kLay, 1, true},
          {MotionKind::kLay, 2, true},     {MotionKind::kUp, 1, false}};
}

TEST_CASE("Where the tray is out of reach the tube goes back, and six times are enough", "[unit]") {
  FakeWorld world(TwoTubes());
  world.model.layout.X_BT = Translation(0.05, -3.0, 0.10);
  FakeRound round(world);
  round.Run();
  INFO(round.attempts_text());
  CHECK(round.end() == "no_plan");
  CHECK_THAT(round.report.reason, Catch::Contains("no slot of the tray is in reach"));
  REQUIRE(round.notes.attempts.size() == 6);
  for (std::size_t k = 0; k < 6; ++k) {
    CHECK(round.outcome(k) == "put_back");
    CHECK_THAT(round.attempt(k).reason, Catch::Contains("no slot of the tray is in reach"));
    CHECK(round.attempt(k).attempt == static_cast<int>(k) + 1);
  }
  CHECK(world.CountMotions(MotionKind::kCarry) == 0);
  CHECK(world.Count(FakeTube::Place::kLost) == 0);
}

TEST_CASE("After a refusal with a tube in the fingers another grasp is tried first", "[unit]") {
  FakeWorld world(TwoTubes());
  world.model.layout.X_BT = Translation(0.05, -3.0, 0.10);
  FakeRound round(world);
  round.Run(2);
  REQUIRE(round.notes.plans.size() == 2);
  CHECK((round.notes.plans[0].grasp.X_NG.translation() -
         round.notes.plans[1].grasp.X_NG.translation())
            .norm() >= 0.015);
}

TEST_CASE("A refused motion with empty fingers leads to the next plan, never to a fault",
          "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  // Between the first plan and the way to it the arm is pushed, so that its path is planned anew,
  // and joint 2 loses what it needs for it. The next plan finds all as it was.
  int narrowed = 0;
  const ArmModel whole = world.model.arm;
  const auto restore = [&] {
    world.model.arm = whole;
    world.arm.pushed.setZero();
  };
  round.notes.on_plan = [&] {
    restore();
    if (++narrowed > 1) return;
    world.arm.pushed.setConstant(0.002);
    world.model.arm.joints[1].upper_rad = world.arm.State().q[1] - 0.3;
  };
  round.notes.on_attempt_end = restore;
  round.Run();
  INFO(round.attempts_text());
  CHECK(round.end() == "empty");
  for (const AttemptReport& attempt : round.notes.attempts) {
    CHECK(attempt.outcome != AttemptOutcome::kFault);
  }
  CHECK(world.Count(FakeTube::Place::kTray) == 2);
}

/// Ends the trouble that a test made as soon as the cycle puts back what it holds.
class EndsWhenPutBack : public test::CycleNotes {
 public:
  explicit EndsWhenPutBack(std::function<void()> end) : end_(std::move(end)) {}
  void OnStep(const std::string& caption) override {
    if (caption == "putting back") end_();
  }

 private:
  std::function<void()> end_;
};

TEST_CASE("What is refused over the tray goes back to the bin, not down where it is", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  const ArmModel whole = world.model.arm;
  // Pushed over the tray, where joint 2 loses what it needs to go down.
  world.After(MotionKind::kCarry, 1, [&] {
    world.arm.pushed.setConstant(0.002);
    world.model.arm.joints[1].upper_rad = world.arm.State().q[1] - 0.3;
  });
  EndsWhenPutBack notes([&] {
    world.arm.pushed.setZero();
    world.model.arm = whole;
  });
  round.setup.stop_requested = [&] { return notes.attempts.size() == 2; };
  RunPickCycle(world.cell, round.setup, notes);
  round.CheckFaults();
  REQUIRE(notes.attempts.size() == 2);
  CHECK(notes.attempts[0].outcome == AttemptOutcome::kPutBack);
  CHECK(notes.attempts[1].outcome == AttemptOutcome::kPlaced);
  CHECK(world.Count(FakeTube::Place::kTray) == 1);
  CHECK(world.Count(FakeTube::Place::kBin) == 1);
}

TEST_CASE("A stop ends the round where it is if nobody is there or the person says so", "[unit]") {
  for (const Moment& moment : MomentsOfAPick()) {
    for (const bool somebody : {false, true}) {
      CAPTURE(ToString(moment.kind), moment.nth, somebody);
      FakeWorld world(TwoTubes());
      FakeRound round(world);
      std::size_t commands = 0;
      world.During(moment.kind, moment.nth, [&] {
        world.StopArm(ArmMode::kEmergencyStop, "button pressed");
        commands = world.log.size();
      });
      if (somebody) {
        round.setup.acknowledge = [](const std::string&) { return Acknowledgement::kEnd; };
      }
      round.Run();
      CHECK(round.end() == "fault");
      CHECK_THAT(round.report.reason,
                 Catch::Contains("emergency stop") && Catch::Contains("button pressed"));
      CHECK(round.outcome(round.notes.attempts.size() - 1) == "fault");
      CHECK(world.log.size() == commands);  // Nothing moves any more.
      CHECK(world.arm.recovered == 0);
      CHECK(world.held() == (moment.held ? 1 : 0));
    }
  }
}

TEST_CASE("On a person's word after a stop: ready, straight up, back into the bin, next attempt",
          "[unit]") {
  for (const Moment& moment : MomentsOfAPick()) {
    CAPTURE(ToString(moment.kind), moment.nth);
    FakeWorld world(TwoTubes());
    FakeRound round(world);
    std::size_t motions = 0;
    world.During(moment.kind, moment.nth, [&] {
      world.StopArm(ArmMode::kProtectiveStop, "a person came near");
      motions = world.motions.size();
    });
    int asked = 0;
    round.setup.acknowledge = [&](const std::string&) {
      ++asked;
      return Acknowledgement::kGoOn;
    };
    round.Run();
    INFO(round.attempts_text());
    CHECK(asked == 1);
    CHECK(world.arm.recovered == 1);
    CHECK(round.outcome(0) == "fault");
    CHECK(round.end() == "empty");
    REQUIRE(world.motions.size() > motions);
    const test::FakeMotion& first = world.motions[motions];
    const Vector3 way_B = first.X_BE_to.translation() - first.X_BE_from.translation();
    CHECK((way_B.z() > 0.0 || std::abs(way_B.z()) < 1e-3));
    CHECK(world.Count(FakeTube::Place::kTray) == 2);
    CHECK(round.report.placed_believed == 2);
  }
}

TEST_CASE("After an alarm somebody is asked, after a lost link nobody", "[unit]") {
  for (const bool link : {false, true}) {
    CAPTURE(link);
    FakeWorld world(TwoTubes());
    FakeRound round(world);
    world.During(MotionKind::kLift, 2, [&] {
      if (link) {
        world.arm.silent = true;
      } else {
        world.StopArm(ArmMode::kFault, "alarm 4321");
      }
    });
    int asked = 0;
    round.setup.acknowledge = [&](const std::string&) {
      ++asked;
      return Acknowledgement::kGoOn;
    };
    round.Run();
    INFO(round.attempts_text());
    CHECK(asked == (link ? 0 : 1));
    CHECK(round.end() == (link ? "fault" : "empty"));
    if (!link) continue;
    CHECK_THAT(round.report.reason, Catch::Contains("s old while it moves"));
    CHECK(world.held() == 1);
    CHECK(world.arm.last_stop == StopKind::kFast);
  }
}

TEST_CASE("An arm that does not become ready ends the round", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  world.During(MotionKind::kLift, 2,
               [&] { world.StopArm(ArmMode::kProtectiveStop, "a person came near"); });
  world.arm.recovers = false;
  round.setup.acknowledge = [](const std::string&) { return Acknowledgement::kGoOn; };
  round.Run();
  CHECK(round.end() == "fault");
  CHECK(round.notes.attempts.size() == 1);
  CHECK(world.held() == 1);
}

TEST_CASE("Every stop is asked about anew", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  for (const int nth : {1, 3}) {
    world.During(MotionKind::kLift, nth,
                 [&] { world.StopArm(ArmMode::kProtectiveStop, "a person came near"); });
  }
  int asked = 0;
  round.setup.acknowledge = [&](const std::string&) {
    return ++asked == 1 ? Acknowledgement::kGoOn : Acknowledgement::kEnd;
  };
  round.Run();
  CHECK(asked == 2);
  CHECK(round.end() == "fault");
}

TEST_CASE("A fault of the gripper or the wrist ends the round and opens nothing", "[unit]") {
  for (const bool gripper : {true, false}) {
    CAPTURE(gripper);
    FakeWorld world(TwoTubes());
    FakeRound round(world);
    world.After(MotionKind::kLift, 2, [&] {
      if (gripper) {
        world.gripper.state.fault = 0x0E;
      } else {
        world.wrist.saturated = true;
      }
    });
    round.setup.acknowledge = [](const std::string&) { return Acknowledgement::kGoOn; };
    round.Run();
    CHECK(round.end() == "fault");
    CHECK_THAT(round.report.reason, Catch::Contains(gripper ? "fault 14" : "saturated"));
    CHECK(world.held() == 1);
  }
}

TEST_CASE("A scan that fails is asked for once more", "[unit]") {
  FakeWorld world(TwoTubes());
  world.scanner.failures = 1;
  FakeRound round(world);
  round.Run(1);
  CHECK(round.outcome(0) == "placed");
  CHECK(world.scanner.triggered == 2);
}

TEST_CASE("A scanner that fails twice is a fault", "[unit]") {
  FakeWorld world(TwoTubes());
  world.scanner.failures = 2;
  FakeRound round(world);
  round.Run();
  CHECK(round.end() == "fault");
  CHECK(round.outcome(0) == "fault");
  CHECK_THAT(round.report.reason, Catch::Contains("scan failed: told to fail"));
  CHECK(world.scanner.triggered == 2);
}

TEST_CASE("What an earlier program left in the fingers moves nowhere without a person's word",
          "[unit]") {
  // What is left shows in the fingers, or hangs on them so that only the wrist tells.
  for (const bool in_fingers : {true, false}) {
    for (const bool somebody : {false, true}) {
      CAPTURE(in_fingers, somebody);
      FakeWorld world(TwoTubes());
      if (in_fingers) {
        world.gripper.state.object = GripperObject::kContactClosing;
        world.gripper.state.opening_m = 2 * world.part.radius_m;
      } else {
        world.wrist.lie = [&](WrenchSample& sample) {
          sample.wrench_K.force_N *= 1.0 + 0.5 / sample.wrench_K.force_N.norm();
        };
      }
      FakeRound round(world);
      std::string asked;
      if (somebody) {
        round.setup.acknowledge = [&](const std::string& what) {
          asked = what;
          return Acknowledgement::kEnd;
        };
      }
      round.Run();
      CHECK(round.end() == "fault");
      CHECK_THAT(round.report.reason, Catch::Contains(in_fingers ? "press on something of 25.0 mm"
                                                                 : "the tool weighs") &&
                                          Catch::Contains("left there by an earlier program"));
      CHECK(asked.empty() == !somebody);
      CHECK(world.log.empty());  // Nothing was commanded.
    }
  }
}

TEST_CASE("On a person's word what was left is put back into the bin, and the round begins",
          "[unit]") {
  FakeWorld world(TwoTubes());
  world.gripper.state.object = GripperObject::kContactClosing;
  world.gripper.state.opening_m = 2 * world.part.radius_m;
  FakeRound round(world);
  std::string asked;
  round.setup.acknowledge = [&](const std::string& what) {
    asked = what;
    return Acknowledgement::kGoOn;
  };
  round.Run();
  INFO(round.attempts_text());
  CHECK_THAT(asked, Catch::Contains("It will be put back into the bin"));
  CHECK(round.end() == "empty");
  CHECK(world.Count(FakeTube::Place::kTray) == 2);
  // The fingers opened low over the bin before anything was looked at.
  const auto first_scan = std::find(world.log.begin(), world.log.end(), "scan");
  const auto opened = std::find_if(world.log.begin(), world.log.end(), [](const std::string& line) {
    return line.starts_with("fingers to 0.05");
  });
  CHECK(opened < first_scan);
}

}  // namespace
}  // namespace tubetwin
