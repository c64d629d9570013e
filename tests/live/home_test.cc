#include "twin/live/home.h"

#include "models/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/fake_cell.h"
#include "twin/cell/cell_world.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;
using test::FakeCell;

constexpr double kMass_kg = 0.055;

/// A cell whose arm stands a little aside of home, with the gripper closed on nothing.
struct Away {
  FakeCell fake;
  JointVector home = HomePosition(fake.model, fake.cell.bin);
  Away() {
    fake.arm.q = home;
    fake.arm.q[0] += 0.6;
    fake.arm.q[5] += 0.4;
    fake.wrist.load_K.force_N = {0, 0, Weight_N()};
  }
  /// Of the empty tool, which points down: along K's z.
  double Weight_N() const {
    return (fake.model.gripper.mass_kg + fake.model.gripper.coupling_mass_kg) * kGravity;
  }
};

TEST_CASE("Home is over the bin's middle, reached at start speed", "[unit]") {
  Away away;
  away.fake.cell.safety.start_speed_m_s = 0.1;
  double fastest_m_s = 0.0;
  away.fake.arm.on_start = [&](const CheckedTrajectory& trajectory) {
    const ArmModel& arm = away.fake.model.arm;
    const RigidTransform& X_FE = away.fake.model.layout.X_FE;
    for (double t = 0.0; t < trajectory.duration_s(); t += 0.01) {
      const TrajectoryPoint point = Sample(trajectory.trajectory(), t);
      fastest_m_s =
          std::max(fastest_m_s, (Jacobian(arm, point.q, X_FE) * point.qd).head<3>().norm());
    }
  };
  const JointVector q = DriveHome(away.fake.cell, kMass_kg);
  const RigidTransform X_BE = FlangePose(away.fake.model.arm, q) * away.fake.model.layout.X_FE;
  const Vector3 over_B =
      away.fake.cell.bin.X_BN.translation() + Vector3(0, 0, away.fake.model.layout.carry_height_m);
  CHECK((X_BE.translation() - over_B).norm() < 1e-3);
  CHECK(X_BE.linear()(2, 2) == Approx(-1.0).margin(1e-6));
  CHECK(away.fake.arm.started > 0);
  CHECK(fastest_m_s > 0.05);
  CHECK(fastest_m_s < 0.101);
  CHECK(away.fake.gripper.commands == 0);
}

TEST_CASE("An arm that is not at rest with empty fingers does not go home", "[unit]") {
  const auto refused = [](Away& away, const std::string& why) {
    CHECK_THROWS_WITH(DriveHome(away.fake.cell, kMass_kg),
                      Contains(why) && Contains("nothing was moved"));
    CHECK(away.fake.arm.started == 0);
  };
  Away pressing;
  pressing.fake.gripper.state.object = GripperObject::kContactClosing;
  pressing.fake.gripper.state.opening_m = 0.025;
  refused(pressing, "press on something of 25.0 mm");
  Away hanging;
  hanging.fake.wrist.load_K.force_N.z() += 1.5;
  refused(hanging, "the tool weighs");
  Away asleep;
  asleep.fake.gripper.state.activated = false;
  refused(asleep, "doctor --activate-gripper");
  Away buried;
  buried.fake.cell.bin.X_BN.translation() += Vector3(3.0, 0.0, 0.0);
  CHECK_THROWS_WITH(DriveHome(buried.fake.cell, kMass_kg), Contains("does not reach"));
}

TEST_CASE("What stops the arm on its way home is told", "[unit]") {
  Away stopped;
  int asked = 0;
  stopped.fake.cell.stop_at_once = [&asked] { return ++asked > 200; };
  try {
    DriveHome(stopped.fake.cell, kMass_kg);
    FAIL("it should have been stopped");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kInterrupted);
    CHECK_THAT(error.what(), Contains("home: "));
  }
  CHECK(stopped.fake.arm.stopped == 1);
  Away broken;
  broken.fake.arm.on_start = [&](const CheckedTrajectory&) {
    broken.fake.arm.mode = ArmMode::kFault;
    broken.fake.arm.fault = "alarm 4107";
  };
  CHECK_THROWS_WITH(DriveHome(broken.fake.cell, kMass_kg), Contains("alarm 4107"));
}

}  // namespace
}  // namespace tubetwin
