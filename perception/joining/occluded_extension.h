#pragma once

#include <vector>

#include "perception/joining/bridges.h"
#include "perception/scene/near_lines.h"

namespace tubetwin {

/// Ways on from fragments' open ends through what was not seen. Keeps references: fragments and
/// space must outlive it. Thread safe.
class HiddenWays {
 public:
  HiddenWays(const std::vector<Fragment>& fragments, const HiddenSpace& space);

  /// The way on from `end` (2 * fragment + end), at most `wanted_m` long, nodes kNodeStep_m apart,
  /// the end itself left out: bent on as the end is, else less bent, straight or, if `turning`,
  /// turning somehow: the first of these that is as long as wanted, or clearly the longest. Empty
  /// for a closed end or one that stops in plain sight, at another fragment, floor or wall.
  Polyline Find(int end, double wanted_m, bool turning) const;

 private:
  Polyline Follow(const FragmentEnd& end, int fragment, const Vector3& bend_N,
                  double wanted_m) const;

  const std::vector<Fragment>& fragments_;
  const HiddenSpace& space_;
  NearLines lines_;
};

/// How long the way on from every end (2 * fragment + end) can be, `longest_m` at most.
std::vector<double> MeasureRooms(const std::vector<Fragment>& fragments, const HiddenSpace& space,
                                 double longest_m);

}  // namespace tubetwin
