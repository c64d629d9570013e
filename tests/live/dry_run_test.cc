#include "twin/live/dry_run.h"

#include "models/arm/arm.h"
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

}  // namespace tubetwin
