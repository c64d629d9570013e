#include "perception/part_import/tube_end.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tubetwin {

Vector3 OutwardAt(const Polyline& line, bool first, double window_m) {
  const double length = Length(line), s = std::min(window_m, length);
  return first ? (line.front() - PointAt(line, s)).normalized()
               : (line.back() - PointAt(line, length - s)).normalized();
}

void MoveEnd(Polyline& line, bool first, const Vector3& t, const std::vector<AxisPoint>& points,
             double radius_m, double beside_m, double step_m) {
  const double back_m = 0.8 * radius_m, ahead_m = 1.2 * radius_m;
  const Vector3 end = first ? line.front() : line.back();
  const Vector3 u = t.unitOrthogonal(), v = t.cross(u);
  std::array<double, 8> furthest;
  furthest.fill(-back_m);
  for (const AxisPoint& point : points) {
    const Vector3 d = point.a - end;
    const double s = d.dot(t);
    if (s < -back_m || s > ahead_m || (d - s * t).norm() > beside_m) continue;
    const double angle = std::atan2(point.n.dot(v), point.n.dot(u)) + kPi;
    double& sector_m = furthest[static_cast<std::size_t>(std::min(7.0, angle / (2.0 * kPi) * 8.0))];
    sector_m = std::max(sector_m, s);
  }
  std::sort(furthest.begin(), furthest.end());
  const double move = 0.5 * (furthest[3] + furthest[4]);
  while (line.size() > 2) {
    const Vector3& next = first ? line[1] : line[line.size() - 2];
    if ((next - end).dot(t) < move - 0.5 * step_m) break;
    line.erase(first ? line.begin() : line.end() - 1);
  }
  (first ? line.front() : line.back()) = end + move * t;
}

}  // namespace tubetwin
