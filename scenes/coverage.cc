#include "scenes/coverage.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

constexpr double kSampleStep_m = 0.001;

// Is any point of segment a-b within r of p seen from above and more than r higher than p?
// Horizontal nearness holds on an interval of the segment, height on a ray: do they meet?
bool SegmentCovers(const Vector3& a, const Vector3& b, const Vector3& p, double r) {
  if (std::max(a.z(), b.z()) <= p.z() + r) return false;
  const Eigen::Vector2d d = (b - a).head<2>(), w = (a - p).head<2>();
  const double dd = d.squaredNorm(), dw = d.dot(w);
  double low = 0.0, high = 1.0;
  if (dd > 1e-18) {
    const double discriminant = dw * dw - dd * (w.squaredNorm() - r * r);
    if (discriminant < 0.0) return false;
    low = std::max(low, (-dw - std::sqrt(discriminant)) / dd);
    high = std::min(high, (-dw + std::sqrt(discriminant)) / dd);
  } else if (w.squaredNorm() > r * r) {
    return false;
  }
  const double rise = b.z() - a.z(), needed = p.z() + r - a.z();
  if (std::abs(rise) < 1e-12) return low < high && needed < 0.0;
  if (rise > 0.0) {
    low = std::max(low, needed / rise);
  } else {
    high = std::min(high, needed / rise);
  }
  return low < high;
}

bool Covers(const Polyline& line, const Vector3& p, double radius_m) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    if (SegmentCovers(line[i], line[i + 1], p, radius_m)) return true;
  }
  return false;
}

}  // namespace

std::vector<int> CoveredRuns(const Pile& pile) {
  std::vector<int> runs(pile.tubes.size(), 0);
  for (std::size_t under = 0; under < pile.tubes.size(); ++under) {
    const Polyline samples = Resample(pile.tubes[under].centerline_N, kSampleStep_m);
    for (std::size_t over = 0; over < pile.tubes.size(); ++over) {
      if (over == under) continue;
      bool inside = false;
      for (const Vector3& p : samples) {
        const bool covered = Covers(pile.tubes[over].centerline_N, p, pile.tubes[under].radius_m);
        if (covered && !inside) ++runs[under];
        inside = covered;
      }
    }
  }
  return runs;
}

int CountFree(const Pile& pile) {
  const std::vector<int> runs = CoveredRuns(pile);
  return static_cast<int>(std::count(runs.begin(), runs.end(), 0));
}

}  // namespace tubetwin
