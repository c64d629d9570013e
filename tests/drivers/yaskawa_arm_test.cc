#include "hw_bridge/drivers/yaskawa/yaskawa_arm.h"

#include <cmath>
#include <random>

#include "tests/drivers/arm_bench.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

using Catch::Matchers::Contains;

constexpr double kEncoder_rad = 1e-5;

TEST_CASE("Connecting powers the drives and starts the job that waits for motion", "[unit]") {
  ServedArm served(2.0, false);
  const WallClock clock(2.0);
  const YaskawaArm driver(served.Config(), PaperCell().arm, clock);
  const ArmState state = driver.State();
  CHECK(state.mode == ArmMode::kReady);
  CHECK(state.fault.empty());
  CHECK(state.done);
  CHECK((state.q - served.With([](auto&, FakeServoArm& arm) { return arm.Servo().q; }))
            .cwiseAbs()
            .maxCoeff() < 1e-6);
}

TEST_CASE("A trajectory is followed on its path and in its time", "[unit]") {
  ArmBench bench;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> turn(-0.3, 0.3);
  for (int round = 0; round < 3; ++round) {
    CAPTURE(round);
    JointVector by;
    for (int i = 0; i < kNumJoints; ++i) by[i] = turn(random);
    const CheckedTrajectory planned = Moved(bench.State().q, by, 0.8);
    double worst_rad = 0.0;
    bench.served.With([&](ArmEmulator&, FakeServoArm&) {
      bench.served.each_period = [&](const FakeServoArm& arm) {
        double least = 1.0;  // From the nearest place of the path.
        for (double t = 0.0; t <= 0.8; t += 0.002) {
          const JointVector off = arm.Servo().q - Sample(planned.trajectory(), t).q;
          least = std::min(least, off.cwiseAbs().maxCoeff());
        }
        worst_rad = std::max(worst_rad, least);
      };
    });
    REQUIRE(bench.driver->Start(planned).accepted());
    CHECK(bench.State().mode == ArmMode::kMoving);
    CHECK(bench.State().planned_s == Approx(0.8));
    CHECK_FALSE(bench.State().done);
    const ArmState state = bench.Rest();
    bench.served.With([&](ArmEmulator&, FakeServoArm&) { bench.served.each_period = nullptr; });
    CHECK(state.mode == ArmMode::kReady);
    CHECK(state.done);
    CHECK(state.progress_s == Approx(0.8));
    // Steps of the search along the path, at 0.6 rad/s.
    CHECK(worst_rad < 1e-3);
    CHECK((state.q - planned.trajectory().points.back().q).cwiseAbs().maxCoeff() < kEncoder_rad);
  }
}

TEST_CASE("Reported positions keep with the planned ones", "[unit]") {
  ArmBench bench;
  const CheckedTrajectory planned = Moved(bench.State().q, 0.5, 2.0);
  REQUIRE(bench.driver->Start(planned).accepted());
  double progress_s = 0.0, worst_s = 0.0;
  TimeNs newest{0};
  while (bench.State().mode == ArmMode::kMoving) {
    const ArmState state = bench.State();
    CHECK(state.progress_s >= progress_s);
    progress_s = state.progress_s;
    if (state.time != newest && progress_s > 0.3 && progress_s < 1.7) {
      // How far in time the place is from where the arm says that it is.
      const TrajectoryPoint at = Sample(planned.trajectory(), progress_s);
      worst_s = std::max(worst_s, std::abs((state.q[0] - at.q[0]) / at.qd[0]));
      newest = state.time;
    }
    bench.Pass(0.001);
  }
  CHECK(bench.State().done);
  CHECK(newest > TimeNs{0});
  CHECK(worst_s < 0.3);  // Queue and states are asked for at intervals; hosts may be busy.
}

TEST_CASE("A controller that is busy gets the same point again", "[unit]") {
  ArmBench bench;
  bench.served.With([](ArmEmulator& emulator, FakeServoArm&) {
    emulator.controller().RefusePoints(simple_message::Result::kBusy, 0, 12);
  });
  REQUIRE(bench.driver->Start(Moved(bench.State().q, 0.2, 0.6)).accepted());
  const ArmState state = bench.Rest();
  CHECK(state.done);
  CHECK(state.mode == ArmMode::kReady);
}

TEST_CASE("The controller never holds more than is meant to run on after a lost link", "[unit]") {
  ArmBench bench;
  int most = 0;
  bench.MoveOn();
  for (int i = 0; i < 100; ++i) {
    most = std::max(most, bench.served.With([](ArmEmulator& emulator, FakeServoArm&) {
      const auto count = emulator.controller().Handle(simple_message::Request(
          simple_message::MotionControl{0, 0, simple_message::Command::kCheckQueueCount, {}}));
      return std::get<simple_message::MotionReply>(count.answer->body).subcode;
    }));
    bench.Pass(0.01);
  }
  CHECK(most > 20);
  CHECK(most < 160);  // 0.4 s at this rate, and what a busy host adds.
  bench.driver->Stop(StopKind::kFast);
  bench.Rest();
}

