#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/text.h"
#include "scenes/pile.h"

namespace tubetwin {
namespace {

constexpr double kStep_m = 0.005;  // A quarter of a wall's thickness.
constexpr double kHighest_m =
    1.0;  // Over the rim: from there tubes may fall; what is higher is a mistake.
constexpr double kTouching_m = 1e-6;  // An axis in the face of a wall or floor is not within it.

/// Where a point lies, seen from the bin.
struct PlaceInBin {
  double beyond_m;  ///< Beyond the inner face of the nearest wall; negative: between the walls.
  double under_m;   ///< Under the floor, or beside the bin under the table that it stands on.
  bool in_wall;
};

PlaceInBin PlaceOf(const Vector3& p_N, const Bin& bin) {
  const double t = Bin::kWallThickness_m;
  const double beyond_m =
      std::max(std::abs(p_N.x()) - bin.half_x_m(), std::abs(p_N.y()) - bin.half_y_m());
  const bool over_bin = beyond_m < t;
  const bool in_wall =
      over_bin && beyond_m > kTouching_m && p_N.z() >= 0.0 && p_N.z() < bin.wall_m();
  return {beyond_m, over_bin ? -p_N.z() : -p_N.z() - t, in_wall};
}

/// From the inner rectangle of the bin, in x and y.
double Outside(const Vector3& p_N, const Bin& bin) {
  return std::hypot(std::max(0.0, std::abs(p_N.x()) - bin.half_x_m()),
                    std::max(0.0, std::abs(p_N.y()) - bin.half_y_m()));
}

std::string At(const Vector3& p_N) {
  const auto rounded = [](double v) { return Number(std::round(1e4 * v) / 1e4); };
  return "(" + rounded(p_N.x()) + ", " + rounded(p_N.y()) + ", " + rounded(p_N.z()) + ") m";
}

std::string Far(double distance_m) { return Number(std::round(1e4 * distance_m) / 1e4) + " m"; }

/// What is wrong with where a tube lies; empty: nothing.
std::string Misplaced(const PileTube& tube, const Bin& bin) {
  const Polyline points_N = Resample(tube.centerline_N, kStep_m);
  Vector3 middle_N = Vector3::Zero();
  for (const Vector3& p : points_N) middle_N += p / static_cast<double>(points_N.size());
  if (const double outside_m = Outside(middle_N, bin); outside_m > kTouching_m) {
    return "its middle is at " + At(middle_N) + ", " + Far(outside_m) + " outside the bin";
  }
  const Vector3 *lowest = nullptr, *in_wall = nullptr;
  double under_m = kTouching_m, beyond_m = 0.0;
  for (const Vector3& p : points_N) {
    const PlaceInBin place = PlaceOf(p, bin);
    if (place.under_m > under_m) {
      under_m = place.under_m;
      lowest = &p;
    }
    if (place.in_wall && place.beyond_m >= beyond_m) {
      beyond_m = place.beyond_m;
      in_wall = &p;
    }
  }
  if (lowest != nullptr) {
    return "its axis is inside the bin's floor or under it at " + At(*lowest) + ", " +
           Far(under_m) + " too low";
  }
  const auto by_height = [](const Vector3& a, const Vector3& b) { return a.z() < b.z(); };
  const Vector3& bottom = *std::min_element(points_N.begin(), points_N.end(), by_height);
  if (const double over_rim_m = bottom.z() - bin.wall_m(); over_rim_m > kHighest_m) {
    return "its lowest point is " + Far(over_rim_m) + " over the bin's rim at " + At(bottom) +
           ", more than " + Far(kHighest_m);
  }
  if (in_wall != nullptr) {
    return "its axis is inside the bin's wall at " + At(*in_wall) + ", " + Far(beyond_m) +
           " beyond its inner face";
  }
  return "";
}

[[noreturn]] void Refuse(const std::string& source, std::size_t index, int id,
                         const std::string& problem, const Bin& bin) {
  const auto& size_m = bin.size_m;
  throw Error(
      ErrorKind::kBadData,
      source + ": tubes[" + std::to_string(index) + "] (id " + std::to_string(id) +
          "): " + problem + "\nallowed: tubes in the bin, " + Number(size_m[0]) + " x " +
          Number(size_m[1]) + " x " + Number(size_m[2]) +
          " m, above its floor and clear of its walls (frame: the bin's, from the middle of "
          "its floor; another bin: --bin)");
}

}  // namespace

void RequireInBin(const Pile& pile, const std::string& source) {
  for (std::size_t i = 0; i < pile.tubes.size(); ++i) {
    const std::string problem = Misplaced(pile.tubes[i], pile.bin);
    if (!problem.empty()) Refuse(source, i, pile.tubes[i].id, problem, pile.bin);
  }
}

}  // namespace tubetwin
