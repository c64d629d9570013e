#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "models/base/json_fwd.h"
#include "models/base/polyline.h"
#include "models/bin.h"
#include "models/part.h"
#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// Where a tube goes from where it lies, frame N: at waypoint k every point p of it is at
/// pivot + waypoint + rotation * (p - pivot). The first waypoint is zero and not turned.
struct ObjectPath {
  std::vector<Vector3> waypoints_N;             ///< Of the pivot, metres.
  std::vector<Eigen::Quaterniond> rotations_N;  ///< One for each waypoint, or none: not turned.
  Vector3 pivot_N = Vector3::Zero();            ///< Without meaning where nothing turns.

  bool turns() const { return !rotations_N.empty(); }
};

/// Takes points from where they lie to where they are at waypoint `k`. Precondition: k exists.
RigidTransform PoseAt(const ObjectPath& way, std::size_t k);

/// Such poses along the way, the first and every waypoint among them. Between waypoints the pivot
/// goes straight and the rotation evenly; points within `reach_m` of the pivot move by `step_m` at
/// most from one pose to the next.
std::vector<RigidTransform> PosesAlong(const ObjectPath& way, double step_m, double reach_m);

/// Writes `waypoints_m` and, where the way turns, `rotations_wxyz` and `pivot_m` into an object.
void AddObjectPath(const ObjectPath& way, Json& json);
/// Reads what AddObjectPath wrote. Throws Error(kBadData).
ObjectPath ObjectPathFromJson(const JsonView& view);

/// What a tube does after it was grasped.
struct CandidateMotion : ObjectPath {
  int tube = 0;
  std::string name;  ///< "up", "escape+", "escape-", ...
  double speed_m_s = 0.25;
  double turn_speed_rad_s = 0.5;
  /// Escape: arc length range of the tube that passes under the occluder; no grasp there.
  double forbidden_from_m = 1.0, forbidden_to_m = 0.0;  ///< Empty when from > to.
  /// More such ranges: the gripper would run into another tube there.
  std::vector<std::pair<double, double>> blocked_m;
};

/// One candidate's score (scores.json).
struct CandidateScore : ObjectPath {
  int tube = 0;
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
