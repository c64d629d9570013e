#include "hw_bridge/cell/checked_trajectory.h"

#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

TrajectoryPoint Point(double time_s, const JointVector& q,
                      const JointVector& qd = JointVector::Zero()) {
  TrajectoryPoint p;
  p.time_s = time_s;
  p.q = q;
  p.qd = qd;
  return p;
}

TrajectoryRejection Rejected(const JointTrajectory& trajectory) {
  const auto result = CheckTrajectory(PaperCell().arm, trajectory);
  REQUIRE(std::holds_alternative<TrajectoryRejection>(result));
  return std::get<TrajectoryRejection>(result);
}

const JointVector kHome = (JointVector() << 0, 0.3, 1.5, 0, -1.2, 0).finished();

TEST_CASE("A slow joint move from rest to rest passes and keeps its points", "[unit]") {
  const JointVector goal = kHome + 0.1 * JointVector::Ones();
  const auto result = CheckTrajectory(PaperCell().arm, {{Point(0, kHome), Point(1, goal)}});
  REQUIRE(std::holds_alternative<CheckedTrajectory>(result));
  const auto& checked = std::get<CheckedTrajectory>(result);
  CHECK(checked.duration_s() == 1.0);
  CHECK(checked.trajectory().points.size() == 2);
  CHECK(checked.trajectory().points[1].q == goal);
}

TEST_CASE("A position beyond its limit is refused with joint, value and limit", "[unit]") {
  JointVector goal = kHome;
  goal[2] = Radians(356.0);
  const auto rejection = Rejected({{Point(0, kHome), Point(60, goal)}});
  CHECK(rejection.joint == 2);
  CHECK(rejection.reason == "joint 3 at 356.0 degrees, limit 355.0");
  CHECK(rejection.time_s == 60.0);
}

TEST_CASE("A cubic that swings beyond a limit between two good points is refused", "[unit]") {
  JointVector a = kHome, b = kHome;
  a[0] = b[0] = Radians(179.9);
  JointVector out = JointVector::Zero();
  out[0] = 0.2;  // leaves upwards and has to come back
  const auto rejection =
      Rejected({{Point(0, a - JointVector::Unit(0) * 0.05), Point(1, a, out), Point(2, b)}});
  CHECK(rejection.joint == 0);
  CHECK(rejection.time_s > 1.0);
  CHECK(rejection.time_s < 2.0);
  CHECK_THAT(rejection.reason, Catch::Contains("limit 180.0"));
}

TEST_CASE("Speed and acceleration above the limits are refused by name", "[unit]") {
  // From rest to rest by one cubic: top speed 1.5 d/T, acceleration 6 d/T^2.
  JointVector goal = kHome;
  goal[5] += 2.0;
  const double top = 1.5 * 2.0;
  const double T_speed = 0.9 * top / PaperCell().arm.joints[5].max_speed_rad_s;
  CHECK_THAT(Rejected({{Point(0, kHome), Point(T_speed, goal)}}).reason,
             Catch::Contains("joint 6"));
  const double T_acceleration =
      0.98 * std::sqrt(12.0 / PaperCell().arm.joints[5].max_acceleration_rad_s2);
  CHECK(top / T_acceleration < PaperCell().arm.joints[5].max_speed_rad_s);
  CHECK_THAT(Rejected({{Point(0, kHome), Point(T_acceleration, goal)}}).reason,
             Catch::Contains("degrees/s^2"));
  const auto slower =
      CheckTrajectory(PaperCell().arm, {{Point(0, kHome), Point(T_acceleration * 1.03, goal)}});
  CHECK(std::holds_alternative<CheckedTrajectory>(slower));
}

TEST_CASE("A trajectory that is no trajectory is refused", "[unit]") {
  const JointVector moving = 0.1 * JointVector::Ones();
  CHECK(Rejected({{Point(0, kHome)}}).reason == "needs at least two points");
  CHECK(Rejected({{Point(0.5, kHome), Point(1, kHome)}}).reason == "does not start at time 0");
  CHECK(Rejected({{Point(0, kHome), Point(0, kHome)}}).reason ==
        "time does not increase at point 1");
  CHECK(Rejected({{Point(0, kHome, moving), Point(1, kHome)}}).reason == "does not start at rest");
  CHECK(Rejected({{Point(0, kHome), Point(1, kHome, moving)}}).reason == "does not end at rest");
  JointVector bad = kHome;
  bad[4] = std::nan("");
  CHECK(Rejected({{Point(0, kHome), Point(1, bad)}}).reason == "point 1 is not finite");
}

}  // namespace
}  // namespace tubetwin
