#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/bin.h"

namespace tubetwin {

/// How a cloud's points stand to the bin that they are said to show. Counts of points.
struct BinEvidence {
  std::size_t valid = 0;   ///< All that are measurements.
  std::size_t inside = 0;  ///< On its floor or walls, between them or a tube's length above.
  /// Seen where floor or a wall would hide them: below the floor, or beyond a wall with the line
  /// of sight through it. 0 when S is not where the points were seen from.
  std::size_t through_floor = 0, through_walls = 0;
  BinEvidence& operator+=(const BinEvidence& other);
};

/// Whether S can be where the points were seen from: they lie in front of it, as a scanner sees.
bool SeenFromOrigin(const std::vector<Eigen::Vector3f>& points_S);

/// Where a line of sight passes through a wall.
struct WallCrossing {
  int side = 0;          ///< 0: -x, 1: +x, 2: -y, 3: +y of N.
  double along_m = 0.0;  ///< The other coordinate there.
};
/// The wall between `eye_N` and the point seen, if any.
std::optional<WallCrossing> CrossedWall(const Vector3& eye_N, const Vector3& p_N, const Bin& bin);

/// Whether a point lies below the floor, so that the floor would hide it.
bool IsBelowFloor(const Vector3& p_N, const Bin& bin);

/// Compares the points with the bin at the pose `X_NS`.
BinEvidence CompareWithBin(const std::vector<Eigen::Vector3f>& points_S, const RigidTransform& X_NS,
                           const Bin& bin);

/// A warning for the user when many points are seen through floor or walls: the pose or the size
/// of the bin is wrong. Else empty.
std::string BinWarning(const BinEvidence& evidence);

}  // namespace tubetwin
