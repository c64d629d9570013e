#include "perception/fragment/axis_space.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace tubetwin {
namespace {

/// Least weight of a voxel: a tube's axis collects some forty points per voxel and view.
constexpr float kLightest = 3.0f;
/// Voxels around one that are looked at for its line, and the largest spread across that line:
/// views that disagree by a millimetre stay below, a sheet of axis points (a plane's) does not.
constexpr int kReach = 3;
constexpr float kLargestSpread_m = 0.0018f;

void FillVoxels(const std::vector<SurfacePoint>& points, AxisSpace& space) {
  const auto n = static_cast<std::size_t>(space.grid.size());
  space.voxels.resize(n);
  space.first_point.assign(n + 1, 0);
  std::vector<int> voxel_of_point(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint& point = points[i];
    const VoxelGrid::Cell cell = space.grid.CellOf(point.a_N);
    const int v = space.grid.NumberOf(cell);
    AxisVoxel& voxel = space.voxels[static_cast<std::size_t>(v)];
    voxel.cell = cell;
    voxel.mean_N += point.weight * point.a_N;
    voxel.weight += point.weight;
    voxel_of_point[i] = v;
    ++space.first_point[static_cast<std::size_t>(v) + 1];
  }
  for (AxisVoxel& v : space.voxels) v.mean_N /= v.weight;
  for (std::size_t v = 0; v < n; ++v) space.first_point[v + 1] += space.first_point[v];
  std::vector<int> next(space.first_point.begin(), space.first_point.end() - 1);
  space.points_of_voxels.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    int& at = next[static_cast<std::size_t>(voxel_of_point[i])];
    space.points_of_voxels[static_cast<std::size_t>(at++)] = static_cast<int>(i);
  }
}

/// The middle one of the eigenvalues of a symmetric matrix (closed form).
float MiddleEigenvalue(const Eigen::Matrix3f& m) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(m, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(1);
}

/// Whether the axis points around a voxel form a line rather than a sheet or a cloud.
bool LooksLikeLine(const AxisSpace& space, const AxisVoxel& v) {
  float weight = 0.0f, sx = 0, sy = 0, sz = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  space.grid.ForNeighbours(v.cell, kReach, [&](int k) {
    const AxisVoxel& u = space.voxels[static_cast<std::size_t>(k)];
    const float dx = u.mean_N.x() - v.mean_N.x(), dy = u.mean_N.y() - v.mean_N.y(),
                dz = u.mean_N.z() - v.mean_N.z();
    const float wx = u.weight * dx, wy = u.weight * dy, wz = u.weight * dz;
    weight += u.weight;
    sx += wx;
    sy += wy;
    sz += wz;
    xx += wx * dx;
    xy += wx * dy;
    xz += wx * dz;
    yy += wy * dy;
    yz += wy * dz;
    zz += wz * dz;
  });
  // A voxel beside the axis with a small share of the points around is an outlier.
  if (v.weight < 0.02f * weight) return false;
  const Eigen::Vector3f mean = Eigen::Vector3f(sx, sy, sz) / weight;
  Eigen::Matrix3f covariance;
  covariance << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  covariance = covariance / weight - mean * mean.transpose();
  return MiddleEigenvalue(covariance) < kLargestSpread_m * kLargestSpread_m;
}

void FindComponents(AxisSpace& space, Parallelism parallelism) {
  constexpr int kCandidate = -2;
  constexpr int kPerPiece = 1024;
  const int n = static_cast<int>(space.voxels.size());
  ParallelFor((n + kPerPiece - 1) / kPerPiece, parallelism, [&](int piece, int) {
    for (int i = piece * kPerPiece; i < std::min(n, (piece + 1) * kPerPiece); ++i) {
      AxisVoxel& v = space.voxels[static_cast<std::size_t>(i)];
      if (v.weight >= kLightest && LooksLikeLine(space, v)) v.component = kCandidate;
    }
  });
  std::vector<int> stack;
  for (int seed = 0; seed < n; ++seed) {
    if (space.voxels[static_cast<std::size_t>(seed)].component != kCandidate) continue;
    const int component = static_cast<int>(space.components.size());
    space.components.emplace_back();
    stack.assign(1, seed);
    space.voxels[static_cast<std::size_t>(seed)].component = component;
    while (!stack.empty()) {
      const int k = stack.back();
      stack.pop_back();
      space.components.back().push_back(k);
      space.grid.ForNeighbours(space.voxels[static_cast<std::size_t>(k)].cell, 1, [&](int m) {
        AxisVoxel& u = space.voxels[static_cast<std::size_t>(m)];
        if (u.component != kCandidate) return;
        u.component = component;
        stack.push_back(m);
      });
    }
  }
}

}  // namespace

AxisSpace BuildAxisSpace(const std::vector<SurfacePoint>& points, Parallelism parallelism) {
  AxisSpace space{
      VoxelGrid(points, kVoxel_m, [](const SurfacePoint& p) { return p.a_N; }), {}, {}, {}, {}};
  FillVoxels(points, space);
  FindComponents(space, parallelism);
  for (auto& component : space.components) std::sort(component.begin(), component.end());
  return space;
}

}  // namespace tubetwin
