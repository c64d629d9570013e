#include "perception/view/view_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tubetwin {
namespace {

/// Nearer places are inside the scanner.
constexpr double kInside_m = 0.05;

}  // namespace

Visibility QueryVisibility(const ViewImage& view, const Vector3& p_NC, double radius_m,
                           double slack_m) {
  if (view.width == 0) return Visibility::kOutside;
  const Vector3 p_SC = view.X_SN * p_NC;
  if (p_SC.z() < kInside_m) return Visibility::kOutside;
  const long column = std::lround(view.fx * p_SC.x() / p_SC.z() + view.cx);
  const long row = std::lround(view.fy * p_SC.y() / p_SC.z() + view.cy);
  if (column < 1 || row < 1 || column + 1 >= view.width || row + 1 >= view.height) {
    return Visibility::kOutside;
  }
  // The nearest depth of the 3 x 3 cells: beside an edge the farther one must not count as seeing
  // through.
  float z = std::numeric_limits<float>::infinity();
  int returns = 0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const float near =
          view.z_near[view.Index(static_cast<int>(column) + i, static_cast<int>(row) + j)];
      if (!(near == near)) continue;
      ++returns;
      z = std::min(z, near);
    }
  }
  if (returns < 3) return Visibility::kUnknown;
  const double along = p_SC.z() / p_SC.norm();
  const double surface = p_SC.z() - radius_m * along;
  if (z > surface + slack_m * along) return Visibility::kSeenThrough;
  return z < surface - slack_m * along ? Visibility::kHidden : Visibility::kSurface;
}

}  // namespace tubetwin
