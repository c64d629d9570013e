#pragma once

#include <string>

#include "planner/motion/path_config.h"
#include "planner/motion/pick_path.h"

namespace tubetwin {

/// Clearance of the fingers to the bin on the way to and from a grasp: pads end 2 mm over the
/// floor.
inline constexpr double kGraspClearance_m = 0.001;

/// Limits of a motion near grasps. `ramp_s`: it reaches its speed in no less than this, so that a
/// held part that swings with that period is at rest behind the ramp; 0: any.
MotionOptions NearGrasp(double speed_m_s, double acceleration_m_s2, double ramp_s = 0.0);

/// Builds a path segment by segment, each of a stage that a word opens.
class PathBuilder {
 public:
  /// `ramp_s` as NearGrasp, of all lines and transfers.
  explicit PathBuilder(const PathConfig& config, double ramp_s = 0.0)
      : config_(config), ramp_s_(ramp_s) {}

  /// What follows belongs to the next stage; the first one is open from the start.
  PathBuilder& NextStage();
  /// The fingers close with `force_N` on what is `held_m` thick.
  PathBuilder& Close(const std::string& label, double force_N, double held_m);
  PathBuilder& Open(const std::string& label, double opening_m);
  PathBuilder& Transfer(const std::string& label, const RigidTransform& X_BE);
  /// A straight line at the approach's speed, or at `speed_m_s`.
  PathBuilder& Line(const std::string& label, const PathGoal& goal, double speed_m_s = 0.0);
  PathBuilder& GuardedLine(const std::string& label, const PathGoal& goal, double speed_m_s,
                           double force_limit_N);
  PathBuilder& Turn(const std::string& label, const Vector3& rotation_B, double speed_rad_s);
  PathBuilder& Pause(const std::string& label, double duration_s);
  PathBuilder& Add(const std::string& label, const MotionOptions& options,
                   decltype(PathSegment::what) what);

  PickPath path() const { return path_; }

 private:
  const PathConfig& config_;
  double ramp_s_;
  int stage_ = 0;
  PickPath path_;
};

}  // namespace tubetwin
