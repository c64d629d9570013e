#include "perception/part_import/mesh_axis.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "perception/fragment/fragments.h"
#include "perception/fragment/refine.h"
#include "perception/part_import/tube_end.h"

namespace tubetwin {
namespace {

/// The modelling of clouds is made for tubes of about this radius: meshes are scaled to it.
constexpr double kRadius_m = 0.0125;
constexpr double kAreaPerPoint_m2 = 2e-6;
constexpr double kStep_m = 0.0025;  ///< Between nodes of the finished axis.
constexpr double kMaxNodes = 400.0;
constexpr double kPointsPerNode = 60.0;
constexpr double kLongestGap_m = 2.5 * kRadius_m;
constexpr double kEndWindow_m = 0.8 * kRadius_m;  ///< Over which an end's direction is taken.
constexpr double kShortestAxis_m = 1.5 * kRadius_m;

/// Rotation onto the directions in which the points spread most and least: the grid of axis points
/// covers a box, which is small then however a long tube lies in its file.
Matrix3 PrincipalAxes(const std::vector<MeshPoint>& surface) {
  Vector3 mean = Vector3::Zero();
  for (const MeshPoint& point : surface) mean += point.p / static_cast<double>(surface.size());
  Matrix3 spread = Matrix3::Zero();
  for (const MeshPoint& point : surface) spread += (point.p - mean) * (point.p - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Matrix3>(spread).eigenvectors().transpose();
}

/// Turned by `R` and scaled.
std::vector<SurfacePoint> Scaled(const std::vector<MeshPoint>& surface, const Matrix3& R,
                                 double scale) {
  std::vector<SurfacePoint> out;
  for (const MeshPoint& sample : surface) {
    const Vector3 p = scale * (R * sample.p), n = R * sample.n;
    SurfacePoint point;
    point.p_N = p.cast<float>();
    point.n_N = n.cast<float>();
    point.a_N = (p - kRadius_m * n).cast<float>();
    point.weight = 1.0f;
    out.push_back(point);
  }
  return out;
}

/// Joins pieces end to end, nearest ends first, where they look at one another.
std::vector<Polyline> Join(std::vector<Polyline> lines) {
  for (;;) {
    double nearest = kLongestGap_m;
    std::size_t a = 0, b = 0;
    bool first_of_a = false, first_of_b = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (std::size_t k = i + 1; k < lines.size(); ++k) {
        for (int ends = 0; ends < 4; ++ends) {
          const bool fi = (ends & 1) != 0, fk = (ends & 2) != 0;
          const Vector3& p = fi ? lines[i].front() : lines[i].back();
          const Vector3& q = fk ? lines[k].front() : lines[k].back();
          if ((p - q).norm() >= nearest) continue;
          if (OutwardAt(lines[i], fi, kEndWindow_m).dot(OutwardAt(lines[k], fk, kEndWindow_m)) >
              -0.3)
            continue;
          nearest = (p - q).norm();
          a = i, b = k, first_of_a = fi, first_of_b = fk;
        }
      }
    }
    if (a == b) return lines;
    if (first_of_a) std::reverse(lines[a].begin(), lines[a].end());
    if (!first_of_b) std::reverse(lines[b].begin(), lines[b].end());
    lines[a].insert(lines[a].end(), lines[b].begin(), lines[b].end());
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(b));
  }
}

std::vector<AxisPoint> AxisPointsOf(const std::vector<SurfacePoint>& points) {
  std::vector<AxisPoint> out;
  out.reserve(points.size());
  for (const SurfacePoint& point : points) {
    out.push_back({point.a_N.cast<double>(), point.n_N.cast<double>()});
  }
  return out;
}

/// Points of the outer wall around the line, at most some per node.
std::vector<SurfacePoint> WallOf(const Polyline& line, const std::vector<SurfacePoint>& points) {
  std::vector<SurfacePoint> wall;
  for (const SurfacePoint& point : points) {
    const ClosestOnLine foot = Closest(line, point.p_N.cast<double>());
    const Vector3 d = point.p_N.cast<double>() - foot.point;
    if (d.norm() > 1.3 * kRadius_m || point.n_N.cast<double>().dot(d) < 0.7 * d.norm()) continue;
    wall.push_back(point);
  }
  const auto keep = static_cast<std::size_t>(kPointsPerNode * static_cast<double>(line.size()));
  const std::size_t stride = std::max<std::size_t>(1, wall.size() / std::max<std::size_t>(1, keep));
  std::vector<SurfacePoint> out;
  for (std::size_t i = 0; i < wall.size(); i += stride) out.push_back(wall[i]);
  return out;
}

/// Refines the line and takes it to its ends.
void Finish(Polyline& line, const std::vector<SurfacePoint>& points) {
  constexpr int kTimes = 3;
  const std::vector<AxisPoint> axis_points = AxisPointsOf(points);
  const auto move_ends = [&] {
    for (const bool first : {true, false}) {
      MoveEnd(line, first, OutwardAt(line, first, kEndWindow_m), axis_points, kRadius_m,
              0.2 * kRadius_m, kStep_m);
    }
  };
  for (int i = 0; i < kTimes; ++i) {
    move_ends();
    line = Resample(line, std::max(kStep_m, Length(line) / kMaxNodes));
    const std::vector<SurfacePoint> wall = WallOf(line, points);
    if (wall.empty()) return;
    RefineCurve(line, wall, kRadius_m);
  }
  move_ends();
}

}  // namespace

int PointsForAxes(double area_m2, double radius_m) {
  const double scale = kRadius_m / radius_m;
  return static_cast<int>(std::clamp(scale * scale * area_m2 / kAreaPerPoint_m2, 4e3, 4e5));
}

std::vector<Polyline> FindAxes(const std::vector<MeshPoint>& surface, double radius_m,
                               Parallelism parallelism) {
  const double scale = kRadius_m / radius_m;
  if (surface.empty()) return {};
  const Matrix3 R = PrincipalAxes(surface);
  const std::vector<SurfacePoint> points = Scaled(surface, R, scale);
  const AxisSpace space = BuildAxisSpace(points, parallelism);
  std::vector<Polyline> lines;
  for (Fragment& fragment : FindFragments(space, points, kRadius_m, parallelism)) {
    lines.push_back(std::move(fragment.line_N));
  }
  lines = Join(std::move(lines));
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Polyline& a, const Polyline& b) { return Length(a) > Length(b); });
  while (!lines.empty() && Length(lines.back()) < kShortestAxis_m) lines.pop_back();
  if (lines.empty()) return lines;
  Finish(lines.front(), points);
  for (Polyline& line : lines) {
    for (Vector3& p : line) p = R.transpose() * p / scale;
  }
  return lines;
}

}  // namespace tubetwin
