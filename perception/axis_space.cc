#include "perception/axis_space.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Eigenvalues>

namespace tubetwin {
namespace {

constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
/// Least weight of a voxel: a tube's axis collects some forty points per voxel and view.
constexpr float kLightest = 3.0f;
/// Voxels around one that are looked at for its line, and the largest spread across that line:
/// views that disagree by a millimetre stay below, a sheet of axis points (a plane's) does not.
constexpr int kReach = 3;
constexpr float kLargestSpread_m = 0.0018f;

std::uint64_t KeyOf(int ix, int iy, int iz) {
  constexpr int kOffset = 1 << 20;
  return (static_cast<std::uint64_t>(ix + kOffset) << 42) |
         (static_cast<std::uint64_t>(iy + kOffset) << 21) |
         static_cast<std::uint64_t>(iz + kOffset);
}

std::size_t HashOf(std::uint64_t key) {
  key ^= key >> 31;
  key *= 0x9E3779B97F4A7C15ull;
  return static_cast<std::size_t>(key ^ (key >> 29));
}

}  // namespace

VoxelIndex::VoxelIndex() : keys_(1 << 12, kEmpty), values_(1 << 12, -1) {}

int VoxelIndex::Find(int ix, int iy, int iz) const {
  const std::uint64_t key = KeyOf(ix, iy, iz);
  const std::size_t mask = keys_.size() - 1;
  for (std::size_t i = HashOf(key) & mask;; i = (i + 1) & mask) {
    if (keys_[i] == key) return values_[i];
    if (keys_[i] == kEmpty) return -1;
  }
}

int VoxelIndex::Insert(int ix, int iy, int iz) {
  if (2 * static_cast<std::size_t>(count_) >= keys_.size()) Grow();
  const std::uint64_t key = KeyOf(ix, iy, iz);
  const std::size_t mask = keys_.size() - 1;
  for (std::size_t i = HashOf(key) & mask;; i = (i + 1) & mask) {
    if (keys_[i] == key) return values_[i];
    if (keys_[i] == kEmpty) {
      keys_[i] = key;
      return values_[i] = count_++;
    }
  }
}

void VoxelIndex::Grow() {
  std::vector<std::uint64_t> keys(keys_.size() * 2, kEmpty);
  std::vector<int> values(keys.size(), -1);
  const std::size_t mask = keys.size() - 1;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    if (keys_[k] == kEmpty) continue;
    std::size_t i = HashOf(keys_[k]) & mask;
    while (keys[i] != kEmpty) i = (i + 1) & mask;
    keys[i] = keys_[k];
    values[i] = values_[k];
  }
  keys_.swap(keys);
  values_.swap(values);
}

namespace {

void FillVoxels(const std::vector<SurfacePoint>& points, AxisSpace& space) {
  constexpr float kPerMetre = static_cast<float>(1.0 / kVoxel_m);
  space.voxel_of_point.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f& a = points[i].a_N;
    const int ix = static_cast<int>(std::floor(a.x() * kPerMetre));
    const int iy = static_cast<int>(std::floor(a.y() * kPerMetre));
    const int iz = static_cast<int>(std::floor(a.z() * kPerMetre));
    const int v = space.index.Insert(ix, iy, iz);
    if (v == static_cast<int>(space.voxels.size())) {
      space.voxels.push_back({ix, iy, iz});
    }
    AxisVoxel& voxel = space.voxels[static_cast<std::size_t>(v)];
    voxel.mean_N += points[i].weight * a;
    voxel.weight += points[i].weight;
    space.voxel_of_point[i] = v;
  }
  for (AxisVoxel& v : space.voxels) v.mean_N /= v.weight;
}

/// Calls `visit(voxel)` for every voxel within `reach` cells, the own one included.
template <class Visit>
void ForNeighbours(const AxisSpace& space, const AxisVoxel& v, int reach, Visit visit) {
  for (int dz = -reach; dz <= reach; ++dz) {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const int k = space.index.Find(v.ix + dx, v.iy + dy, v.iz + dz);
        if (k >= 0) visit(k);
      }
    }
  }
}

/// Whether the axis points around a voxel form a line rather than a sheet or a cloud.
bool LooksLikeLine(const AxisSpace& space, const AxisVoxel& v) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  float weight = 0.0f;
  ForNeighbours(space, v, kReach, [&](int k) {
    const AxisVoxel& u = space.voxels[static_cast<std::size_t>(k)];
    const Eigen::Vector3f d = u.mean_N - v.mean_N;
    sum += u.weight * d;
    squares.noalias() += u.weight * d * d.transpose();
    weight += u.weight;
  });
  // A voxel beside the axis with a small share of the points around is an outlier.
  if (v.weight < 0.02f * weight) return false;
  const Eigen::Vector3f mean = sum / weight;
  const Eigen::Matrix3f covariance = squares / weight - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(covariance, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(1) < kLargestSpread_m * kLargestSpread_m;
}

void FindComponents(AxisSpace& space) {
  constexpr int kCandidate = -2;
  for (AxisVoxel& v : space.voxels) {
    if (v.weight >= kLightest && LooksLikeLine(space, v)) v.component = kCandidate;
  }
  std::vector<int> stack;
  for (std::size_t seed = 0; seed < space.voxels.size(); ++seed) {
    if (space.voxels[seed].component != kCandidate) continue;
    const int component = static_cast<int>(space.components.size());
    space.components.emplace_back();
    stack.assign(1, static_cast<int>(seed));
    space.voxels[seed].component = component;
    while (!stack.empty()) {
      const int k = stack.back();
      stack.pop_back();
      space.components.back().push_back(k);
      ForNeighbours(space, space.voxels[static_cast<std::size_t>(k)], 1, [&](int m) {
        AxisVoxel& u = space.voxels[static_cast<std::size_t>(m)];
        if (u.component != kCandidate) return;
        u.component = component;
        stack.push_back(m);
      });
    }
  }
}

}  // namespace

AxisSpace BuildAxisSpace(const std::vector<SurfacePoint>& points) {
  AxisSpace space;
  FillVoxels(points, space);
  FindComponents(space);
  for (auto& component : space.components) std::sort(component.begin(), component.end());
  return space;
}

}  // namespace tubetwin
