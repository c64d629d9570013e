// What ends a motion, a grip and a weighing on any cell, and that nothing starts again by itself.

#include <cmath>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/fake_cell.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

using test::FakeCell;
using Status = WaitOutcome::Status;

/// Calls `fault` once `at_s` has come.
void At(FakeCell& fake, double at_s, const std::function<void()>& fault) {
  fake.clock.each_period = [&fake, at_s, fault, done = false]() mutable {
    if (done || fake.clock.Now() < FromSeconds(at_s)) return;
    done = true;
    fault();
  };
}

void CheckStopped(FakeCell& fake, const WaitOutcome& outcome, Status status,
                  const std::string& says, double within_s) {
  INFO(outcome.reason);
  CHECK(ToString(outcome.status) == std::string(ToString(status)));
  CHECK_THAT(outcome.reason, Catch::Contains(says));
  CHECK(fake.arm.stopped == 1);
  CHECK(fake.arm.started == 1);
  CHECK(fake.gripper.commands == 0);
  CHECK(Seconds(fake.clock.Now()) < 0.5 + within_s);
}

TEST_CASE("A motion that nothing disturbs is done, and nobody stops it", "[unit]") {
  FakeCell fake;
  CHECK(RunTrajectory(fake.cell, fake.Move(0.2, 1.0)).status == Status::kDone);
  CHECK(fake.arm.stopped == 0);
}

TEST_CASE("An arm that falls silent while it moves is stopped fast: link lost", "[unit]") {
  FakeCell fake;
  At(fake, 0.5, [&] { fake.arm.silent = true; });
  const WaitOutcome outcome = RunTrajectory(fake.cell, fake.Move(0.2, 3.0));
  CheckStopped(fake, outcome, Status::kLinkLost, "s old while it moves", 0.16);
  CHECK(fake.arm.last_stop == StopKind::kFast);
}

TEST_CASE("A person who asks for a stop at once gets it on the path, and nothing moves after it",
          "[unit]") {
  FakeCell fake;
  bool asked = false;
  fake.cell.stop_at_once = [&] { return asked; };
  At(fake, 0.5, [&] { asked = true; });
  CheckStopped(fake, RunTrajectory(fake.cell, fake.Move(0.2, 3.0)), Status::kInterrupted,
               "asked to stop at once", 0.01);
  CHECK(fake.arm.last_stop == StopKind::kOnPath);
  CHECK(RunTrajectory(fake.cell, fake.Move(0.2, 1.0)).status == Status::kInterrupted);
  CHECK(RunGuarded(fake.cell, fake.Move(0.2, 1.0), 10.0).status == Status::kInterrupted);
  CHECK(fake.arm.started == 1);
  CHECK(MoveGripper(fake.cell, {0.08, 0.1, 60.0}).outcome.status == Status::kInterrupted);
  CHECK(fake.gripper.commands == 0);
}

TEST_CASE("An arm that leaves its path is stopped, one that lags on it is not", "[unit]") {
  FakeCell fake;
  At(fake, 0.5, [&] { fake.arm.offset[3] = Radians(8.0); });
  CheckStopped(fake, RunTrajectory(fake.cell, fake.Move(0.2, 3.0)), Status::kDeviated,
               "degrees off the path, 3.00 allowed", 0.01);

  // Everything 0.3 s late: far from where the progress says, but on the path.
  FakeCell late;
  late.cell.safety.deviation_deg = 0.2;
  const CheckedTrajectory move = late.Move(0.8, 2.0);
  late.clock.each_period = [&] {
    const double t = Seconds(late.clock.Now());
    late.arm.offset =
        Sample(move.trajectory(), std::max(0.0, t - 0.3)).q - Sample(move.trajectory(), t).q;
  };
  CHECK(RunTrajectory(late.cell, move).status == Status::kDone);
}

