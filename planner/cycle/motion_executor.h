#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "hw_bridge/cell/cell.h"
#include "planner/motion/motion_planner.h"

namespace tubetwin {

/// A motion that could not be planned or did not end as asked. Caught by the pick cycle, which
/// turns it into an outcome of the attempt; never leaves the cycle.
class MoveFailure : public std::runtime_error {
 public:
  enum class Kind { kRejected, kFault } kind;
  /// Of a fault, what the cell said; kRejected for a motion that could not be planned.
  WaitOutcome::Status status = WaitOutcome::Status::kRejected;
  MoveFailure(Kind k, const std::string& what) : std::runtime_error(what), kind(k) {}
  MoveFailure(const WaitOutcome& outcome, const std::string& what)
      : std::runtime_error(what + ": " + outcome.reason),
        kind(Kind::kFault),
        status(outcome.status) {}
};

/// Clearance of the fingers to the bin on the way to and from a grasp: pads end 2 mm over the
/// floor.
inline constexpr double kFingerClearance_m = 0.001;

/// Plans motions from where the arm last ended and runs them. Every motion is checked before it
/// starts; one that is rejected moves nothing. Poses are of E in B. Functions throw MoveFailure.
class MotionExecutor {
 public:
  explicit MotionExecutor(Cell& cell);

  RigidTransform X_BE() const;  ///< Where E is, from the joints.
  JointVector q() const;        ///< Where the next motion starts.

  /// Straight up to carry height, over, straight down. `either_yaw`: the goal turned by 180 degrees
  /// will do as well.
  void Transfer(const RigidTransform& X_BE, double speed_m_s, double acceleration_m_s2,
                bool either_yaw = false);
  /// Joint motion to a nearby pose at the same height; over carry height where that is not free.
  void Joint(const RigidTransform& X_BE, bool either_yaw = false);
  void Line(const RigidTransform& X_BE, double speed_m_s, double acceleration_m_s2,
            double finger_clearance_m = kFingerClearance_m);
  /// Straight line that ends at contact. What it felt is the outcome.
  WaitOutcome GuardedLine(const RigidTransform& X_BE, double speed_m_s, double force_limit_N);
  /// Straight legs through poses, stopping at each.
  void Legs(const std::vector<RigidTransform>& X_BE, double speed_m_s, double turn_speed_rad_s,
            double acceleration_m_s2);
  /// About E, which stays where it is. Rotation vector in B, radians.
  void Tilt(const Vector3& rotation_B, double speed_rad_s);

  /// Goes on from where the arm stands now, wherever that is.
  void Resync() { q_ = cell_.arm.State().q; }

  /// Goes on as a executor whose last motion ended at `q`.
  void Resume(const JointVector& q, double opening_m) {
    q_ = q;
    opening_m_ = opening_m;
  }
  double opening_m() const { return opening_m_; }

  const MotionPlanner& planner() const { return planner_; }

  /// Whether the arm can put E there, tool pointing down.
  bool Reaches(const RigidTransform& X_BE) const;

  /// Whether Line to the pose and each Tilt from there would be run.
  bool TiltsFrom(const RigidTransform& X_BE, const std::vector<Vector3>& rotations_B) const;

  /// No motion from now on reaches its speed in less than this: one period of a held part that
  /// swings leaves it at rest behind the ramp. 0: any.
  void SetLeastRamp(double ramp_s) { least_ramp_s_ = ramp_s; }

  /// Opening of the pads from now on, for the clearance of the fingers.
  void SetOpening(double opening_m) { opening_m_ = opening_m; }

 private:
  JointVector Start();
  MotionOptions Options(double speed_m_s, double acceleration_m_s2) const;
  WaitOutcome Run(const MotionResult& planned, const char* what);

  Cell& cell_;
  MotionPlanner planner_;
  double opening_m_ = 0.085;
  double least_ramp_s_ = 0.0;
  JointVector q_;  ///< End of the last motion; the measured joints where one was stopped.
};

}  // namespace tubetwin
