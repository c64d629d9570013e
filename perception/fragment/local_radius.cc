#include "perception/fragment/local_radius.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace tubetwin {
namespace {

constexpr int kPoints = 4000;
constexpr std::size_t kNeighbours = 60, kMinPairs = 5;
/// Radii within this share of one another are the same.
constexpr double kSame = 0.06;

/// Radius of the surface about one point; 0 where it is flat or bulges in.
double RadiusAt(const std::vector<MeshPoint>& points, const MeshPoint& anchor) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < points.size(); ++i) {
    near.emplace_back((points[i].p - anchor.p).squaredNorm(), i);
  }
  const std::size_t count = std::min(kNeighbours, near.size() - 1);
  std::nth_element(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
  near.resize(count);
  std::vector<std::pair<double, double>> turn_and_radius;
  for (const auto& [squared, i] : near) {
    const Vector3 dn = points[i].n - anchor.n, dp = points[i].p - anchor.p;
    // Normals that differ little say little; those that differ much belong to another side.
    if (dn.norm() < 0.1 || points[i].n.dot(anchor.n) < 0.3 || !(squared > 0.0)) continue;
    turn_and_radius.emplace_back(-dn.norm() / std::sqrt(squared), dp.dot(dn) / dn.squaredNorm());
  }
  if (turn_and_radius.size() < kMinPairs) return 0.0;
  std::sort(turn_and_radius.begin(), turn_and_radius.end());
  turn_and_radius.resize(std::max(kMinPairs, turn_and_radius.size() / 4));
  const auto middle =
      turn_and_radius.begin() + static_cast<std::ptrdiff_t>(turn_and_radius.size() / 2);
  std::nth_element(turn_and_radius.begin(), middle, turn_and_radius.end(),
                   [](const auto& a, const auto& b) { return a.second < b.second; });
  return std::max(0.0, middle->second);
}

}  // namespace

LocalRadius FindLocalRadius(const Mesh& mesh) {
  LocalRadius out;
  out.points = SampleSurface(mesh, kPoints);
  std::vector<double> radii;
  for (const MeshPoint& point : out.points) {
    out.radii_m.push_back(RadiusAt(out.points, point));
    if (out.radii_m.back() > 0.0) radii.push_back(out.radii_m.back());
  }
  if (radii.empty()) return out;
  out.round_share = static_cast<double>(radii.size()) / kPoints;
  std::sort(radii.begin(), radii.end());
  out.low_m = radii[radii.size() / 10];
  out.high_m = radii[radii.size() - 1 - radii.size() / 10];
  std::ptrdiff_t max_count = -1;
  for (auto from = radii.begin(); from != radii.end(); ++from) {
    const auto to = std::upper_bound(from, radii.end(), *from * (1.0 + 2.0 * kSame));
    if (to - from <= max_count) continue;
    max_count = to - from;
    out.radius_m = *(from + max_count / 2);
  }
  return out;
}

std::vector<MeshPoint> RoundSurface(const LocalRadius& local,
                                    const std::vector<MeshPoint>& samples) {
  // Sorted along x, so that the search from a sample's own place soon ends.
  std::vector<std::size_t> order(local.points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto x = [&](std::size_t i) { return local.points[i].p.x(); };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(x(a), a) < std::pair(x(b), b); });
  std::vector<MeshPoint> out;
  for (const MeshPoint& sample : samples) {
    double nearest = std::numeric_limits<double>::infinity();
    double radius_m = 0.0;
    // The other side of a thin wall is near as well: only points that look the same way count.
    const auto far = [&](std::size_t i) {
      const double dx = x(i) - sample.p.x();
      const double squared = (local.points[i].p - sample.p).squaredNorm();
      if (squared < nearest && local.points[i].n.dot(sample.n) > 0.5) {
        nearest = squared;
        radius_m = local.radii_m[i];
      }
      return dx * dx > nearest;
    };
    const auto middle = std::lower_bound(order.begin(), order.end(), sample.p.x(),
                                         [&](std::size_t i, double value) { return x(i) < value; });
    for (auto i = middle; i != order.end() && !far(*i); ++i) {
    }
    for (auto i = std::make_reverse_iterator(middle); i != order.rend() && !far(*i); ++i) {
    }
    if (radius_m > 0.0) out.push_back(sample);
  }
  return out;
}

}  // namespace tubetwin
