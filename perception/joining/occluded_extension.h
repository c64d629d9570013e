#pragma once

#include <vector>

#include "perception/joining/bridges.h"
#include "perception/scene/near_lines.h"

namespace tubetwin {

/// Where a tube can continue beyond the end of a fragment without contradicting any view: through
/// space that is occluded or that no view covers. Keeps references: fragments and space must
/// outlive it. Thread safe.
class OccludedExtensions {
 public:
  OccludedExtensions(const std::vector<Fragment>& fragments, const OccludedSpace& space);

  /// The extension of `end` (2 * fragment + end): nodes kNodeStep_m apart, the end itself left out,
  /// at most `wanted_m` long. Tried in this order: with the curvature of the end, with half of it,
  /// straight, and, if `any_direction`, along circles of several curvatures to all sides. The first
  /// that reaches `wanted_m` is taken; if none does, the longest, where a later one must be clearly
  /// longer than an earlier one. Empty where the tube visibly ends (its cap is seen), and where
  /// another fragment, the floor or a wall stops it at once.
  Polyline Find(int end, double wanted_m, bool any_direction) const;

 private:
  Polyline Follow(const FragmentEnd& end, int fragment, const Vector3& bend_N,
                  double wanted_m) const;

  const std::vector<Fragment>& fragments_;
  const OccludedSpace& space_;
  NearLines lines_;
};

/// Length of the longest extension of every end (2 * fragment + end), `longest_m` at most.
std::vector<double> MaxOccludedExtensions(const std::vector<Fragment>& fragments,
                                          const OccludedSpace& space, double longest_m);

}  // namespace tubetwin
