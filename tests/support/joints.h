#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "models/arm/arm.h"

namespace tubetwin {

/// The largest difference of a joint, whole turns aside, rad.
inline double LargestDifference(const JointVector& a, const JointVector& b) {
  double largest = 0;
  for (int i = 0; i < kNumJoints; ++i) {
    largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], 2 * kPi)));
  }
  return largest;
}

/// Whether one of `all` is `q` within the tolerance, whole turns aside.
inline bool Holds(const std::vector<JointVector>& all, const JointVector& q, double tolerance_rad) {
  return std::any_of(all.begin(), all.end(), [&](const JointVector& other) {
    return LargestDifference(q, other) < tolerance_rad;
  });
}

}  // namespace tubetwin