TEST_CASE("A fault or silence of the gripper stops the arm", "[unit]") {
  FakeCell fake;
  At(fake, 0.5, [&] { fake.gripper.state.fault = 0x0E; });
  CheckStopped(fake, RunTrajectory(fake.cell, fake.Move(0.2, 3.0)), Status::kGripperFault,
               "fault 14", 0.01);
  FakeCell silent;
  At(silent, 0.5, [&] { silent.gripper.silent = true; });
  CheckStopped(silent, RunTrajectory(silent.cell, silent.Move(0.2, 3.0)), Status::kGripperFault,
               "gripper: newest state is", 0.51);
}

TEST_CASE("Fingers that close on nothing end a motion only while a tube is carried", "[unit]") {
  for (const bool carrying : {false, true}) {
    FakeCell fake;
    if (carrying) fake.cell.carried_opening_m = 0.0;
    fake.gripper.state.object = GripperObject::kContactClosing;
    fake.gripper.state.requested_m = 0.0;
    At(fake, 0.5, [&] { fake.gripper.state.object = GripperObject::kAtPosition; });
    const WaitOutcome outcome = RunTrajectory(fake.cell, fake.Move(0.2, 3.0));
    if (carrying) {
      CheckStopped(fake, outcome, Status::kObjectLost, "while a tube was carried", 0.01);
    } else {
      CHECK(outcome.status == Status::kDone);
    }
  }
}

TEST_CASE("Fingers that give way while a tube is carried end the motion", "[unit]") {
  for (const double opened_m : {0.0295, 0.0305}) {  // 5 mm are the limit.
    FakeCell fake;
    fake.cell.carried_opening_m = 0.025;
    fake.gripper.state.object = GripperObject::kContactClosing;
    fake.gripper.state.opening_m = 0.025;
    At(fake, 0.5, [&] { fake.gripper.state.opening_m = opened_m; });
    const WaitOutcome outcome = RunTrajectory(fake.cell, fake.Move(0.2, 3.0));
    if (opened_m < 0.03) {
      CHECK(outcome.status == Status::kDone);
    } else {
      CheckStopped(fake, outcome, Status::kGripperFault, "opened from 25.0 to 30.5 mm", 0.01);
    }
  }
}

TEST_CASE("What a driver says against its gripper or wrist is the reason", "[unit]") {
  FakeCell foreign;
  At(foreign, 0.5, [&] { foreign.gripper.state.problem = "another client commands it"; });
  CheckStopped(foreign, RunTrajectory(foreign.cell, foreign.Move(0.2, 3.0)), Status::kGripperFault,
               "gripper: another client commands it", 0.01);
  FakeCell stuck;
  stuck.wrist.lie = [](WrenchSample& sample) { sample.problem = "always the same"; };
  const WrenchOutcome weighed = AverageWrench(stuck.cell, 0.1);
  CHECK(weighed.outcome.status == Status::kSensorFault);
  CHECK_THAT(weighed.outcome.reason, Catch::Contains("wrist: always the same"));
  stuck.wrist.load_K.force_N.x() = -2147.0;
  CHECK_THAT(AverageWrench(stuck.cell, 0.1).outcome.reason, Catch::Contains("its range ends at"));
}

TEST_CASE("A wrench beyond the sensor's range ends a guarded motion and a weighing", "[unit]") {
  for (const int axis : {0, 1, 2, 3, 4, 5}) {
    for (const double times : {1.0, -1.0, 1.01, -1.01, std::numeric_limits<double>::quiet_NaN()}) {
      CAPTURE(axis, times);
      FakeCell fake;
      At(fake, 0.5, [&] {
        const double reading = times * fake.model.wrist.range[static_cast<std::size_t>(axis)];
        Wrench& load_K = fake.wrist.load_K;
        (axis < 3 ? load_K.force_N[axis] : load_K.torque_Nm[axis - 3]) = reading;
      });
      const bool right = std::abs(times) == 1.0;
      // So high a limit that no reading is a contact.
      const WaitOutcome guarded = RunGuarded(fake.cell, fake.Move(0.2, 3.0), 1e6);
      CHECK((guarded.status == Status::kDone) == right);
      if (!right) CHECK(guarded.status == Status::kSensorFault);
      CHECK((AverageWrench(fake.cell, 0.1).outcome.status == Status::kDone) == right);
    }
  }
}

