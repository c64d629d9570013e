#pragma once

#include <cstddef>
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

/// Whether S can be where the points were seen from: they lie in front of it, as MakeViewRaster
/// asks.
bool SeenFromOrigin(const std::vector<Eigen::Vector3f>& points_S);

/// Whether a point seen from `eye_N` could be seen there with the bin in place.
enum class LineOfSight { kFree, kThroughFloor, kThroughWall };
LineOfSight JudgeLineOfSight(const Vector3& eye_N, const Vector3& p_N, const Bin& bin);

/// Compares the points with the bin at the pose `X_NS`.
BinEvidence CompareWithBin(const std::vector<Eigen::Vector3f>& points_S, const RigidTransform& X_NS,
                           const Bin& bin);

/// A warning for the user when many points are seen through floor or walls: the pose or the size
/// of the bin is wrong. Else empty.
std::string BinWarning(const BinEvidence& evidence);

}  // namespace tubetwin
