#pragma once

#include <string>
#include <variant>

#include "models/arm/arm.h"
#include "models/base/joint.h"

namespace tubetwin {

/// Why and where a trajectory was refused.
struct TrajectoryRejection {
  std::string reason;   ///< "joint 3 at 181.2 degrees, limit 178.0"
  double time_s = 0.0;  ///< Where along it.
  int joint = -1;       ///< 0-based, -1 when it is no single joint's fault.
};

/// A joint trajectory whose every sample keeps the arm's position, speed and acceleration limits
/// and starts and ends at rest. Only CheckTrajectory makes one, so that no device ever sees
/// anything else.
class CheckedTrajectory {
 public:
  const JointTrajectory& trajectory() const { return trajectory_; }
  double duration_s() const { return trajectory_.duration_s(); }
  /// The same path, `factor` times as long: within the same limits. Precondition: factor >= 1.
  CheckedTrajectory Stretched(double factor) const;

 private:
  friend std::variant<CheckedTrajectory, TrajectoryRejection> CheckTrajectory(const ArmModel&,
                                                                              JointTrajectory);
  explicit CheckedTrajectory(JointTrajectory t) : trajectory_(std::move(t)) {}
  JointTrajectory trajectory_;
};

/// Checks limits at every point and, through the cubic, between them; times increase; both ends at
/// rest. Collisions are checked where the motion is planned (planner/motion).
std::variant<CheckedTrajectory, TrajectoryRejection> CheckTrajectory(const ArmModel& arm,
                                                                     JointTrajectory trajectory);

}  // namespace tubetwin
