#include "hw_bridge/cell/checked_trajectory.h"

#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr double kRounding = 1e-6;    // relative, of every limit
constexpr double kRest_rad_s = 1e-6;  // slower than that is at rest

std::string Format(const char* format, int joint, double value, double limit) {
  char text[160];
  std::snprintf(text, sizeof text, format, joint + 1, value, limit);
  return text;
}

/// The cubic of one joint between two points, in u from 0 to 1:
/// q = q0 + u (c1 + u (c2 + u c3)).
struct Cubic {
  double q0, c1, c2, c3, T;

  Cubic(const TrajectoryPoint& a, const TrajectoryPoint& b, int joint) {
    T = b.time_s - a.time_s;
    const double d = b.q[joint] - a.q[joint];
    q0 = a.q[joint];
    c1 = T * a.qd[joint];
    c2 = 3 * d - T * (2 * a.qd[joint] + b.qd[joint]);
    c3 = -2 * d + T * (a.qd[joint] + b.qd[joint]);
  }
  double Position(double u) const { return q0 + u * (c1 + u * (c2 + u * c3)); }
  double Speed(double u) const { return (c1 + u * (2 * c2 + 3 * u * c3)) / T; }
  double Acceleration(double u) const { return (2 * c2 + 6 * u * c3) / (T * T); }
};

/// Where in (0, 1) the position turns round (up to two places) and the speed is extreme.
std::vector<double> InnerExtremes(const Cubic& c) {
  std::vector<double> out;
  const auto add = [&out](double u) {
    if (u > 0.0 && u < 1.0) out.push_back(u);
  };
  if (c.c3 != 0.0) add(-c.c2 / (3 * c.c3));
  // c1 + 2 c2 u + 3 c3 u^2 = 0, in the form that does not cancel.
  const double discriminant = c.c2 * c.c2 - 3 * c.c3 * c.c1;
  if (discriminant >= 0.0) {
    const double s = -(c.c2 + std::copysign(std::sqrt(discriminant), c.c2));
    if (c.c3 != 0.0) add(s / (3 * c.c3));
    if (s != 0.0) add(c.c1 / s);
  }
  return out;
}

std::optional<TrajectoryRejection> CheckJoint(const ArmModel::Joint& limits, int joint,
                                              const TrajectoryPoint& a, const TrajectoryPoint& b) {
  const Cubic cubic(a, b, joint);
  std::vector<double> places = InnerExtremes(cubic);
  places.insert(places.begin(), 0.0);
  places.push_back(1.0);
  for (const double u : places) {
    const double time_s = a.time_s + u * cubic.T;
    const double q = cubic.Position(u);
    const double speed = std::abs(cubic.Speed(u));
    const double acceleration = std::abs(cubic.Acceleration(u));
    if (q < limits.lower_rad - kRounding || q > limits.upper_rad + kRounding) {
      const double limit = q < limits.lower_rad ? limits.lower_rad : limits.upper_rad;
      return TrajectoryRejection{
          Format("joint %d at %.1f degrees, limit %.1f", joint, Degrees(q), Degrees(limit)), time_s,
          joint};
    }
    if (speed > limits.max_speed_rad_s * (1 + kRounding)) {
      return TrajectoryRejection{Format("joint %d at %.1f degrees/s, limit %.1f", joint,
                                        Degrees(speed), Degrees(limits.max_speed_rad_s)),
                                 time_s, joint};
    }
    if (acceleration > limits.max_acceleration_rad_s2 * (1 + kRounding)) {
      return TrajectoryRejection{
          Format("joint %d at %.0f degrees/s^2, limit %.0f", joint, Degrees(acceleration),
                 Degrees(limits.max_acceleration_rad_s2)),
          time_s, joint};
    }
  }
  return std::nullopt;
}

std::optional<TrajectoryRejection> CheckForm(const std::vector<TrajectoryPoint>& points) {
  if (points.size() < 2) return TrajectoryRejection{"needs at least two points", 0.0, -1};
  if (points.front().time_s != 0.0) {
    return TrajectoryRejection{"does not start at time 0", points.front().time_s, -1};
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TrajectoryPoint& p = points[i];
    if (!p.q.allFinite() || !p.qd.allFinite() || !std::isfinite(p.time_s)) {
      return TrajectoryRejection{"point " + std::to_string(i) + " is not finite", 0.0, -1};
    }
    if (i > 0 && !(p.time_s > points[i - 1].time_s)) {
      return TrajectoryRejection{"time does not increase at point " + std::to_string(i), p.time_s,
                                 -1};
    }
  }
  for (const TrajectoryPoint* end : {&points.front(), &points.back()}) {
    int joint = 0;
    if (end->qd.cwiseAbs().maxCoeff(&joint) > kRest_rad_s) {
      return TrajectoryRejection{
          end == &points.front() ? "does not start at rest" : "does not end at rest", end->time_s,
          joint};
    }
  }
  return std::nullopt;
}

}  // namespace

CheckedTrajectory CheckedTrajectory::Stretched(double factor) const {
  TT_CHECK(factor >= 1.0);
  JointTrajectory longer = trajectory_;
  for (TrajectoryPoint& point : longer.points) {
    point.time_s *= factor;
    point.qd /= factor;
    point.qdd /= factor * factor;
  }
  return CheckedTrajectory(std::move(longer));
}

std::variant<CheckedTrajectory, TrajectoryRejection> CheckTrajectory(const ArmModel& arm,
                                                                     JointTrajectory trajectory) {
  const auto& points = trajectory.points;
  if (auto rejection = CheckForm(points)) return *rejection;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    for (int joint = 0; joint < kNumJoints; ++joint) {
      auto rejection = CheckJoint(arm.joints[joint], joint, points[i], points[i + 1]);
      if (rejection) return *rejection;
    }
  }
  return CheckedTrajectory(std::move(trajectory));
}

}  // namespace tubetwin
