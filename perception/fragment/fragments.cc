#include "perception/fragment/fragments.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "perception/fragment/refine.h"
#include "perception/fragment/trace.h"

namespace tubetwin {
namespace {

/// Shorter pieces carry no direction worth trusting.
constexpr double kShortest_m = 0.012;
/// Surface points per node that are kept for the refinement.
constexpr double kPointsPerNode = 80.0;
/// A piece whose points fit worse than this is no tube of this radius.
constexpr double kMinFit = 0.5;
/// A tube's normals turn about its axis; those of an edge or a strip do not (rms sine).
constexpr double kMinSpread = 0.12;
/// Cosine to the outward tangent from which a normal is one of the rounded end, and from which it
/// can hardly be one of a bend.
constexpr double kOutward = 0.5;
constexpr double kStraightOut = 0.72;
/// Fewest well-fitting points of a node that stays at an end.
constexpr double kMinSupport = 4.0;

std::vector<SurfacePoint> Thin(const std::vector<SurfacePoint>& points,
                               const std::vector<int>& chosen, std::size_t keep) {
  const std::size_t stride =
      std::max<std::size_t>(1, chosen.size() / std::max<std::size_t>(keep, 1));
  std::vector<SurfacePoint> out;
  for (std::size_t i = 0; i < chosen.size(); i += stride) {
    out.push_back(points[static_cast<std::size_t>(chosen[i])]);
  }
  return out;
}

Vector3 OutwardTangent(const Polyline& line, int end, double window_m) {
  const double length = Length(line);
  const double s = std::min(window_m, length);
  return end == 0 ? (line.front() - PointAt(line, s)).normalized()
                  : (line.back() - PointAt(line, length - s)).normalized();
}

/// Tangent and curvature at an end from the parabola through its last nodes: a chord would lag
/// behind a bend by half its length.
void FitEnd(const Polyline& line, int end, FragmentEnd& out) {
  constexpr std::size_t kNodes = 7;
  constexpr std::size_t kFewestForParabola = 5;
  const std::size_t n = std::min(line.size(), kNodes);
  out.outward_N = OutwardTangent(line, end, 0.02);
  if (n < kFewestForParabola) return;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d right = Eigen::Matrix3d::Zero();  // Row per power, column per coordinate.
  double s = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const Vector3& p = end == 0 ? line[k] : line[line.size() - 1 - k];
    const Vector3& before = k == 0 ? p : end == 0 ? line[k - 1] : line[line.size() - k];
    s += (p - before).norm();
    const Vector3 powers(1.0, s, s * s);
    normal += powers * powers.transpose();
    right += powers * (p - out.p_N).transpose();
  }
  const Eigen::Matrix3d fit = normal.ldlt().solve(right);
  // Arc length runs inwards.
  out.outward_N = -fit.row(1).transpose().normalized();
  const Vector3 bend = 2.0 * fit.row(2).transpose();
  out.bend_N = bend - bend.dot(out.outward_N) * out.outward_N;
}

/// Moves an end node to where the axis points near it end: slices stop half a slice short.
void StretchEnd(Polyline& line, int end, const std::vector<SurfacePoint>& points) {
  constexpr double kNear_m = 0.010;
  Vector3& node = end == 0 ? line.front() : line.back();
  const Vector3 t = OutwardTangent(line, end, 0.02);
  std::vector<double> along;
  for (const SurfacePoint& point : points) {
    const Vector3 d = point.a_N.cast<double>() - node;
    const double s = d.dot(t);
    if (std::abs(s) > kNear_m || (d - s * t).norm() > 0.003) continue;
    along.push_back(s);
  }
  if (along.size() < 10) return;
  const auto last = along.begin() + static_cast<std::ptrdiff_t>(0.97 * along.size());
  std::nth_element(along.begin(), last, along.end());
  node += std::max(*last, -0.5 * kNodeStep_m) * t;
}

/// Drops end nodes that (almost) no point supports.
void TrimEnds(Polyline& line, std::vector<double>& support) {
  while (line.size() > 2 && support.back() < kMinSupport) {
    line.pop_back();
    support.pop_back();
  }
  std::size_t first = 0;
  while (line.size() - first > 2 && support[first] < kMinSupport) ++first;
  line.erase(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(first));
}

/// Seen area of the rounded end, as a share of what is usually visible: cells of the surface whose
/// normal looks out of the end. A sharp bend shows such normals as well, but hardly any that look
/// straight out.
double CapEvidence(const FragmentEnd& end, const std::vector<SurfacePoint>& points,
                   const std::vector<int>& chosen, double r) {
  constexpr double kCell_m = 0.0025;
  std::set<std::tuple<int, int, int>> outward, straight_out;
  for (const int i : chosen) {
    const SurfacePoint& point = points[static_cast<std::size_t>(i)];
    const Vector3 d = point.p_N.cast<double>() - end.p_N;
    if (d.squaredNorm() > 1.3 * 1.3 * r * r || d.dot(end.outward_N) < 0.35 * r) continue;
    const double cosine = point.n_N.cast<double>().dot(end.outward_N);
    if (cosine < kOutward) continue;
    const std::tuple cell(static_cast<int>(std::floor(d.x() / kCell_m)),
                          static_cast<int>(std::floor(d.y() / kCell_m)),
                          static_cast<int>(std::floor(d.z() / kCell_m)));
    outward.insert(cell);
    if (cosine > kStraightOut) straight_out.insert(cell);
  }
  // Half of the pi r^2 beyond the first cosine is seen from above; a third of that is enough to be
  // sure. Of the 0.4 pi r^2 beyond the second most is too steep for a normal.
  const double cells = r * r / (kCell_m * kCell_m);
  return std::min({1.0, static_cast<double>(outward.size()) / (0.5 * kPi / 3.0 * cells),
                   static_cast<double>(straight_out.size()) / (0.2 * cells)});
}

/// How far the surface reaches beyond an end of the axis: of a round end all surface points have
/// their axis point at its centre. 0 to r.
double TipBeyond(const FragmentEnd& end, const std::vector<SurfacePoint>& points,
                 const std::vector<int>& chosen, double r) {
  constexpr std::size_t kFewest = 20;
  constexpr double kNearAxis = 1.1;  // Radii from the axis' line.
  constexpr double kShare = 0.99;    // What lies beyond is noise.
  std::vector<double> beyond;
  for (const int i : chosen) {
    const SurfacePoint& point = points[static_cast<std::size_t>(i)];
    const Vector3 d = point.p_N.cast<double>() - end.p_N;
    const double s = d.dot(end.outward_N);
    if (s <= 0.0 || s > 1.5 * r || (d - s * end.outward_N).norm() > kNearAxis * r) continue;
    beyond.push_back(s);
  }
  if (beyond.size() < kFewest) return 0.0;
  const auto last =
      beyond.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(beyond.size() - 1));
  std::nth_element(beyond.begin(), last, beyond.end());
  return std::min(r, *last);
}

