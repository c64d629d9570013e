#include "hw_bridge/cell/left_over.h"

#include <cmath>

#include "models/arm/arm.h"
#include "tests/support/catch.h"
#include "tests/support/fake_cell.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("Fingers that press on something hold what an earlier program left", "[unit]") {
  GripperState state;
  const auto left = [&](GripperObject object, double opening_m) {
    state.object = object;
    state.opening_m = opening_m;
    return LeftInFingers(state);
  };
  CHECK_THAT(left(GripperObject::kContactClosing, 0.025), Contains("something of 25.0 mm"));
  CHECK(left(GripperObject::kContactClosing, 0.003).empty());
  CHECK(left(GripperObject::kAtPosition, 0.025).empty());
  CHECK(left(GripperObject::kContactOpening, 0.025).empty());
}

TEST_CASE("A tool that weighs half a tube more than when empty holds something", "[unit]") {
  test::FakeCell fake;
  const CellModel& model = fake.model;
  const double tool_N = (model.gripper.mass_kg + model.gripper.coupling_mass_kg) * kGravity;
  constexpr double kTube_kg = 0.055, kTube_N = kTube_kg * kGravity;
  // Down over the bin, and leaning.
  const RigidTransform X_BE = MakeTransform(RotX(kPi), Vector3(0.6, 0, 0.5));
  const auto down = InverseWorking(model.arm, X_BE * model.layout.X_FE.inverse());
  REQUIRE(down.status == InverseNearResult::Status::kFound);
  JointVector leaning = down.q;
  leaning[4] += 0.5;
  SafetyLimits safety;
  const auto left = [&](double load_N, const JointVector& q) {
    const Matrix3 R_BK = FlangePose(model.arm, q).linear() * model.layout.X_FK.linear();
    WrenchSample sample;
    sample.wrench_K.force_N = R_BK.transpose() * Vector3(0, 0, -load_N);
    return LeftOnWrist(sample, q, model, safety, kTube_kg);
  };
  CHECK(left(tool_N, down.q).empty());
  CHECK(left(tool_N - 3.0, down.q).empty());
  CHECK(left(tool_N + 0.5 * kTube_N + 0.14, down.q).empty());
  CHECK_THAT(left(tool_N + kTube_N, down.q),
             Contains("the tool weighs 10.64 N, with empty fingers 10.10 N"));
  CHECK(left(tool_N + kTube_N, leaning).empty());  // Nobody can tell.
  // A sensor that somebody has biased with empty fingers.
  safety.empty_load_N = {0.0};
  CHECK(left(0.0, down.q).empty());
  CHECK_THAT(left(kTube_N, down.q), Contains("with empty fingers 0.00 N"));
  WrenchSample broken;
  broken.wrench_K.force_N.setConstant(std::nan(""));
  CHECK(LeftOnWrist(broken, down.q, model, safety, kTube_kg).empty());
}

}  // namespace
}  // namespace tubetwin
