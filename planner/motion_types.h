#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "hw_bridge/base/json_fwd.h"
#include "hw_bridge/base/polyline.h"
#include "models/bin.h"
#include "models/part.h"
#include "perception/tube_scene.h"

namespace tubetwin {

/// What a tube does after it was grasped: relative translations from where it lies, frame N, the
/// first zero. (Rotations come with a later strategy.)
struct CandidateMotion {
  int tube = 0;
  std::string name;                  ///< "up", "escape+", "escape-", ...
  std::vector<Vector3> waypoints_N;  ///< Metres.
  double speed_m_s = 0.25;
  /// Escape: arc length range of the tube that passes under the occluder; no grasp there.
  double forbidden_from_m = 1.0, forbidden_to_m = 0.0;  ///< Empty when from > to.
  /// More such ranges: the gripper would run into another tube there.
  std::vector<std::pair<double, double>> blocked_m;
};

/// One candidate's score (scores.json).
struct CandidateScore {
  int tube = 0;
  std::string motion;
  std::vector<Vector3> waypoints_N;
  double displacement_m = 0.0;  ///< Sum over the other tubes' centres of mass, baseline subtracted.
  double extra_probability = 0.0;  ///< Share of samples in which another tube came along.
  double cost = 0.0;               ///< Lower is better.
  enum class Status { kDone, kJammed, kDiverged, kPruned } status = Status::kDone;
  double sim_s = 0.0, wall_s = 0.0;
  std::vector<double> samples;  ///< Displacement of each sample.
};
const char* ToString(CandidateScore::Status status);

struct EvaluationRequest {
  std::vector<CandidateMotion> candidates;
  /// Arc length on each candidate's tube where the hand holds it.
  std::vector<double> grasp_at_m;
  int samples = 1;
  int first_sample = 0;  ///< Samples first_sample to first_sample + samples - 1 are rolled out.
  bool full = false;     ///< Nothing pruned or cut short.
  std::uint64_t seed = 1;
};

struct EvaluationResult {
  std::vector<CandidateScore> candidates;  ///< In the order of the request.
  int best = -1;                           ///< Index of the lowest cost, -1 when there is none.
  double settle_s = 0.0, wall_s = 0.0;     ///< Wall times.
  int threads = 1;
};
/// scores.json.
Json ToJson(const EvaluationResult& result);
Json ToJson(const CandidateMotion& motion);

/// The pipeline's internal roll-outs, as the planner sees them: perceived tubes in, scores out.
/// planner/evaluator implements it; the pick cycle is handed one.
using EvaluateFunction = std::function<EvaluationResult(
    const TubeScene& scene, const Part& part, const Bin& bin, const EvaluationRequest& request)>;

}  // namespace tubetwin
