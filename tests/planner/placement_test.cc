#include "planner/placement.h"

#include "hw_bridge/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

constexpr double kExact = 1e-9;  // Closed form, double precision.

TEST_CASE("A straight tube's principal direction is its axis", "[unit]") {
  const Vector3 axis = Vector3(1, 2, 0.5).normalized();
  const Polyline line = {Vector3(0.1, 0.2, 0.3), Vector3(0.1, 0.2, 0.3) + 0.5 * axis};
  CHECK((PrincipalDirection(line) - axis).norm() < kExact);
}

TEST_CASE("A U is directed along the chord of its ends", "[unit]") {
  Polyline line;
  for (int i = 0; i <= 20; ++i) {
    const double a = kPi * i / 20;
    line.push_back(0.1 * Vector3(std::cos(a), 1.2 * std::sin(a), 0.0));
  }
  CHECK(std::abs(PrincipalDirection(line).x()) > 0.99);
}

TEST_CASE("A laid tube lies in its slot, along the tray, on the surface", "[unit]") {
  const CellLayout layout;
  const double radius_m = 0.0125;
  RandomStream stream(7, 0, "placement");
  for (int trial = 0; trial < 100; ++trial) {
    // Held near its middle, so that E stays within its zone.
    const double yaw = stream.Uniform(-kPi, kPi);
    const double off = stream.Uniform(-0.02, 0.02);
    const Vector3 axis(std::cos(yaw), std::sin(yaw), 0.0);
    const Polyline line_E = {(off - 0.25) * axis, (off + 0.25) * axis};
    const int index = static_cast<int>(stream.Index(8));
    const double near = stream.Uniform(-kPi, kPi);
    const PlacementPose pose = PlanPlacement(layout, line_E, radius_m, index, near);
    const Polyline line_T = Transformed(layout.X_BT.inverse() * pose.X_BE, line_E);
    const Vector3 direction = (line_T[1] - line_T[0]).normalized();
    CHECK(std::abs(direction.x()) < 1e-9);
    CHECK((CurveCentre(line_T) - pose.slot_centre_T - Vector3(0, 0, radius_m)).norm() < kExact);
    CHECK(std::abs(pose.slot_centre_T.x()) <= 0.5 * layout.tray_zone_m + kExact);
    CHECK(pose.X_BE.linear().col(2).isApprox(Vector3(0, 0, -1)));
    double turn = std::remainder(ToolYaw(pose.X_BE.linear()) - near, 2 * kPi);
    CHECK(std::abs(turn) <= kPi / 2 + 1e-6);
  }
}

TEST_CASE("Slots are 55 mm apart, and used again when all are full", "[unit]") {
  const CellLayout layout;
  const Polyline line_E = {Vector3(-0.2, 0, 0), Vector3(0.2, 0, 0)};
  const auto x = [&](int index) {
    return PlanPlacement(layout, line_E, 0.01, index, 0.0).slot_centre_T.x();
  };
  CHECK(SlotCount(layout) == 8);
  CHECK(x(1) - x(0) == Approx(layout.slot_pitch_m));
  CHECK(x(8) == Approx(x(0)));
}

}  // namespace
}  // namespace tubetwin
