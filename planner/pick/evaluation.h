#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "models/bin.h"
#include "models/part.h"
#include "perception/scene/tube_scene.h"
#include "planner/extraction/candidate_motion.h"

namespace tubetwin {

/// One candidate's score (scores.json).
struct CandidateScore : TubePath {
  std::string motion;
  double displacement_m = 0.0;  ///< Sum over the other tubes' centres of mass, baseline subtracted.
  double extra_probability = 0.0;  ///< Share of samples in which another tube came along.
  double cost = 0.0;               ///< Lower is better.
  enum class Status { kDone, kJammed, kDiverged, kPruned } status = Status::kDone;
  bool lower_bound = false;  ///< A roll-out was given up: the whole displacement would be larger.
  double sim_s = 0.0, wall_s = 0.0;
  std::vector<double> samples;  ///< Displacement of each sample.
};
const char* ToString(CandidateScore::Status status);

/// A question to the evaluator.
struct EvaluationRequest {
  std::vector<CandidateMotion> candidates;
  /// Arc length on each candidate's tube where the hand holds it.
  std::vector<double> grasp_at_m;
  /// For each candidate the displacement beyond which its roll-outs need not go on, because another
  /// motion is better then. Empty: the evaluator's own limit for all.
  std::vector<double> give_up_m;
  int samples = 1;
  int first_sample = 0;  ///< Samples first_sample to first_sample + samples - 1 are rolled out.
  bool full = false;     ///< Nothing pruned or cut short.
  std::uint64_t seed = 1;
};

/// The evaluator's answer.
struct EvaluationResult {
  std::vector<CandidateScore> candidates;  ///< In the order of the request.
  int best = -1;                           ///< Index of the lowest cost, -1 when there is none.
  double settle_s = 0.0, wall_s = 0.0;     ///< Wall times.
  int threads = 1;
};
/// scores.json.
Json ToJson(const EvaluationResult& result);

/// The pipeline's internal roll-outs, as the planner sees them: perceived tubes in, scores out.
/// planner/evaluator implements it; the pick cycle is handed one.
using EvaluateFunction = std::function<EvaluationResult(
    const TubeScene& scene, const Part& part, const Bin& bin, const EvaluationRequest& request)>;

}  // namespace tubetwin
