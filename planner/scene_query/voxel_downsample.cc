#include "planner/scene_query/voxel_downsample.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"

namespace tubetwin {

std::vector<Vector3> VoxelDownsample(const std::vector<OrganizedCloud>& views, const Bin& bin,
                                     double cube_m, double top_m) {
  TT_CHECK(cube_m > 0.0 && top_m > 0.0);
  constexpr float kOff_m = 0.003f;  // Floor, walls and their noise are no obstacles of their own.
  const float x_max = static_cast<float>(bin.half_x_m()) - kOff_m;
  const float y_max = static_cast<float>(bin.half_y_m()) - kOff_m;
  const float z_max = static_cast<float>(top_m);
  const float per_m = static_cast<float>(1.0 / cube_m);
  const int nx = static_cast<int>(std::ceil(2.0 * x_max * per_m)) + 1;
  const int ny = static_cast<int>(std::ceil(2.0 * y_max * per_m)) + 1;
  const int nz = static_cast<int>(std::ceil(z_max * per_m)) + 1;

  std::vector<char> taken(static_cast<std::size_t>(nx) * ny * nz, 0);
  std::vector<Eigen::Vector3f> first;
  std::vector<std::size_t> cubes;
  for (const OrganizedCloud& view : views) {
    const Eigen::Isometry3f X_NS = view.X_NS.cast<float>();
    for (const Eigen::Vector3f& p_SP : view.p_SP) {
      if (!IsValid(p_SP)) continue;
      const Eigen::Vector3f p = X_NS * p_SP;
      if (std::abs(p.x()) > x_max || std::abs(p.y()) > y_max || p.z() < kOff_m || p.z() > z_max) {
        continue;
      }
      const int ix = static_cast<int>((p.x() + x_max) * per_m);
      const int iy = static_cast<int>((p.y() + y_max) * per_m);
      const int iz = static_cast<int>(p.z() * per_m);
      const std::size_t cube = (static_cast<std::size_t>(iz) * ny + iy) * nx + ix;
      if (taken[cube]) continue;
      taken[cube] = 1;
      cubes.push_back(cube);
      first.push_back(p);
    }
  }
  // In the order of cubes: the result then hardly depends on the order of the views.
  std::vector<std::size_t> order(cubes.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return cubes[a] < cubes[b]; });
  std::vector<Vector3> points;
  points.reserve(order.size());
  for (const std::size_t k : order) points.push_back(first[k].cast<double>());
  return points;
}

}  // namespace tubetwin
