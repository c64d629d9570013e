#include "perception/view/bin_size.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tubetwin {
namespace {

/// Walls that face each other over less are no bin's.
constexpr double kCommon_m = 0.12;
/// Distance of two walls that is another than the bin's.
constexpr double kOtherSize_m = 0.005;
/// A wall this close to where the bin's would be, by a pose that may be a little off, is the bin's.
constexpr double kInPlace_m = 0.006;

}  // namespace

std::string WrongSize(const BinView::Walls& walls, const Bin& bin) {
  for (const WallLine& a : walls.lines.lines) {
    for (const WallLine& b : walls.lines.lines) {
      const double apart_m = -b.offset_m - a.offset_m;
      // Their extents along run against each other.
      const double common_m = std::min(a.high_m, -b.low_m) - std::max(a.low_m, -b.high_m);
      if (b.direction != a.direction + 2 || apart_m < 0.05 || common_m < kCommon_m) continue;
      if (std::abs(apart_m - bin.size_m[0]) > kOtherSize_m &&
          std::abs(apart_m - bin.size_m[1]) > kOtherSize_m) {
        char text[80];
        std::snprintf(text, sizeof text, "two walls %.3f m apart are seen", apart_m);
        return text;
      }
    }
  }
  return {};
}

BinView::Walls WithoutSides(const BinView::Walls& walls, const Bin& bin) {
  std::array<bool, 2> in_place{};
  const auto side_of = [&](const WallLine& line) {
    return SideFacing(DirectionOf(walls.lines.yaw_rad, line.direction));
  };
  for (const WallLine& line : walls.lines.lines) {
    const std::size_t side = side_of(line);
    if (side > 3) continue;
    const double half_m = side < 2 ? bin.half_x_m() : bin.half_y_m();
    in_place[side / 2] |= std::abs(-line.offset_m - half_m) < kInPlace_m;
  }
  BinView::Walls out = walls;
  std::erase_if(out.lines.lines, [&](const WallLine& line) {
    const std::size_t side = side_of(line);
    return side > 3 || in_place[side / 2];
  });
  return out;
}

}  // namespace tubetwin
