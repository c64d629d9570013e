#include "planner/scene_query/tube_obstacles.h"

#include <algorithm>

#include "planner/scene_query/sweep.h"

namespace tubetwin {
namespace {

constexpr double kChord_m = 0.001;   // Error of simplified lines.
constexpr double kSample_m = 0.010;  // Between points of the tube that moves.
constexpr double kGripperStep_m = 0.010;
constexpr double kGripper_m = 0.045;   // Fingers around a tube, from its axis, and the hand above.
constexpr double kNearGrasp_m = 0.02;  // How it stands at the start is the grasp's own question.
constexpr double kTouch_m = 0.003;     // More than perception's error.

/// Some point of the line lies within `reach` of p seen from above, higher than z.
bool Over(const Polyline& line, const Vector3& p, double reach, double z) {
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Eigen::Vector2d a = line[k - 1].head<2>(), d = line[k].head<2>() - a;
    const double length2 = d.squaredNorm();
    const Eigen::Vector2d q = p.head<2>();
    const double t = length2 > 0.0 ? std::clamp(d.dot(q - a) / length2, 0.0, 1.0) : 0.0;
    if ((q - a - t * d).norm() >= reach) continue;
    if (line[k - 1].z() + t * (line[k].z() - line[k - 1].z()) > z) return true;
  }
  return false;
}

}  // namespace

TubeObstacles::TubeObstacles(const TubeScene& scene, const PerceivedTube& tube)
    : tube_(tube), points_(Resample(tube.centerline_N, kSample_m)) {
  for (const PerceivedTube& other : scene.tubes) {
    if (other.id == tube.id) continue;
    const Polyline line = Simplified(other.centerline_N, kChord_m);
    others_.push_back({line, other.radius_m, ClosestOfLines(tube.centerline_N, line).distance_m});
  }
}

bool TubeObstacles::Covered(const Vector3& shift) const {
  return std::any_of(others_.begin(), others_.end(), [&](const Other& other) {
    const double reach = tube_.radius_m + other.radius_m;
    return std::any_of(points_.begin(), points_.end(), [&](const Vector3& p) {
      return Over(other.line, p + shift, reach, p.z() + shift.z() + 0.5 * reach);
    });
  });
}

int TubeObstacles::NewlyTouched(const Vector3& shift) const {
  const Polyline moving = Transformed(Translation(shift), Simplified(tube_.centerline_N, kChord_m));
  int count = 0;
  for (const Other& other : others_) {
    const double reach = tube_.radius_m + other.radius_m;
    const double now = ClosestOfLines(moving, other.line).distance_m;
    if (now < reach - kTouch_m && now < other.distance_m - kTouch_m) ++count;
  }
  return count;
}

std::vector<std::pair<double, double>> TubeObstacles::BlockedGrasps(const Vector3& by_N,
                                                                    double step_m,
                                                                    const Vector3& shift) const {
  std::vector<std::pair<double, double>> out;
  const double length = Length(tube_.centerline_N);
  for (double s = 0.0; s <= length; s += step_m) {
    if (!GripperMeets(PointAt(tube_.centerline_N, s) + shift, by_N)) continue;
    out.emplace_back(s - 0.5 * step_m, s + 0.5 * step_m);
  }
  return out;
}

bool TubeObstacles::GripperMeets(const Vector3& p, const Vector3& by_N) const {
  const double length = by_N.norm();
  for (double gone = kNearGrasp_m; gone <= length; gone += kGripperStep_m) {
    const Vector3 at = p + gone / length * by_N;
    for (const Other& other : others_) {
      if (Over(other.line, at, kGripper_m, at.z() - 0.5 * tube_.radius_m)) return true;
    }
  }
  return false;
}

}  // namespace tubetwin
