#pragma once

#include <array>
#include <vector>

#include "models/base/frames.h"

namespace tubetwin {

/// A small piece of an upright surface, in the frame P of a floor's plane (z up).
struct WallPatch {
  Vector3 p_P;
  Eigen::Vector2d facing;  ///< Unit, horizontal, to the side that it was seen from.
};

/// Finds the pieces of plane, upright surfaces among points over the floor: walls, hardly ever
/// tubes. `eye_P` of each point, which must be known.
std::vector<WallPatch> FindWallPatches(const std::vector<Vector3>& points_P,
                                       const std::vector<Vector3>& eyes_P);

/// A wall as it is seen from above.
struct WallLine {
  int direction = 0;             ///< It faces along yaw + 90 degrees times this, 0 .. 3.
  double offset_m = 0.0;         ///< Of its points along that direction, from P's origin.
  double low_m = 0, high_m = 0;  ///< Its extent along yaw + 90 degrees times (direction + 1).
  double top_m = 0.0;            ///< Height that its patches reach.
  int patches = 0;
};

/// Walls that stand parallel or square to each other.
struct WallLines {
  double yaw_rad = 0.0;  ///< 0 .. pi/2
  std::vector<WallLine> lines;
};

/// The yaw that most patches agree on and the lines that they form, strongest first for each
/// direction. Lines shorter than 5 cm or lower than `lowest_top_m` are left out.
WallLines FindWallLines(const std::vector<WallPatch>& patches, double lowest_top_m);

/// Unit vector of direction 0 .. 3 at a yaw.
Eigen::Vector2d DirectionOf(double yaw_rad, int direction);

}  // namespace tubetwin
