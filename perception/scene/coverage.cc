#include "perception/scene/coverage.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

constexpr double kFloorCell_m = 0.010;
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

int CellsAlong(double size_m, double cell_m) {
  return std::max(1, static_cast<int>(std::lround(size_m / cell_m)));
}

/// Cells of a layer at height `z` that no view saw.
UnseenFloor UnseenCells(const std::vector<ViewImage>& views, const Bin& bin, double cell_m,
                        double z) {
  UnseenFloor out;
  out.columns = CellsAlong(bin.size_m[0], cell_m);
  out.rows = CellsAlong(bin.size_m[1], cell_m);
  out.cell_x_m = bin.size_m[0] / out.columns;
  out.cell_y_m = bin.size_m[1] / out.rows;
  for (int j = 0; j < out.rows; ++j) {
    for (int i = 0; i < out.columns; ++i) {
      const Vector3 p_N((i + 0.5) * out.cell_x_m - bin.half_x_m(),
                        (j + 0.5) * out.cell_y_m - bin.half_y_m(), z);
      out.unseen.push_back(SeenByAny(views, p_N) ? 0 : 1);
    }
  }
  return out;
}

double Area(const UnseenFloor& layer) {
  return static_cast<double>(std::count(layer.unseen.begin(), layer.unseen.end(), 1)) *
         layer.cell_x_m * layer.cell_y_m;
}

}  // namespace

Coverage MeasureCoverage(const std::vector<ViewImage>& views, const Bin& bin,
                         Parallelism parallelism) {
  const int layers = std::max(1, static_cast<int>(std::lround(bin.wall_m() / kRoomCell_m)));
  Coverage out;
  std::vector<double> area_m2(static_cast<std::size_t>(layers) + 1, 0.0);
  ParallelFor(layers + 1, parallelism, [&](int k, int) {
    if (k == 0) {
      out.unseen_floor = UnseenCells(views, bin, kFloorCell_m, 0.0);
    } else {
      area_m2[static_cast<std::size_t>(k)] =
          Area(UnseenCells(views, bin, kRoomCell_m, (k - 0.5) / layers * bin.wall_m()));
    }
  });
  out.unseen_floor_m2 = Area(out.unseen_floor);
  for (const double a : area_m2) out.unseen_m3 += a * bin.wall_m() / layers;
  return out;
}

}  // namespace tubetwin
