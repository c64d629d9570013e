#include "twin/round/scoring.h"

#include <cmath>

#include "models/base/frames.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Ids = std::vector<int>;

Truth::Tube OnTray(int id, double speed_m_s) {
  Truth::Tube tube;
  tube.id = id;
  tube.over_tray = true;
  tube.speed_m_s = speed_m_s;
  return tube;
}

TEST_CASE("A tube counts as placed once it rests, and stays so while a new one makes it rock",
          "[unit]") {
  TrayCount tray = CountTray({OnTray(1, 0.5), OnTray(2, 0.001)}, {});
  CHECK(tray.placed_ids == Ids{2});
  CHECK(tray.arrived_ids == Ids{1, 2});
  tray = CountTray({OnTray(1, 0.001), OnTray(2, 0.5)}, tray);
  CHECK(tray.placed_ids == Ids{1, 2});
}

TEST_CASE("A tube in the fingers, half over the bin or off the tray is not placed", "[unit]") {
  Truth::Tube pinched = OnTray(1, 0.0), hanging = OnTray(2, 0.0), leaning = OnTray(3, 0.0),
              off = OnTray(4, 0.0);
  pinched.touches_pads = true;
  hanging.hangs = true;
  leaning.over_bin = true;
  off.over_tray = false;
  const TrayCount all{{1, 2, 3, 4}, {1, 2, 3, 4}};
  CHECK(CountTray({pinched, hanging, leaning, off}, all).placed_ids.empty());
  CHECK(CountTray({pinched, hanging, leaning, off}, all).arrived_ids.empty());
}

/// A straight line of 0.4 m over the tray, turned by `yaw_deg` from the tray's y, up by
/// `pitch_deg`.
Polyline Turned(double yaw_deg, double pitch_deg = 0.0) {
  const double yaw = Radians(yaw_deg), pitch = Radians(pitch_deg);
  const Vector3 along(-std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch),
                      std::sin(pitch));
  return {Vector3(-0.2 * along), Vector3(0.2 * along)};
}

TEST_CASE("The yaw error is that of the first principal axis, both ends equal", "[unit]") {
  constexpr double kRounding_deg = 1e-6;
  for (const double yaw_deg : {0.0, 3.0, 9.9, 45.0, 90.0}) {
    INFO(yaw_deg);
    CHECK(YawErrorDeg(Turned(yaw_deg)) == Approx(yaw_deg).margin(kRounding_deg));
    CHECK(YawErrorDeg(Turned(-yaw_deg)) == Approx(yaw_deg).margin(kRounding_deg));
    CHECK(YawErrorDeg(Turned(180.0 - yaw_deg)) == Approx(yaw_deg).margin(kRounding_deg));
    CHECK(YawErrorDeg(Turned(yaw_deg, 20.0)) == Approx(yaw_deg).margin(kRounding_deg));
  }
  // Legs of 0.20 m along the tray's y, 0.10 m apart: the axis is theirs, the chord lies across it.
  const Polyline u_shape = {{-0.05, 0.1, 0}, {-0.05, -0.1, 0}, {0.05, -0.1, 0}, {0.05, 0.1, 0}};
  CHECK(YawErrorDeg(u_shape) == Approx(0.0).margin(kRounding_deg));
}

TEST_CASE("A tolerance holds up to its limits and with both of them", "[unit]") {
  const PlacementTolerance tolerance;
  CHECK(tolerance.Holds(20.0, 10.0));
  CHECK_FALSE(tolerance.Holds(20.1, 0.0));
  CHECK_FALSE(tolerance.Holds(0.0, 10.1));
}

}  // namespace
}  // namespace tubetwin
