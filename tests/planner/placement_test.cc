#include "planner/grasp/placement.h"

#include <algorithm>

#include "models/base/random.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/support/planning.h"

namespace tubetwin {
namespace {

bool Anywhere(const RigidTransform&) { return true; }

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
  const CellLayout layout = PaperCell().layout;
  const double radius_m = 0.0125;
  RandomStream stream(7, 0, "placement");
  for (int trial = 0; trial < 100; ++trial) {
    // Held near its middle, so that E stays within its zone.
    const double yaw = stream.Uniform(-kPi, kPi);
    const double off = stream.Uniform(-0.007, 0.007);
    const Vector3 axis(std::cos(yaw), std::sin(yaw), 0.0);
    const Polyline line_E = {(off - 0.25) * axis, (off + 0.25) * axis};
    const double near = stream.Uniform(-kPi, kPi);
    const PlacementPose pose =
        PlanPlacement(layout, line_E, radius_m, 0.0, {}, near, Anywhere).value();
    const Polyline line_T = Transformed(layout.X_BT.inverse() * pose.X_BE, line_E);
    const Vector3 direction = (line_T[1] - line_T[0]).normalized();
    CHECK(std::abs(direction.x()) < 1e-9);
    CHECK((CurveCentre(line_T) - pose.slot_centre_T - Vector3(0, 0, radius_m)).norm() < kExact);
    CHECK(std::abs(pose.slot_centre_T.x()) <= 0.5 * layout.tray_zone_m + kExact);
    CHECK(pose.X_BE.linear().col(2).isApprox(Vector3(0, 0, -1)));
    CHECK(pose.raised_m == 0.0);
  }
}

TEST_CASE("Where the fingers reach below the tube it falls by what they need", "[unit]") {
  const CellLayout layout = PaperCell().layout;
  const Polyline line_E = {Vector3(-0.25, 0, 0.002), Vector3(0.25, 0, 0.002)};
  for (const double min_height_m : {0.0, 0.010, 0.030}) {
    const PlacementPose pose =
        PlanPlacement(layout, line_E, 0.0125, min_height_m, {}, 0.0, Anywhere).value();
    const double height_m = (layout.X_BT.inverse() * pose.X_BE).translation().z();
    CHECK(height_m == Approx(std::max(0.0145, min_height_m)));
    CHECK(pose.line_T.front().z() == Approx(0.0125));
  }
}

TEST_CASE("A tube that stands up gets a slot from which it cannot topple off the tray", "[unit]") {
  const CellLayout layout = PaperCell().layout;
  const auto placed = [&](const Polyline& line_E) {
    return PlanPlacement(layout, line_E, 0.0125, 0.0, {}, 0.0, Anywhere).value();
  };
  const double half_m = 0.5 * layout.tray_size_m;
  const Polyline flat_E = {Vector3(-0.15, 0, 0), Vector3(0.15, 0, 0)};
  CHECK(placed(flat_E).slot == 0);
  for (const double rise_m : {0.12, 0.15, 0.18}) {
    const Polyline hoop_E = {Vector3(-0.15, 0, 0), Vector3(0, 0, -rise_m), Vector3(0.15, 0, 0)};
    for (const Vector3& p : placed(hoop_E).line_T) {
      CHECK(p.head<2>().cwiseAbs().maxCoeff() + p.z() - 0.0125 < half_m + kExact);
    }
  }
  // Short enough for two rows: its tall end goes to the middle of the tray.
  const Polyline hook_E = {Vector3(-0.11, 0, 0), Vector3(0.06, 0, 0), Vector3(0.08, 0, -0.18)};
  const Polyline hook_T = placed(hook_E).line_T;
  const auto tallest = std::max_element(hook_T.begin(), hook_T.end(),
                                        [](const auto& a, const auto& b) { return a.z() < b.z(); });
  CHECK(std::abs(tallest->y()) < 0.15);
}

TEST_CASE("Slots are 55 mm apart; short parts get two rows", "[unit]") {
  const CellLayout layout = PaperCell().layout;
  const std::vector<Vector3> one = Slots(layout, 0.5), two = Slots(layout, 0.25);
  REQUIRE(one.size() == 8);
  CHECK(one[1].x() - one[0].x() == Approx(layout.slot_pitch_m));
  CHECK(one[0].y() == 0.0);
  REQUIRE(two.size() == 16);
  CHECK(two[0].y() == Approx(-two[1].y()));
}

TEST_CASE("Straight tubes are laid side by side without touching until the tray is full",
          "[unit]") {
  const CellLayout layout = PaperCell().layout;
  const double radius_m = 0.0125;
  const Polyline line_E = {Vector3(-0.24, 0, 0), Vector3(0.24, 0, 0)};
  std::vector<Polyline> placed;
  for (int i = 0; i < 9; ++i) {
    const PlacementPose pose =
        PlanPlacement(layout, line_E, radius_m, 0.0, placed, 0.0, Anywhere).value();
    for (const Polyline& other : placed) {
      if (i < 8) CHECK(ClosestOfLines(pose.line_T, other).distance_m > 2 * radius_m);
    }
    // The ninth lies upon another one.
    CHECK(pose.raised_m == Approx(i < 8 ? 0.0 : 2 * radius_m).margin(1e-6));
    placed.push_back(pose.line_T);
  }
}

TEST_CASE("A slot out of the arm's reach is not offered", "[unit]") {
  const CellLayout layout = PaperCell().layout;
  const Polyline line_E = {Vector3(-0.24, 0, 0), Vector3(0.24, 0, 0)};
  const double middle_x = layout.X_BT.translation().x();
  const auto right_half = [&](const RigidTransform& X_BE) {
    return X_BE.translation().x() > middle_x;
  };
  CHECK(PlanPlacement(layout, line_E, 0.0125, 0.0, {}, 0.0, right_half)->slot_centre_T.x() > 0.0);
  const auto nowhere = [](const RigidTransform&) { return false; };
  CHECK_FALSE(PlanPlacement(layout, line_E, 0.0125, 0.0, {}, 0.0, nowhere).has_value());
}

}  // namespace
}  // namespace tubetwin