TEST_CASE("A gripper that met something on the way that it was not told to go is at fault",
          "[unit]") {
  const auto moved = [](double from_m, double to_m, GripperObject object) {
    FakeCell fake;
    fake.gripper.state.opening_m = from_m;
    fake.gripper.on_command = [&](const GripperCommand&) { fake.gripper.state.object = object; };
    return MoveGripper(fake.cell, {to_m, 0.1, 60.0}).outcome;
  };
  CHECK(moved(0.08, 0.0, GripperObject::kContactClosing).status == Status::kDone);
  CHECK(moved(0.025, 0.055, GripperObject::kContactOpening).status == Status::kDone);
  CHECK(moved(0.025, 0.025, GripperObject::kContactClosing).status == Status::kDone);
  const WaitOutcome open = moved(0.025, 0.055, GripperObject::kContactClosing);
  CHECK(open.status == Status::kGripperFault);
  CHECK_THAT(open.reason, Catch::Contains("told to open and says that it met something while it "
                                          "closed"));
  CHECK(moved(0.08, 0.0, GripperObject::kContactOpening).status == Status::kGripperFault);
}

TEST_CASE("An arm whose joints are no numbers neither starts nor goes on", "[unit]") {
  const auto lie = [](ArmState& state) { state.q[4] = std::nan(""); };
  FakeCell before;
  const CheckedTrajectory move = before.Move(0.2, 3.0);
  before.arm.lie = lie;
  CHECK(RunTrajectory(before.cell, move).status == Status::kLinkLost);
  CHECK(before.arm.started == 0);
  FakeCell during;
  At(during, 0.5, [&] { during.arm.lie = lie; });
  CheckStopped(during, RunTrajectory(during.cell, during.Move(0.2, 3.0)), Status::kLinkLost,
               "no numbers", 0.01);
}

TEST_CASE("A stop of the controller is the outcome, with its text, and nothing goes on", "[unit]") {
  const std::pair<ArmMode, Status> cases[] = {{ArmMode::kProtectiveStop, Status::kProtectiveStop},
                                              {ArmMode::kEmergencyStop, Status::kEmergencyStop},
                                              {ArmMode::kFault, Status::kFault},
                                              {ArmMode::kDisconnected, Status::kLinkLost}};
  for (const auto& [mode, status] : cases) {
    FakeCell fake;
    At(fake, 0.5, [&fake, mode = mode] {
      fake.arm.mode = mode;
      fake.arm.fault = "told so";
    });
    const WaitOutcome outcome = RunTrajectory(fake.cell, fake.Move(0.2, 3.0));
    CHECK(outcome.status == status);
    CHECK_THAT(outcome.reason, Catch::Contains("told so"));
    Wait(fake.cell, 1.0);
    CHECK(fake.arm.started == 1);
    CHECK(fake.arm.recovered == 0);
    CHECK(fake.gripper.commands == 0);
    CHECK(RunTrajectory(fake.cell, fake.Move(0.1, 1.0)).status == status);
  }
}

TEST_CASE("A motion that does not end is stopped", "[unit]") {
  FakeCell fake;
  At(fake, 0.5, [&] { fake.arm.stuck = true; });
  const WaitOutcome outcome = RunTrajectory(fake.cell, fake.Move(0.2, 2.0));
  CheckStopped(fake, outcome, Status::kTimedOut, "planned 2.0", 5.0);
}

