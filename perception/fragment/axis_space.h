#pragma once

#include <optional>
#include <vector>

#include "models/base/parallel.h"
#include "perception/fragment/axis_points.h"
#include "perception/view/voxel_grid.h"

namespace tubetwin {

/// Edge of the voxels in which axis points are averaged.
inline constexpr double kVoxel_m = 0.0025;

struct AxisVoxel {
  VoxelGrid::Cell cell{};
  Eigen::Vector3f mean_N = Eigen::Vector3f::Zero();
  float weight = 0.0f;  ///< Sum of the weights of its points.
  int component = -1;   ///< -1: no tube axis passes here.
};

/// The axis points of all views, averaged in voxels, and the connected components of the voxels
/// that look like a curve. Components separate tubes well: where the surfaces of two tubes touch,
/// their axes are still two radii apart.
struct AxisSpace {
  VoxelGrid grid;
  std::vector<AxisVoxel> voxels;             ///< As the grid numbers them.
  std::vector<std::vector<int>> components;  ///< Voxels of each, ascending.
  /// Points of voxel v: points_of_voxels[first_point[v]] .. [first_point[v + 1]), ascending.
  std::vector<int> first_point, points_of_voxels;
};
AxisSpace BuildAxisSpace(const std::vector<SurfacePoint>& points, Parallelism parallelism);

}  // namespace tubetwin
