#include "perception/coverage.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

constexpr double kFloorCell_m = 0.005;
constexpr double kRoomCell_m = 0.010;
/// A place is seen when the return behind it is at most this much nearer than the place.
constexpr float kTolerance_m = 0.004f;

bool SeenBy(const ViewImage& view, const Vector3& p_N) {
  const Vector3 p_S = view.X_SN * p_N;
  if (view.width == 0 || p_S.z() <= 0.0) return false;
  const long column = std::lround(view.fx * p_S.x() / p_S.z() + view.cx);
  const long row = std::lround(view.fy * p_S.y() / p_S.z() + view.cy);
  if (column < 0 || row < 0 || column >= view.width || row >= view.height) return false;
  const float z = view.z_far[view.Index(static_cast<int>(column), static_cast<int>(row))];
  return z > static_cast<float>(p_S.z()) - kTolerance_m;  // False without a return.
}

bool SeenByAny(const std::vector<ViewImage>& views, const Vector3& p_N) {
  return std::any_of(views.begin(), views.end(),
                     [&p_N](const ViewImage& view) { return SeenBy(view, p_N); });
}

/// Cells of a layer at height `z` that no view saw; `inset` keeps the centres off the walls.
int UnseenCells(const std::vector<ViewImage>& views, const Bin& bin, double cell_m, double z) {
  const int nx = std::max(1, static_cast<int>(std::lround(bin.size_m[0] / cell_m)));
  const int ny = std::max(1, static_cast<int>(std::lround(bin.size_m[1] / cell_m)));
  int unseen = 0;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const Vector3 p_N((i + 0.5) / nx * bin.size_m[0] - bin.half_x_m(),
                        (j + 0.5) / ny * bin.size_m[1] - bin.half_y_m(), z);
      unseen += !SeenByAny(views, p_N);
    }
  }
  return unseen;
}

double CellArea(const Bin& bin, double cell_m) {
  const double nx = std::max(1L, std::lround(bin.size_m[0] / cell_m));
  const double ny = std::max(1L, std::lround(bin.size_m[1] / cell_m));
  return bin.size_m[0] * bin.size_m[1] / (nx * ny);
}

}  // namespace

Coverage MeasureCoverage(const std::vector<ViewImage>& views, const Bin& bin,
                         Parallelism parallelism) {
  const int layers = std::max(1, static_cast<int>(std::lround(bin.wall_m() / kRoomCell_m)));
  std::vector<int> unseen(static_cast<std::size_t>(layers) + 1, 0);
  ParallelFor(layers + 1, parallelism, [&](int k, int) {
    const auto i = static_cast<std::size_t>(k);
    unseen[i] = k == 0 ? UnseenCells(views, bin, kFloorCell_m, 0.0)
                       : UnseenCells(views, bin, kRoomCell_m, (k - 0.5) / layers * bin.wall_m());
  });
  Coverage out;
  out.unseen_floor_m2 = unseen[0] * CellArea(bin, kFloorCell_m);
  for (std::size_t k = 1; k < unseen.size(); ++k) {
    out.unseen_m3 += unseen[k] * CellArea(bin, kRoomCell_m) * bin.wall_m() / layers;
  }
  return out;
}

}  // namespace tubetwin