/// The refined fragment of one trace, or one of length 0 when it is no tube.
Fragment FitTrace(const Trace& trace, const std::vector<SurfacePoint>& points,
                  const std::vector<int>& chosen, double r) {
  Fragment out;
  Polyline line = trace.line_N;
  const std::vector<SurfacePoint> coarse = Thin(points, chosen, 4000);
  for (int end = 0; end < 2; ++end) StretchEnd(line, end, coarse);
  line = Resample(line, kNodeStep_m);
  const auto keep = static_cast<std::size_t>(kPointsPerNode * static_cast<double>(line.size()));
  const std::vector<SurfacePoint> sample = Thin(points, chosen, keep);
  TubeFit fit = RefineCurve(line, sample, r);
  if (fit.share < kMinFit || fit.normal_spread < kMinSpread) return out;
  TrimEnds(line, fit.node_weight);
  out.length_m = Length(line);
  if (out.length_m < kShortest_m) {
    out.length_m = 0.0;
    return out;
  }
  out.line_N = line;
  out.rms_m = fit.rms_m;
  out.fit = fit.share;
  out.normal_spread = fit.normal_spread;
  out.radius_m = fit.radius_m;
  out.radius_weight = fit.radius_weight;
  for (int end = 0; end < 2; ++end) {
    FragmentEnd& e = out.ends[static_cast<std::size_t>(end)];
    e.p_N = end == 0 ? line.front() : line.back();
    FitEnd(line, end, e);
    e.cap = CapEvidence(e, points, chosen, r);
    e.tip_m = TipBeyond(e, points, chosen, r);
  }
  return out;
}

}  // namespace

std::vector<Fragment> FindFragments(const AxisSpace& space, const std::vector<SurfacePoint>& points,
                                    double radius_m, Parallelism parallelism) {
  std::vector<std::vector<Fragment>> found(space.components.size());
  ParallelFor(static_cast<int>(found.size()), parallelism, [&](int c, int) {
    const auto k = static_cast<std::size_t>(c);
    const auto traces = TraceComponent(space, space.components[k], kNodeStep_m, kShortest_m);
    for (const Trace& trace : traces) {
      std::vector<int> chosen;
      for (const int v : trace.voxels) {
        const auto i = static_cast<std::size_t>(v);
        chosen.insert(chosen.end(), space.points_of_voxels.begin() + space.first_point[i],
                      space.points_of_voxels.begin() + space.first_point[i + 1]);
      }
      Fragment fragment = FitTrace(trace, points, chosen, radius_m);
      if (fragment.length_m > 0.0) found[k].push_back(std::move(fragment));
    }
  });
  std::vector<Fragment> out;
  for (auto& list : found) {
    for (Fragment& f : list) out.push_back(std::move(f));
  }
  return out;
}

}  // namespace tubetwin
