#include "twin/live/dry_run.h"

#include <algorithm>

#include "models/arm/arm.h"
#include "models/clearance.h"
#include "tests/recording/restless_cell.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {

TEST_CASE("In a dry run trajectories pass in thought and the real devices hear nothing", "[unit]") {
  test::RestlessCell real(3);
  const JointVector q0 = real.cell().arm.State().q;
  const double requested_m = real.cell().gripper.State().requested_m;
  DryRunCell dry(real.cell());
  Cell& cell = dry.cell();
  TrajectoryPoint from, to;
  from.q = cell.arm.State().q;
  to.q = from.q + 0.1 * JointVector::Ones();
  to.time_s = 1.0;
  const auto checked = CheckTrajectory(PaperCell().arm, {{from, to}});
  REQUIRE(std::holds_alternative<CheckedTrajectory>(checked));
  const CheckedTrajectory& path = std::get<CheckedTrajectory>(checked);
  REQUIRE(cell.arm.Start(path).accepted());
  CHECK_FALSE(cell.arm.Start(path).accepted());
  CHECK(cell.arm.State().mode == ArmMode::kMoving);
  Wait(cell, 1.1);
  CHECK(cell.arm.State().done);
  CHECK((cell.arm.State().q - to.q).norm() < 1e-9);
  CHECK_FALSE(cell.arm.Start(path).accepted());  // It stands elsewhere now.
  CHECK(MoveGripper(cell, {0.02, 0.1, 60.0}).state.opening_m == Approx(0.02));
  CHECK((real.cell().arm.State().q - q0).norm() < 1e-4);
  CHECK(real.cell().gripper.State().requested_m == requested_m);
}

TEST_CASE("Rehearsed fingers stop at what they would hold, and open again", "[unit]") {
  test::RestlessCell real(3);
  DryRunCell dry(real.cell(), {0.025, 0.2});
  Cell& cell = dry.cell();
  const Vector3 empty_N = AverageWrench(cell, 0.1).mean_K.force_N;
  const GripperState closed = MoveGripper(cell, {0.0, 0.1, 60.0}).state;
  CHECK(closed.opening_m == Approx(0.025));
  CHECK(closed.object == GripperObject::kContactClosing);
  constexpr double kNoise_N = 0.3;  // The cell's wrist is restless; 0.2 kg weigh 1.96 N.
  const Vector3 held_N = AverageWrench(cell, 0.1).mean_K.force_N - empty_N;
  CHECK(held_N.norm() == Approx(0.2 * kGravity).margin(kNoise_N));
  CHECK(MoveGripper(cell, {0.06, 0.1, 60.0}).state.opening_m == Approx(0.06));
  CHECK(cell.gripper.State().object == GripperObject::kAtPosition);
  CHECK(MoveGripper(cell, {0.03, 0.1, 60.0}).state.opening_m == Approx(0.03));  // Wider than it.
  CHECK(dry.Report().gripper_commands == 3);
  CHECK(dry.Report().trajectories == 0);
  CHECK(ToText(dry.Report()) == "no motion was planned; nothing was sent");
}

TEST_CASE("A rehearsal tells how near its motions come and which joint sets the pace", "[unit]") {
  test::RestlessCell real(3);
  DryRunCell dry(real.cell());
  Cell& cell = dry.cell();
  const ArmModel& arm = PaperCell().arm;
  TrajectoryPoint from, to;
  from.q = cell.arm.State().q;
  to.q = from.q;
  to.q[4] += 0.3;  // One joint alone: no other can be the one.
  to.time_s = 2.0;
  TrajectoryPoint middle = from;
  middle.q[4] += 0.15;
  middle.qd[4] = 0.2;
  middle.time_s = 1.0;
  const auto checked = CheckTrajectory(arm, {{from, middle, to}});
  REQUIRE(std::holds_alternative<CheckedTrajectory>(checked));
  REQUIRE(cell.arm.Start(std::get<CheckedTrajectory>(checked)).accepted());
  const DryRunReport report = dry.Report();
  CHECK(report.trajectories == 1);
  CHECK(report.duration_s == Approx(2.0));
  CHECK(report.slowest_joint.joint == 5);
  CHECK(report.slowest_joint.speed_rad_s == Approx(0.2));
  CHECK(report.slowest_joint.limit_rad_s == arm.joints[4].max_speed_rad_s);
  // The least of what the checker says along the way, asked in finer steps here.
  const ClearanceChecker clearance(cell.model, cell.bin);
  double least_m = 0.05;
  const JointTrajectory path{{from, middle, to}};
  for (double t = 0.0; t <= 2.0; t += 0.002) {
    least_m = std::min(
        least_m, clearance.Check(Sample(path, t).q, cell.gripper.State().opening_m).clearance_m);
  }
  constexpr double kBetweenSteps_m = 0.001;  // At 0.2 rad/s and half a metre in 10 ms.
  CHECK(report.nearest.clearance_m == Approx(least_m).margin(kBetweenSteps_m));
  CHECK_THAT(ToText(report), Catch::Contains("1 trajectory checked") &&
                                 Catch::Contains("slowest joint 5") &&
                                 Catch::Contains("nothing was sent"));
}

}  // namespace tubetwin
