#pragma once

#include <vector>

#include "planner/evaluator/rollout_scene.h"

namespace tubetwin {

/// Position along straight legs at a speed, standing still at every waypoint, each leg with
/// half-cosine ramps of 0.15 s (slower when the leg is too short for them). With `turns`, one for
/// each waypoint, the orientation turns evenly on the same share of each leg, which takes as long
/// as the slower of both needs.
class LegProfile {
 public:
  LegProfile(std::vector<Vector3> waypoints, double speed_m_s,
             std::vector<Eigen::Quaterniond> turns = {}, double turn_speed_rad_s = 0.5);
  double duration_s() const { return end_s_.empty() ? 0.0 : end_s_.back(); }
  Vector3 At(double time_s) const;
  Eigen::Quaterniond TurnAt(double time_s) const;
  /// From when on it only goes straight up; duration_s() when it never does.
  double RisingFrom() const;
  /// From when on it is upright, whatever its yaw; 0 when it always is.
  double TurnedOverUntil() const;

 private:
  struct Place {
    std::size_t leg = 0;  ///< The number of legs: at the end.
    double share = 0.0;   ///< Of this leg.
  };
  Place PlaceAt(double time_s) const;

  std::vector<Vector3> waypoints_;
  std::vector<Eigen::Quaterniond> turns_;
  std::vector<double> end_s_;                 ///< Of each leg.
  std::vector<double> length_m_, speed_m_s_;  ///< A turn counts as the way that takes as long.
};

struct RolloutOutcome {
  CandidateScore::Status status = CandidateScore::Status::kDone;
  double displacement_m = 0.0;
  bool extra = false;     ///< Another tube is over the rim.
  bool given_up = false;  ///< Ended because of its displacement, which would have grown.
  double sim_s = 0.0;
};

/// Moves tube `index` of a settled scene. `model` and `data` are the calling thread's own: a model
/// of the same layout, overwritten here, and data made from it.
RolloutOutcome RollOut(const RolloutScene& scene, int index, double grip_share,
                       const CandidateMotion& motion, bool full, const EvaluatorConfig& config,
                       mjModel& model, mjData& data);

}  // namespace tubetwin
