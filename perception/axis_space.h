#pragma once

#include <cstdint>
#include <vector>

#include "perception/axis_points.h"

namespace tubetwin {

/// Edge of the voxels in which axis points are averaged.
inline constexpr double kVoxel_m = 0.0025;

/// Integer cell coordinates to an index, in the order of first use (independent of hashing).
class VoxelIndex {
 public:
  VoxelIndex();
  /// Index of the cell, or -1.
  int Find(int ix, int iy, int iz) const;
  /// Index of the cell, which is added when new.
  int Insert(int ix, int iy, int iz);
  int size() const { return count_; }

 private:
  void Grow();
  std::vector<std::uint64_t> keys_;
  std::vector<int> values_;
  int count_ = 0;
};

struct AxisVoxel {
  int ix = 0, iy = 0, iz = 0;
  Eigen::Vector3f mean_N = Eigen::Vector3f::Zero();
  float weight = 0.0f;  ///< Sum of the weights of its points.
  int component = -1;   ///< -1: no tube axis passes here.
};

/// All axis points of all views in voxels, and the connected components of those that look like a
/// curve: surfaces of touching tubes touch, but their axes stay two radii apart.
struct AxisSpace {
  VoxelIndex index;
  std::vector<AxisVoxel> voxels;
  std::vector<int> voxel_of_point;           ///< [points]
  std::vector<std::vector<int>> components;  ///< Voxels of each, ascending.
};
AxisSpace BuildAxisSpace(const std::vector<SurfacePoint>& points);

}  // namespace tubetwin
