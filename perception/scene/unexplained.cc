#include "perception/scene/unexplained.h"

#include "perception/scene/near_lines.h"
#include "perception/view/voxel_grid.h"

namespace tubetwin {

std::vector<Vector3> FindUnexplained(const std::vector<Eigen::Vector3f>& points_N,
                                     const std::vector<PerceivedTube>& tubes, double radius_m) {
  constexpr double kCell_m = 0.005;
  constexpr int kFewest = 6;
  const VoxelGrid grid(points_N, kCell_m,
                       [](const Eigen::Vector3f& p) -> const Eigen::Vector3f& { return p; });
  std::vector<Eigen::Vector4f> sums(static_cast<std::size_t>(grid.size()),
                                    Eigen::Vector4f::Zero());  // The last one counts.
  for (const Eigen::Vector3f& p : points_N) {
    sums[static_cast<std::size_t>(grid.NumberOf(grid.CellOf(p)))] += p.homogeneous();
  }
  NearLines lines;
  for (const PerceivedTube& tube : tubes) lines.Add(tube.centerline_N);
  const double explained_m = radius_m + 0.004;
  constexpr double kWritten_m = 1e-4;  // Digits that mean something.
  std::vector<Vector3> unexplained_N;
  for (const Eigen::Vector4f& sum : sums) {
    if (sum[3] < kFewest) continue;
    const Vector3 p = sum.hnormalized().cast<double>();
    if (lines.Distance(p, 2.0 * explained_m) > explained_m) {
      unexplained_N.push_back((p / kWritten_m).array().round() * kWritten_m);
    }
  }
  return unexplained_N;
}

}  // namespace tubetwin
