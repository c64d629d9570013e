#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/bin.h"
#include "perception/view/floor_plane.h"
#include "perception/view/wall_lines.h"

namespace tubetwin {

/// What is seen over a plane that may be a bin's floor, in the plane's frame P (z up).
struct BinView {
  RigidTransform X_CP = RigidTransform::Identity();
  std::vector<Vector3> p_P, eye_P;  ///< Points and where each was seen from.
  std::vector<char> eye_known;      ///< 0: eye_P is a guess, good for which side a wall shows.
  struct Walls {
    std::vector<WallPatch> patches;
    WallLines lines;
  } walls;
};

/// One way to lay the bin on the walls, and what speaks against it.
struct BinFit {
  RigidTransform X_NP = RigidTransform::Identity();
  std::array<bool, 4> seen_walls{};  ///< -x, +x, -y, +y.
  bool shows_size = false;           ///< One of its sides is seen to be as long as the bin's.
  double seen_floor = 0.0;           ///< Of the bin's floor, m^2.
  double below_floor = 0.0;          ///< Share of the points.
  double seen_through_m = 0.0;       ///< Of the walls' length, where they hide nothing.
  std::string
      odd;  ///< What else is wrong: a wall inside, or higher than the bin's; empty: nothing.
};

/// Upright surfaces over the plane, as patches and lines.
BinView::Walls WallsOf(const BinView& view, const Bin& bin);

/// FewWalls of no wall at all.
inline constexpr const char* kNoWall = "a floor is seen, but no wall of a bin on it";
/// Why the walls do not fix the bin's place; empty when there are two square to each other.
std::string FewWalls(const BinView::Walls& walls);

/// All ways to lay the bin's rectangle on the walls, refined.
std::vector<BinFit> FitBin(const BinView& view, const Bin& bin);

/// Least floor of the bin that must be seen, m^2.
double LeastSeenFloor(const Bin& bin);

/// Whether nothing speaks against a fit.
bool IsSound(const BinFit& fit, const Bin& bin);

/// The side whose inner face shows along `facing_N`: 0 (-x), 1 (+x), 2 (-y), 3 (+y); 4: none.
std::size_t SideFacing(const Eigen::Vector2d& facing_N);

/// The walls' names after N was turned about z by a multiple of 90 degrees: p_new = turn * p_old.
std::array<bool, 4> TurnedWalls(const std::array<bool, 4>& walls, const RigidTransform& turn);

}  // namespace tubetwin
