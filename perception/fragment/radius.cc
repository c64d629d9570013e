#include "perception/fragment/radius.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tubetwin {
namespace {

/// Sum of squared differences of unit normals within slices: a tenth of a metre of tube has some
/// hundred times this.
constexpr double kMinWeight = 5.0;

/// Places, per point, that the axis points of one radius take up.
double Crowding(const std::vector<SurfacePoint>& points, float radius_m) {
  const VoxelGrid grid(points, kVoxel_m, [radius_m](const SurfacePoint& p) -> Eigen::Vector3f {
    return p.p_N - radius_m * p.n_N;
  });
  return static_cast<double>(grid.size()) / static_cast<double>(points.size());
}

}  // namespace

std::optional<double> EstimateRadius(const std::vector<Fragment>& fragments) {
  std::vector<std::pair<double, double>> estimates;  // Radius, weight.
  double total = 0.0;
  for (const Fragment& f : fragments) {
    if (!(f.radius_weight > 0.0)) continue;
    estimates.emplace_back(f.radius_m, f.radius_weight);
    total += f.radius_weight;
  }
  if (total < kMinWeight) return std::nullopt;
  std::sort(estimates.begin(), estimates.end());
  double below = 0.0;
  for (const auto& [radius_m, weight] : estimates) {
    below += weight;
    if (below >= 0.5 * total) return radius_m;
  }
  return estimates.back().first;
}

std::optional<double> SearchRadius(std::vector<SurfacePoint> points, Parallelism parallelism) {
  constexpr std::size_t kMax = 20000, kFewest = 500;
  constexpr double kSmallest_m = 0.003, kLargest_m = 0.042, kRatio = 1.1;
  if (points.size() < kFewest) return std::nullopt;
  std::vector<SurfacePoint> some;
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / kMax) {
    some.push_back(points[i]);
  }
  double best_m = 0.0, fewest = 1e9;
  for (double r = kSmallest_m; r <= kLargest_m; r *= kRatio) {
    const double places = Crowding(some, static_cast<float>(r));
    if (places >= fewest) continue;
    fewest = places;
    best_m = r;
  }
  for (SurfacePoint& p : points) p.a_N = p.p_N - static_cast<float>(best_m) * p.n_N;
  const AxisSpace space = BuildAxisSpace(points, parallelism);
  return EstimateRadius(FindFragments(space, points, best_m, parallelism));
}

std::string RadiusWarning(double part_radius_m, double estimate_m) {
  if (std::abs(estimate_m / part_radius_m - 1.0) <= kRadiusTolerance) return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "the part's radius is %.2f mm, the points say %.2f mm: check radius_m of the part",
                1e3 * part_radius_m, 1e3 * estimate_m);
  return text;
}

}  // namespace tubetwin
