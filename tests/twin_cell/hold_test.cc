// The grasp by friction alone: a held tube survives everything that a pick does to it.

#include "tests/support/catch.h"
#include "tests/twin_cell/cell_fixture.h"
#include "twin/cell/gripper_body.h"
#include "twin/cell/truth.h"

namespace tubetwin::test {
namespace {

/// Allowed slip of the issue; measured figures are ten times smaller.
constexpr double kSlip_m = 0.003;
constexpr double kTurn_deg = 5.0;

/// Motion of the held piece of tube against the fingers since construction.
class SlipGauge {
 public:
  explicit SlipGauge(Bench& bench) : bench_(bench) {
    const TubeBody& tube = bench.impl().world.tubes().front();
    double nearest = 1.0;
    for (const int body : tube.bodies()) {
      const Vector3 p_B(bench.impl().world.data().xipos + 3 * body);
      const double distance = (p_B - PadsCentre()).norm();
      if (distance < nearest) {
        nearest = distance;
        body_ = body;
      }
    }
    X_start_ = X_EBody();
    p_Body_ = X_start_.inverse() * (bench.X_BE().inverse() * PadsCentre());
  }
  double slip_m() const { return (X_EBody() * p_Body_ - X_start_ * p_Body_).norm(); }
  double turn_deg() const {
    return Degrees(Eigen::AngleAxisd(X_start_.linear().transpose() * X_EBody().linear()).angle());
  }

 private:
  Vector3 PadsCentre() const {
    const CellWorld& world = bench_.impl().world;
    Vector3 sum = Vector3::Zero();
    for (const char* pad : {kPadLeftGeom, kPadRightGeom}) {
      sum += Vector3(world.data().geom_xpos + 3 * IdOf(world.model(), mjOBJ_GEOM, pad));
    }
    return 0.5 * sum;
  }
  RigidTransform X_EBody() const {
    return bench_.X_BE().inverse() * BodyPose(bench_.impl().world.data(), body_);
  }

  Bench& bench_;
  int body_ = 0;
  RigidTransform X_start_ = RigidTransform::Identity();
  Vector3 p_Body_ = Vector3::Zero();
};

/// Lift 0.4 m at 0.25 m/s, tilts of 45 degrees both ways about both axes, 10 s of holding,
/// transfers at 1 m/s^2.
void RunHoldProgramme(Bench& bench) {
  MotionOptions lift;
  lift.speed_m_s = 0.25;
  const double floor_m = bench.cell().bin.X_BN.translation().z();
  RigidTransform X_BE = bench.X_BE();
  X_BE.translation().z() = floor_m + 0.42;
  bench.MoveLine(X_BE, lift);
  const Vector3 p_tilt = bench.cell().model.layout.p_BTilt;
  bench.MoveLine(bench.Down(p_tilt), lift);
  for (const Vector3& axis : {Vector3(1, 0, 0), Vector3(0, 1, 0)}) {
    for (const double angle_deg : {45.0, -45.0}) {
      bench.Tilt(axis * Radians(angle_deg));
      bench.Tilt(-axis * Radians(angle_deg));
    }
  }
  Wait(bench.cell(), 10.0);
  MotionOptions transfer;
  transfer.acceleration_m_s2 = 1.0;
  for (const double y : {0.25, -0.25, 0.0}) {
    bench.MoveLine(bench.Down(p_tilt + Vector3(0, y, 0)), transfer);
  }
}

void CheckHold(const std::string& part, double share_of_length) {
  const double length_m = LoadPart(part).length_m, radius_m = LoadPart(part).radius_m;
  const Vector3 p_grip(0, 0, radius_m);
  Bench bench(OneTube(part, p_grip + Vector3((0.5 - share_of_length) * length_m, 0, 0)));
  Wait(bench.cell(), 0.3);
  REQUIRE(bench.GraspAt(p_grip).object == GripperObject::kContactClosing);
  const SlipGauge gauge(bench);
  RunHoldProgramme(bench);
  INFO(part << " at " << share_of_length << ": slip " << gauge.slip_m() * 1e3 << " mm, turned "
            << gauge.turn_deg() << " degrees");
  CHECK(gauge.slip_m() < kSlip_m);
  CHECK(gauge.turn_deg() < kTurn_deg);
  CHECK(Truth(bench.twin()).Held() == 1);
  CHECK_FALSE(bench.impl().arm.clamped());
}

}  // namespace

TEST_CASE("a PVC tube held at its middle survives lift, tilts, hold and transfer") {
  CheckHold("pvc_a", 0.5);
}
TEST_CASE("a PVC tube held at a quarter survives lift, tilts, hold and transfer") {
  CheckHold("pvc_a", 0.25);
}
TEST_CASE("a hose held at its middle survives lift, tilts, hold and transfer") {
  CheckHold("hose_b", 0.5);
}
TEST_CASE("a hose held at a quarter survives lift, tilts, hold and transfer") {
  CheckHold("hose_b", 0.25);
}

TEST_CASE("a grasp without friction drops the tube: nothing else holds it") {
  const Vector3 p_grip(0, 0, LoadPart("pvc_a").radius_m);
  const Pile pile = OneTube("pvc_a", p_grip);
  TwinCellOptions options = NominalOptions(pile);
  options.physics.pad_friction = 0.001;
  options.physics.pad_torsion_m = 1e-6;
  Bench bench(pile, options);
  bench.GraspAt(p_grip, 20.0);
  RigidTransform X_BE = bench.X_BE();
  X_BE.translation().z() += 0.3;
  bench.MoveLine(X_BE);
  CHECK(Truth(bench.twin()).Held() == 0);
  CHECK(Truth(bench.twin()).Tubes()[0].over_bin);
}

}  // namespace tubetwin::test
