#include "twin/live/jog.h"

#include <cmath>

#include "models/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/fake_cell.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;
using test::FakeCell;

JointVector JogFake(FakeCell& fake, int joint, double degrees) {
  return Jog(fake.arm, fake.model.arm, fake.clock, {joint, degrees, {}});
}

TEST_CASE("A jog turns one joint by what was asked, slowly, and nothing else", "[unit]") {
  for (int joint = 1; joint <= kNumJoints; ++joint) {
    const double degrees = joint % 2 == 0 ? -0.4 : 1.0;
    FakeCell fake;
    JointVector should = fake.arm.q;
    should[joint - 1] += Radians(degrees);
    const JointVector q = JogFake(fake, joint, degrees);
    CHECK((q - should).cwiseAbs().maxCoeff() < 1e-9);
    CHECK(fake.arm.started == 1);
    CHECK(Radians(std::abs(degrees)) / fake.arm.last_planned_s * 1.5 < Radians(1.01));
  }
}

TEST_CASE("A jog that is not allowed moves nothing and says what is", "[unit]") {
  FakeCell fake;
  CHECK_THROWS_WITH(JogFake(fake, 0, 1.0), Contains("--joint is 0, allowed are 1"));
  CHECK_THROWS_WITH(JogFake(fake, 7, 1.0), Contains("--joint is 7"));
  CHECK_THROWS_WITH(JogFake(fake, 1, 1.01), Contains("--degrees is 1.01, allowed are -1 to 1"));
  CHECK_THROWS_WITH(JogFake(fake, 1, 0.0), Contains("--degrees is 0"));
  CHECK_THROWS_WITH(JogFake(fake, 1, 1e-300), Contains("at least 0.001 either way"));
  CHECK_THROWS_WITH(JogFake(fake, 1, -0.00099), Contains("at least 0.001 either way"));
  CHECK_THROWS_WITH(JogFake(fake, 1, std::nan("")), Contains("--degrees is"));
  fake.arm.q[2] = fake.model.arm.joints[2].upper_rad;
  CHECK_THROWS_WITH(JogFake(fake, 3, 1.0), Contains("joint 3") && Contains("other way"));
  CHECK(fake.arm.started == 0);
  fake.arm.mode = ArmMode::kFault;
  fake.arm.fault = "alarm 4107";
  CHECK_THROWS_WITH(JogFake(fake, 1, 1.0), Contains("jog: "));
}

TEST_CASE("A jog that is stopped, or ends elsewhere, is an error of the device", "[unit]") {
  FakeCell fake;
  int asked = 0;
  CHECK_THROWS_WITH(
      Jog(fake.arm, fake.model.arm, fake.clock, {1, 1.0, [&asked] { return ++asked > 300; }}),
      Contains("stopped on the way"));
  CHECK(fake.arm.stopped == 1);
  CHECK(fake.arm.last_stop == StopKind::kOnPath);
  FakeCell stuck;
  stuck.arm.stuck = true;
  CHECK_THROWS_WITH(JogFake(stuck, 1, 1.0), Contains("jog: "));
  CHECK(stuck.arm.stopped == 1);
}

}  // namespace
}  // namespace tubetwin