TEST_CASE("A refused point ends the motion with the controller's reason", "[unit]") {
  const auto [subcode, text, mode] = GENERATE(table<int, const char*, ArmMode>({
      {3011, "start position (3011)", ArmMode::kFault},
      {3013, "speed (3013)", ArmMode::kFault},
      {5007, "hold (5007)", ArmMode::kIdle},
      {5011, "contact stop (5011)", ArmMode::kProtectiveStop},
  }));
  CAPTURE(subcode);
  const bool first = GENERATE(true, false);
  ArmBench bench;
  if (!first) bench.MoveOn();
  bench.served.With(
      [code = subcode](ArmEmulator& emulator, FakeServoArm&) { emulator.Refuse(code, 1); });
  if (first) REQUIRE(bench.driver->Start(Moved(bench.State().q, 0.2, 0.6)).accepted());
  const ArmState state = bench.Rest();
  CHECK(state.mode == mode);
  CHECK_THAT(state.fault, Contains("refused point") && Contains(text));
  CHECK_FALSE(state.done);
  CHECK(Eventually([&] { return bench.Stands(0.05); }));
  const CommandResult again = bench.driver->Start(Moved(bench.State().q, 0.1, 0.5));
  CHECK_FALSE(again.accepted());
  CHECK_THAT(again.reason, Contains(text));
  // A person's word makes it ready again.
  REQUIRE(bench.driver->Recover().accepted());
  CHECK(bench.Await(ArmMode::kReady));
  REQUIRE(bench.driver->Start(Moved(bench.State().q, 0.1, 0.5)).accepted());
  CHECK(bench.Rest().done);
}

TEST_CASE("Starts that may not be are refused before a byte is sent", "[unit]") {
  ArmBench bench;
  const JointVector q = bench.State().q;
  const CommandResult far = bench.driver->Start(Moved(q + 0.01 * JointVector::Ones(), 0.1, 0.5));
  CHECK_FALSE(far.accepted());
  CHECK_THAT(far.reason, Contains("degrees from the trajectory's first point"));
  CHECK_FALSE(bench.driver->Append(Moved(q, 0.1, 0.5)).accepted());
  const auto taken = [](ArmEmulator& e, FakeServoArm&) { return e.controller().points_taken(); };
  CHECK(bench.served.With(taken) == 0);
  // A start within 0.2 degrees, but further than the controller's 30 pulses, is led in.
  REQUIRE(bench.driver->Start(Moved(q + 0.003 * JointVector::Ones(), 0.1, 0.8)).accepted());
  CHECK_FALSE(bench.driver->Start(Moved(q, 0.1, 0.5)).accepted());
  CHECK(bench.Rest().done);
  CHECK((bench.Drives() - q - 0.103 * JointVector::Ones()).cwiseAbs().maxCoeff() < kEncoder_rad);
}

TEST_CASE("Appended points go on from the end, also when the arm stands there", "[unit]") {
  ArmBench bench;
  const JointVector q = bench.State().q;
  const CheckedTrajectory out = Moved(q, 0.2, 0.6);
  REQUIRE(bench.driver->Start(out).accepted());
  const JointVector turn = out.trajectory().points.back().q;
  CHECK_THAT(bench.driver->Append(Moved(turn + 0.01 * JointVector::Ones(), 0.1, 0.5)).reason,
             Contains("degrees from the end"));
  REQUIRE(bench.driver->Append(Moved(turn, -0.1, 0.4)).accepted());
  CHECK(bench.State().planned_s == Approx(1.0));
  const ArmState state = bench.Rest();
  CHECK(state.done);
  CHECK(state.progress_s == Approx(1.0));
  CHECK((bench.Drives() - q - 0.1 * JointVector::Ones()).cwiseAbs().maxCoeff() < kEncoder_rad);
  CHECK_THAT(bench.driver->Append(Moved(state.q, 0.1, 0.5)).reason, Contains("no trajectory"));
}

TEST_CASE("Both stops end a fast motion short of its goal and leave the arm ready", "[unit]") {
  const StopKind kind = GENERATE(StopKind::kOnPath, StopKind::kFast);
  ArmBench bench;
  const JointVector q = bench.State().q;
  const CheckedTrajectory planned = Moved(q, 1.0, 4.0);
  REQUIRE(bench.driver->Start(planned).accepted());
  REQUIRE(Eventually([&] { return bench.State().progress_s > 1.5; }));
  bench.driver->Stop(kind);
  if (kind == StopKind::kOnPath) {
    CHECK_THAT(bench.driver->Append(Moved(q + JointVector::Ones(), -0.1, 0.5)).reason,
               Contains("stop"));
  }
  const ArmState state = bench.Rest();
  CHECK(state.mode == ArmMode::kReady);
  CHECK_FALSE(state.done);
  CHECK(state.progress_s > 1.4);
  CHECK(state.progress_s < 3.9);
  const JointVector at = Sample(planned.trajectory(), state.progress_s).q;
  CHECK((state.q - at).cwiseAbs().maxCoeff() < 1e-3);
  CHECK(bench.Stands());
  REQUIRE(bench.driver->Start(Moved(state.q, 0.1, 0.5)).accepted());
  CHECK(bench.Rest().done);
}

TEST_CASE("A slow motion is stopped at once", "[unit]") {
  ArmBench bench;
  const CheckedTrajectory planned = Moved(bench.State().q, 0.1, 3.0);
  REQUIRE(bench.driver->Start(planned).accepted());
  REQUIRE(Eventually([&] { return bench.State().progress_s > 0.6; }));
  bench.driver->Stop(StopKind::kOnPath);
  const ArmState state = bench.Rest();
  CHECK(state.mode == ArmMode::kReady);
  CHECK_FALSE(state.done);
  CHECK(state.progress_s < 2.5);
}

}  // namespace
}  // namespace tubetwin::test
