#include "planner/scene_query/wall_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tubetwin {
namespace {

constexpr double kSlack_m = 0.002;

// How far a box [low, high] may move by t * direction (t >= 0) along one axis within +-half less
// the safety distance. A box that is already nearer to the wall may come kSlack_m nearer still, so
// that a tube at a wall can slide along it although its line is not exactly parallel.
double AllowedTravel(double low, double high, double direction, double half, double safety) {
  if (std::abs(direction) < 1e-9) return std::numeric_limits<double>::infinity();
  const double to_wall = direction > 0 ? half - high : low + half;
  const double room = std::max(to_wall - safety, std::min(to_wall, kSlack_m));
  return std::max(0.0, room) / std::abs(direction);
}

}  // namespace

double MaxSlideDistance(const PerceivedTube& tube, const Vector3& direction, const Bin& bin,
                        double safety_m) {
  Vector3 low = tube.centerline_N.front(), high = low;
  for (const Vector3& p : tube.centerline_N) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double r = tube.radius_m;
  return std::min(
      AllowedTravel(low.x() - r, high.x() + r, direction.x(), bin.half_x_m(), safety_m),
      AllowedTravel(low.y() - r, high.y() + r, direction.y(), bin.half_y_m(), safety_m));
}

}  // namespace tubetwin
