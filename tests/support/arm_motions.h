#pragma once

#include <utility>
#include <variant>

#include "hw_bridge/cell/cell.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {

/// Encoders and servos of real arms stand this near to where they were sent.
inline constexpr double kStanding_rad = 0.002;

/// The trajectory, which the first cell's arm must be able to follow.
inline CheckedTrajectory Checked(JointTrajectory trajectory) {
  const auto checked = CheckTrajectory(PaperCell().arm, std::move(trajectory));
  if (const auto* why = std::get_if<TrajectoryRejection>(&checked)) FAIL(why->reason);
  return std::get<CheckedTrajectory>(checked);
}

/// There within `duration_s`, at rest at both ends.
inline CheckedTrajectory Moved(const JointVector& from, const JointVector& by, double duration_s) {
  TrajectoryPoint a, b;
  a.q = from;
  b.q = from + by;
  b.time_s = duration_s;
  return Checked({{a, b}});
}

/// All joints by as much.
inline CheckedTrajectory Moved(const JointVector& from, double by_rad, double duration_s) {
  return Moved(from, JointVector(by_rad * JointVector::Ones()), duration_s);
}

/// The largest difference of a joint, rad.
inline double Farthest(const JointVector& a, const JointVector& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace tubetwin::test
