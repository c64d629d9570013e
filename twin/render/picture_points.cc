#include "twin/render/picture_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr double kFloorBand_m = 0.004;  // The floor with its noise.
constexpr double kFine_m = 0.006, kFloor_m = 0.024;
constexpr double kMargin_m = 0.02, kTop_m = 0.30;  // Around the bin, over its floor.

bool IsNear(const Vector3& p_NP, const Bin& bin) {
  return std::abs(p_NP.x()) < 0.5 * bin.size_m[0] + kMargin_m &&
         std::abs(p_NP.y()) < 0.5 * bin.size_m[1] + kMargin_m && p_NP.z() > -kMargin_m &&
         p_NP.z() < kTop_m;
}

/// Every so many rows and columns are read, so that about kRead points of all views are: still
/// several for each fine cell.
int StepOf(const std::vector<OrganizedCloud>& views) {
  constexpr double kRead = 150'000.0;
  std::size_t all = 0;
  for (const OrganizedCloud& view : views) all += view.size();
  return std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(all) / kRead))));
}

std::vector<Vector3> Downsample(const std::vector<OrganizedCloud>& views, const Bin& bin,
                                double scale) {
  const int step = StepOf(views);
  std::set<std::array<int, 4>> taken;
  std::vector<Vector3> out;
  const auto add = [&](const Vector3& p_NP) {
    const bool floor = p_NP.z() < kFloorBand_m;
    const double cell_m = scale * (floor ? kFloor_m : kFine_m);
    const auto index = [&](double x) { return static_cast<int>(std::floor(x / cell_m)); };
    if (taken.insert({floor ? 1 : 0, index(p_NP.x()), index(p_NP.y()), index(p_NP.z())}).second) {
      out.push_back(p_NP);
    }
  };
  for (const OrganizedCloud& view : views) {
    for (int row = 0; row < view.height; row += step) {
      for (int column = 0; column < view.width; column += step) {
        const Eigen::Vector3f& p_SP =
            view.p_SP[static_cast<std::size_t>(row) * view.width + column];
        if (!IsValid(p_SP)) continue;
        const Vector3 p_NP = view.X_NS * p_SP.cast<double>();
        if (IsNear(p_NP, bin)) add(p_NP);
      }
    }
  }
  return out;
}

}  // namespace

std::vector<Vector3> DownsampleForPicture(const std::vector<OrganizedCloud>& views, const Bin& bin,
                                          int max_points) {
  TT_CHECK(max_points > 0);
  double scale = 1.0;
  std::vector<Vector3> out = Downsample(views, bin, scale);
  while (out.size() > static_cast<std::size_t>(max_points)) {
    scale *= 1.4;  // Half the cells of a surface.
    out = Downsample(views, bin, scale);
  }
  return out;
}

}  // namespace tubetwin
