#include "twin/campaign/thinned_points.h"

#include <array>
#include <cmath>
#include <set>

#include "hw_bridge/base/error.h"

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

/// Also used with whole clouds of a million points: rows and columns are stepped over.
std::vector<Vector3> Thinned(const std::vector<OrganizedCloud>& views, const Bin& bin,
                             double scale) {
  std::set<std::array<int, 4>> taken;
  std::vector<Vector3> out;
  for (const OrganizedCloud& view : views) {
    for (std::size_t i = 0; i < view.size(); i += 3) {
      if (!IsValid(view.p_SP[i])) continue;
      const Vector3 p_NP = view.X_NS * view.p_SP[i].cast<double>();
      if (!IsNear(p_NP, bin)) continue;
      const bool floor = p_NP.z() < kFloorBand_m;
      const double cell_m = scale * (floor ? kFloor_m : kFine_m);
      const auto index = [&](double x) { return static_cast<int>(std::floor(x / cell_m)); };
      if (taken.insert({floor ? 1 : 0, index(p_NP.x()), index(p_NP.y()), index(p_NP.z())}).second) {
        out.push_back(p_NP);
      }
    }
  }
  return out;
}

}  // namespace

std::vector<Vector3> ThinnedPoints(const std::vector<OrganizedCloud>& views, const Bin& bin,
                                   int most) {
  TT_CHECK(most > 0);
  double scale = 1.0;
  std::vector<Vector3> out = Thinned(views, bin, scale);
  while (out.size() > static_cast<std::size_t>(most)) {
    scale *= 1.4;  // Half the cells of a surface.
    out = Thinned(views, bin, scale);
  }
  return out;
}

}  // namespace tubetwin
