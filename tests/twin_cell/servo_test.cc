#include <cmath>

#include "models/base/error.h"
#include "tests/support/catch.h"
#include "tests/twin_cell/cell_fixture.h"

namespace tubetwin::test {
namespace {

/// Two cells step the same engine with references that differ by rounding only.
constexpr double kSame_rad = 1e-7;

ServoReference At(const JointTrajectory& trajectory, double time_s) {
  const TrajectoryPoint a = Sample(trajectory, time_s);
  const TrajectoryPoint b = Sample(trajectory, time_s + Seconds(kControlPeriod));
  return {a.q, a.qd, (b.qd - a.qd) / Seconds(kControlPeriod)};
}

void Step(Bench& bench) { bench.cell().clock.AdvanceTo(bench.cell().clock.Now() + kControlPeriod); }

}  // namespace

TEST_CASE("the twin's drives follow a controller's references as its own trajectory") {
  Bench own(FarTube()), driven(FarTube());
  MotionOptions options;
  const CheckedTrajectory line = own.Line(own.Down({0.60, 0.10, 0.45}), options);
  ServoArm& servo = driven.impl().arm;
  CHECK_FALSE(servo.Servo().moving);
  REQUIRE(own.cell().arm.Start(line).accepted());
  const TimeNs begin = own.cell().clock.Now();
  double worst_rad = 0.0;
  for (TimeNs t{0}; Seconds(t) <= line.duration_s() + 0.1; t += kControlPeriod) {
    if (Seconds(t) <= line.duration_s()) servo.Follow(At(line.trajectory(), Seconds(t)));
    Step(own);
    Step(driven);
    worst_rad = std::max(
        worst_rad,
        (own.impl().arm.TruePosition() - driven.impl().arm.TruePosition()).cwiseAbs().maxCoeff());
  }
  CHECK(own.cell().clock.Now() > begin);
  CHECK(worst_rad < kSame_rad);
  CHECK_FALSE(servo.Servo().moving);
  CHECK(servo.Servo().fault.empty());
  CHECK((servo.Servo().q_commanded - line.trajectory().points.back().q).cwiseAbs().maxCoeff() <
        1e-9);
}

TEST_CASE("drives without a new reference halt within the arm's limits and hold") {
  Bench bench(FarTube());
  const CheckedTrajectory line = bench.Line(bench.Down({0.60, 0.30, 0.45}));
  TwinArm& arm = bench.impl().arm;
  const ArmModel& model = bench.cell().model.arm;
  const double until_s = 0.5 * line.duration_s();
  for (double t = 0.0; t < until_s; t += Seconds(kControlPeriod)) {
    arm.Follow(At(line.trajectory(), t));
    Step(bench);
  }
  const JointVector q_last = arm.Servo().q_commanded;
  const JointVector qd_last = arm.Servo().qd;
  REQUIRE(qd_last.cwiseAbs().maxCoeff() > 0.1);
  CHECK_FALSE(bench.cell().arm.Start(line).accepted());  // It is in other hands.
  CHECK_FALSE(bench.cell().arm.Append(line).accepted());

  JointVector before = q_last, speed_before = qd_last;
  int periods = 0;
  while (arm.Servo().moving) {
    Step(bench);
    REQUIRE(++periods < 500);
    const JointVector speed = (arm.Servo().q_commanded - before) / Seconds(kControlPeriod);
    for (int i = 0; i < kNumJoints && periods > 1; ++i) {
      REQUIRE(std::abs(speed[i] - speed_before[i]) / Seconds(kControlPeriod) <
              1.01 * model.joints[i].max_acceleration_rad_s2);
    }
    before = arm.Servo().q_commanded;
    speed_before = speed;
  }
  const JointVector way = arm.Servo().q_commanded - q_last;
  for (int i = 0; i < kNumJoints; ++i) {  // On in its direction, and not far.
    CHECK(way[i] * qd_last[i] >= -1e-9);
    CHECK(std::abs(way[i]) <= std::abs(qd_last[i]) * 1e-3 * (periods + 1) + 1e-4);
  }
  Wait(bench.cell(), 0.2);
  CHECK((arm.Servo().q - before).cwiseAbs().maxCoeff() < 1e-4);
  CHECK(bench.cell().arm.State().mode == ArmMode::kReady);
}

TEST_CASE("drives that cannot follow give up and say so until they are cleared") {
  Bench bench(FarTube());
  TwinArm& arm = bench.impl().arm;
  ServoReference far;
  far.q = arm.Servo().q_commanded;
  far.q[0] += 0.2;
  arm.Follow(far);
  Step(bench);
  CHECK(arm.Servo().fault.find("joint 1") != std::string::npos);
  CHECK_FALSE(arm.Servo().moving);
  far.q = arm.Servo().q_commanded;
  arm.Follow(far);  // In a fault nothing is followed.
  Step(bench);
  CHECK_FALSE(arm.Servo().moving);
  arm.ClearServoFault();
  CHECK(arm.Servo().fault.empty());
  arm.Follow(far);
  Step(bench);
  CHECK(arm.Servo().moving);
}

TEST_CASE("a trajectory and a controller's reference at once are a bug") {
  Bench bench(FarTube());
  REQUIRE(bench.cell().arm.Start(bench.Line(bench.Down({0.60, 0.10, 0.45}))).accepted());
  REQUIRE_THROWS_AS(bench.impl().arm.Follow({}), LogicError);
}

}  // namespace tubetwin::test
