#pragma once

#include <vector>

#include <Eigen/Dense>

#include "models/base/time.h"

namespace tubetwin {

inline constexpr int kNumJoints = 6;
/// One number per arm joint, in the vendor's order S L U R B T.
using JointVector = Eigen::Matrix<double, kNumJoints, 1>;

/// One sample of a joint trajectory. Radians and derivatives; time from the trajectory's start.
struct TrajectoryPoint {
  double time_s = 0.0;
  JointVector q = JointVector::Zero();
  JointVector qd = JointVector::Zero();
  JointVector qdd = JointVector::Zero();
};

/// Timed joint points, time strictly increasing from 0, first and last at rest. Between points the
/// receiver interpolates by the cubic through position and velocity at both ends.
struct JointTrajectory {
  std::vector<TrajectoryPoint> points;
  double duration_s() const { return points.empty() ? 0.0 : points.back().time_s; }
};

/// Cubic Hermite sample of `trajectory` at `time_s` (clamped to its ends).
/// Precondition: at least one point.
TrajectoryPoint Sample(const JointTrajectory& trajectory, double time_s);

}  // namespace tubetwin