TEST_CASE("A guarded motion ends when the wrist is silent", "[unit]") {
  FakeCell fake;
  At(fake, 0.5, [&] { fake.wrist.silent = true; });
  CheckStopped(fake, RunGuarded(fake.cell, fake.Move(0.1, 3.0), 8.0), Status::kSensorFault,
               "wrist: newest wrench is", 0.06);
}

TEST_CASE("No trajectory is sent to an arm that is silent or stands elsewhere", "[unit]") {
  FakeCell fake;
  const CheckedTrajectory move = fake.Move(0.2, 2.0);
  fake.arm.q[2] += Radians(0.3);
  const WaitOutcome elsewhere = RunTrajectory(fake.cell, move);
  CHECK(elsewhere.status == Status::kRejected);
  CHECK_THAT(elsewhere.reason, Catch::Contains("joint 3 is 0.300 degrees"));
  fake.arm.silent = true;
  Wait(fake.cell, 0.2);
  CHECK(RunTrajectory(fake.cell, fake.Move(0.2, 2.0)).status == Status::kLinkLost);
  CHECK(fake.arm.started == 0);
}

TEST_CASE("A gripper with a fault gets no command", "[unit]") {
  FakeCell fake;
  fake.gripper.state.fault = 0x09;
  CHECK(MoveGripper(fake.cell, {0.05, 0.1, 60.0}).outcome.status == Status::kGripperFault);
  CHECK(fake.gripper.commands == 0);
  fake.gripper.state.fault = 0x05;  // A command that came too early is no broken gripper.
  CHECK(MoveGripper(fake.cell, {0.05, 0.1, 60.0}).outcome.status == Status::kDone);
}

TEST_CASE("A weighing with saturated or missing samples is not believed", "[unit]") {
  FakeCell fake;
  CHECK(AverageWrench(fake.cell, 0.2).outcome.status == Status::kDone);
  fake.wrist.saturated = true;
  CHECK_THAT(AverageWrench(fake.cell, 0.2).outcome.reason, Catch::Contains("are saturated"));
  fake.wrist.saturated = false;
  fake.wrist.silent = true;
  CHECK(AverageWrench(fake.cell, 0.2).outcome.status == Status::kSensorFault);
}

TEST_CASE("A largest speed stretches fast trajectories and leaves slow ones alone", "[unit]") {
  FakeCell fake;
  fake.cell.safety.max_speed_m_s = 0.25;
  const CheckedTrajectory fast = fake.Move(0.5, 1.0);
  REQUIRE(RunTrajectory(fake.cell, fast).status == Status::kDone);
  CHECK(fake.arm.last_planned_s > 2.0);
  FakeCell slow;
  slow.cell.safety.max_speed_m_s = 0.25;
  REQUIRE(RunTrajectory(slow.cell, slow.Move(0.02, 2.0)).status == Status::kDone);
  CHECK(slow.arm.last_planned_s == 2.0);
}

TEST_CASE("A stretched trajectory keeps its path and its limits", "[unit]") {
  FakeCell fake;
  const CheckedTrajectory move = fake.Move(0.5, 1.0);
  const CheckedTrajectory longer = move.Stretched(3.0);
  CHECK(longer.duration_s() == Approx(3.0));
  CHECK(std::holds_alternative<CheckedTrajectory>(
      CheckTrajectory(PaperCell().arm, longer.trajectory())));
  for (double u = 0.0; u <= 1.0; u += 0.1) {
    const JointVector off = Sample(move.trajectory(), u).q - Sample(longer.trajectory(), 3.0 * u).q;
    CHECK(off.cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("An arm is made ready only when asked to", "[unit]") {
  FakeCell fake;
  fake.arm.mode = ArmMode::kProtectiveStop;
  Wait(fake.cell, 1.0);
  CHECK(fake.arm.State().mode == ArmMode::kProtectiveStop);
  CHECK(RecoverArm(fake.cell).status == Status::kDone);
  CHECK(fake.arm.recovered == 1);
  CHECK(fake.arm.started == 0);
}

}  // namespace
}  // namespace tubetwin
