#include "models/base/joint.h"

#include <algorithm>

#include "models/base/error.h"

namespace tubetwin {

TrajectoryPoint Sample(const JointTrajectory& trajectory, double time_s) {
  const auto& points = trajectory.points;
  TT_CHECK(!points.empty());
  TrajectoryPoint out;
  out.time_s = time_s;
  if (time_s <= points.front().time_s || points.size() == 1) {
    out.q = points.front().q;
    return out;
  }
  if (time_s >= points.back().time_s) {
    out.q = points.back().q;
    return out;
  }
  const auto next =
      std::upper_bound(points.begin(), points.end(), time_s,
                       [](double t, const TrajectoryPoint& p) { return t < p.time_s; });
  const TrajectoryPoint& b = *next;
  const TrajectoryPoint& a = *(next - 1);
  const double T = b.time_s - a.time_s;
  const double u = (time_s - a.time_s) / T;
  const JointVector d = b.q - a.q;
  // p(u) = a + v0 T u + c2 u^2 + c3 u^3 with the end conditions of both points.
  const JointVector c2 = 3.0 * d - T * (2.0 * a.qd + b.qd);
  const JointVector c3 = -2.0 * d + T * (a.qd + b.qd);
  out.q = a.q + u * (T * a.qd + u * (c2 + u * c3));
  out.qd = a.qd + (u / T) * (2.0 * c2 + 3.0 * u * c3);
  out.qdd = (2.0 * c2 + 6.0 * u * c3) / (T * T);
  return out;
}

}  // namespace tubetwin
