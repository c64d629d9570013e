#include "planner/evaluator/evaluator.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>

#include "models/base/error.h"
#include "models/base/step_timer.h"
#include "models/base/text.h"
#include "planner/evaluator/rollout.h"
#include "planner/evaluator/rollout_scene.h"
#include "planner/scene_query/removal_order.h"
#include "planner/scene_query/sweep.h"

namespace tubetwin {
namespace {

using Status = CandidateScore::Status;

constexpr double kMaxTurn_deg = 80.0;
constexpr double kExtraCost_m = 1.0, kJamCost_m = 1.0, kDivergedCost_m = 10.0;

int IndexOf(const TubeScene& scene, int id) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < scene.tubes.size(); ++i) {
    if (scene.tubes[i].id == id) return static_cast<int>(i);
    known.push_back(std::to_string(scene.tubes[i].id));
  }
  throw Error(ErrorKind::kBadData, "evaluator: tube " + std::to_string(id) +
                                       " is not in the scene, which has tubes " + Join(known));
}

// The second of the hand's three hinges, about N's y axis, is sure to follow so far.
void ValidateTurns(const CandidateMotion& candidate, const std::string& who) {
  if (!candidate.turns()) return;
  if (candidate.rotations_N.size() != candidate.waypoints_N.size()) {
    throw Error(ErrorKind::kBadData, who + std::to_string(candidate.rotations_N.size()) +
                                         " rotations for " +
                                         std::to_string(candidate.waypoints_N.size()) +
                                         " waypoints, one for each is needed");
  }
  for (const Eigen::Quaterniond& rotation : candidate.rotations_N) {
    const double angle_deg = Degrees(std::asin(std::clamp(rotation.matrix()(0, 2), -1.0, 1.0)));
    if (!(std::abs(angle_deg) <= kMaxTurn_deg)) {
      throw Error(ErrorKind::kBadData, who + "turned by " + Number(angle_deg) +
                                           " degrees about the bin's y axis, at most " +
                                           Number(kMaxTurn_deg));
    }
  }
}

double DurationOf(const CandidateMotion& motion) {
  double turn_rad = 0.0;
  for (std::size_t i = 1; i < motion.rotations_N.size(); ++i) {
    turn_rad += motion.rotations_N[i - 1].angularDistance(motion.rotations_N[i]);
  }
  return Length(motion.waypoints_N) / motion.speed_m_s + turn_rad / motion.turn_speed_rad_s;
}

void Validate(const TubeScene& scene, const EvaluationRequest& request,
              const EvaluatorConfig& config) {
  TT_CHECK(request.grasp_at_m.size() == request.candidates.size());
  TT_CHECK(request.give_up_m.empty() || request.give_up_m.size() == request.candidates.size());
  TT_CHECK(request.samples >= 1 && request.first_sample >= 0);
  for (std::size_t k = 0; k < request.candidates.size(); ++k) {
    const CandidateMotion& candidate = request.candidates[k];
    const std::string who =
        "evaluator: tube " + std::to_string(candidate.tube) + ", motion " + candidate.name + ": ";
    const PerceivedTube& tube = scene.tubes[IndexOf(scene, candidate.tube)];
    const double length_m = Length(tube.centerline_N);
    const double at_m = request.grasp_at_m[k];
    if (!(at_m >= 0.0 && at_m <= length_m)) {
      throw Error(ErrorKind::kBadData,
                  who + "held at " + Number(at_m) + " m, allowed 0 to " + Number(length_m) + " m");
    }
    ValidateTurns(candidate, who);
    if (candidate.waypoints_N.empty() || !(candidate.speed_m_s > 0.0) ||
        !(DurationOf(candidate) <= config.max_sim_s)) {
      throw Error(ErrorKind::kBadData, who + "a way of " + Number(Length(candidate.waypoints_N)) +
                                           " m at " + Number(candidate.speed_m_s) +
                                           " m/s, at most " + Number(config.max_sim_s) +
                                           " s are simulated");
    }
  }
}

// Settled scenes of the pile that was asked about last: a planner asks several times. Thread safe.
class SceneCache {
 public:
  using ScenePtr = std::shared_ptr<const RolloutScene>;

  /// Everything that a scene depends on besides its sample and the configuration.
  static std::vector<double> KeyOf(const TubeScene& scene, const Part& part, const Bin& bin,
                                   std::uint64_t seed) {
    std::vector<double> key = {static_cast<double>(seed >> 32),
                               static_cast<double>(seed & 0xffffffffu),
                               part.friction,
                               part.bending_stiffness_Nm2,
                               part.mass_kg,
                               part.length_m,
                               static_cast<double>(part.links),
                               part.is_hose() ? 1.0 : 0.0};
    for (const auto* range : {&part.friction_range, &part.bending_stiffness_range_Nm2}) {
      key.insert(key.end(), range->begin(), range->end());
      key.push_back(-1.0);
    }
    key.insert(key.end(), bin.size_m.begin(), bin.size_m.end());
    for (const PerceivedTube& tube : scene.tubes) {
      key.push_back(tube.radius_m);
      for (const Vector3& p : tube.centerline_N) key.insert(key.end(), p.data(), p.data() + 3);
    }
    return key;
  }

  ScenePtr Find(const std::vector<double>& key, int sample) {
    const std::lock_guard lock(mutex_);
    if (key != key_) return nullptr;
    const auto found = scenes_.find(sample);
    return found == scenes_.end() ? nullptr : found->second;
  }

  void Keep(const std::vector<double>& key, int sample, const ScenePtr& scene) {
    const std::lock_guard lock(mutex_);
    if (key != key_) {
      scenes_.clear();
      key_ = key;
    }
    scenes_[sample] = scene;
  }

 private:
  std::mutex mutex_;
  std::vector<double> key_;
  std::map<int, ScenePtr> scenes_;
};

// What each thread keeps between roll-outs.
struct Worker {
  MjModel model;
  MjData data;
};

// All samples of one candidate into its score.
CandidateScore Summarize(const CandidateMotion& candidate,
                         const std::vector<RolloutOutcome>& outcomes,
                         const std::vector<double>& wall_s) {
  CandidateScore score;
  score.tube = candidate.tube;
  score.motion = candidate.name;
  static_cast<ObjectPath&>(score) = candidate;
  const double n = static_cast<double>(outcomes.size());
  int jammed = 0;
  bool diverged = false;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const RolloutOutcome& outcome = outcomes[k];
    score.samples.push_back(outcome.displacement_m);
    score.displacement_m += outcome.displacement_m / n;
    if (outcome.extra) score.extra_probability += 1.0 / n;
    if (outcome.given_up) score.lower_bound = true;
    score.sim_s += outcome.sim_s;
    score.wall_s += wall_s[k];
    if (outcome.status == Status::kJammed) ++jammed;
    if (outcome.status == Status::kDiverged) diverged = true;
  }
  score.cost = score.displacement_m;
  if (outcomes.size() > 1) score.cost += kExtraCost_m * score.extra_probability;
  if (diverged) {
    score.status = Status::kDiverged;
    score.cost += kDivergedCost_m;
  } else if (2 * jammed >= static_cast<int>(outcomes.size())) {
    score.status = Status::kJammed;
    score.cost += kJamCost_m;
  }
  return score;
}

class Evaluation {
 public:
  Evaluation(const TubeScene& scene, const Part& part, const Bin& bin,
             const EvaluationRequest& request, const EvaluatorOptions& options, SceneCache& cache)
      : scene_(scene),
        part_(part),
        bin_(bin),
        request_(request),
        options_(options),
        cache_(cache),
        samples_(request.samples) {}

  EvaluationResult Run() {
    const double start_s = WallClock_s();
    result_.threads = options_.parallelism.threads;
    result_.candidates.resize(request_.candidates.size());
    std::vector<int> to_run = Prune();
    if (!to_run.empty()) {
      BuildScenes();
      result_.settle_s = WallClock_s() - start_s;
      RollOutAll(to_run);
    }
    for (std::size_t k = 0; k < result_.candidates.size(); ++k) {
      const double cost = result_.candidates[k].cost;
      if (result_.best < 0 || cost < result_.candidates[result_.best].cost) {
        result_.best = static_cast<int>(k);
      }
    }
    result_.wall_s = WallClock_s() - start_s;
    return std::move(result_);
  }

 private:
  bool TouchesAny(const CandidateMotion& motion, double at_m) const {
    const Polyline& line = scene_.tubes[IndexOf(scene_, motion.tube)].centerline_N;
    return FirstTouched(scene_, motion) ||
           FirstTouchedByFingers(scene_, motion, PointAt(line, at_m), options_.gripper.spec);
  }

  // Scores the motions that touch nothing; returns the others.
  std::vector<int> Prune() {
    std::vector<int> to_run;
    for (std::size_t k = 0; k < request_.candidates.size(); ++k) {
      const CandidateMotion& candidate = request_.candidates[k];
      if (request_.full || TouchesAny(candidate, request_.grasp_at_m[k])) {
        to_run.push_back(static_cast<int>(k));
        continue;
      }
      CandidateScore& score = result_.candidates[k];
      score.tube = candidate.tube;
      score.motion = candidate.name;
      static_cast<ObjectPath&>(score) = candidate;
      score.status = Status::kPruned;
    }
    return to_run;
  }

  void BuildScenes() {
    const std::vector<double> key = SceneCache::KeyOf(scene_, part_, bin_, request_.seed);
    scenes_.resize(samples_);
    ParallelFor(samples_, options_.parallelism, [&](int k, int) {
      const int sample = request_.first_sample + k;
      scenes_[k] = cache_.Find(key, sample);
      if (scenes_[k] != nullptr) return;
      const SampleDraw draw = DrawSample(part_, static_cast<int>(scene_.tubes.size()), sample,
                                         request_.seed, options_.config);
      scenes_[k] = std::make_shared<const RolloutScene>(scene_, part_, bin_, draw, options_);
      cache_.Keep(key, sample, scenes_[k]);
    });
  }

  // Tasks (candidate, sample) in the order of their start: those that will take long first, so that
  // no thread is left alone with one at the end. Lifting more tubes takes longer.
  std::vector<int> LongestFirst(const std::vector<int>& to_run) const {
    std::map<int, int> lifted;
    for (const RemovalRank& rank : RemovalOrder(scene_)) lifted[rank.tube] = 1 + rank.blockers;
    std::vector<double> work;
    for (const int k : to_run) {
      const CandidateMotion& motion = request_.candidates[k];
      work.push_back(lifted[motion.tube] * DurationOf(motion));
    }
    std::vector<int> order(to_run.size() * static_cast<std::size_t>(samples_));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return work[a / samples_] > work[b / samples_]; });
    return order;
  }

  void RollOutAll(const std::vector<int>& to_run) {
    const int count = static_cast<int>(to_run.size()) * samples_;
    std::vector<RolloutOutcome> outcomes(count);
    std::vector<double> wall_s(count, 0.0);
    std::vector<Worker> workers(options_.parallelism.threads);
    const std::vector<int> order = LongestFirst(to_run);
    ParallelFor(count, options_.parallelism, [&](int place, int index) {
      const int task = order[place];
      const int candidate = to_run[task / samples_];
      const RolloutScene& scene = *scenes_[task % samples_];
      Worker& worker = workers[index];
      const double start_s = WallClock_s();
      if (!worker.model) {
        worker.model.reset(mj_copyModel(nullptr, &scene.model()));
        worker.data = MakeData(*worker.model);
      }
      const CandidateMotion& motion = request_.candidates[candidate];
      const int tube = IndexOf(scene_, motion.tube);
      const double share = request_.grasp_at_m[candidate] / Length(scene_.tubes[tube].centerline_N);
      EvaluatorConfig config = options_.config;
      if (!request_.give_up_m.empty()) {
        config.give_up_m = std::min(config.give_up_m, request_.give_up_m[candidate]);
      }
      outcomes[task] =
          RollOut(scene, tube, share, motion, request_.full, config, *worker.model, *worker.data);
      wall_s[task] = WallClock_s() - start_s;
    });
    for (std::size_t k = 0; k < to_run.size(); ++k) {
      const auto from = static_cast<std::ptrdiff_t>(k) * samples_;
      result_.candidates[to_run[k]] =
          Summarize(request_.candidates[to_run[k]],
                    {outcomes.begin() + from, outcomes.begin() + from + samples_},
                    {wall_s.begin() + from, wall_s.begin() + from + samples_});
    }
  }

  const TubeScene& scene_;
  const Part& part_;
  const Bin& bin_;
  const EvaluationRequest& request_;
  const EvaluatorOptions& options_;
  SceneCache& cache_;
  const int samples_;
  std::vector<SceneCache::ScenePtr> scenes_;
  EvaluationResult result_;
};

}  // namespace

void EvaluatorConfig::Visit(ConfigVisitor& v) {
  v.Field("timestep_s", "step of the roll-outs", timestep_s, {0.0005, 0.005});
  v.Field("tolerance", "improvement at which the contact solver ends (MuJoCo's option)", tolerance,
          {1e-12, 0.01});
  v.Field("hand_force_N", "force limit of the hand on each axis", hand_force_N, {1.0, 1000.0});
  v.Field("jam_s", "a hand that is saturated for longer is jammed", jam_s, {0.0, 10.0});
  v.Field("hold_s", "waiting after the motion, before displacements are taken", hold_s,
          {0.0, 10.0});
  v.Field("give_up_m",
          "a roll-out that has displaced the others by more ends, its cost a lower bound; tips, "
          "which shed what they displace, go on",
          give_up_m, {0.01, 1000.0});
  v.Field("max_sim_s", "longest motion that is accepted", max_sim_s, {1.0, 600.0});
  v.Field("pose_error_m", "samples after the first: sigma of each tube's position, per axis",
          pose_error_m, {0.0, 0.02});
}

EvaluateFunction MakeEvaluator(const EvaluatorOptions& options) {
  TT_CHECK(options.parallelism.threads >= 1);
  return [options, cache = std::make_shared<SceneCache>()](const TubeScene& scene, const Part& part,
                                                           const Bin& bin,
                                                           const EvaluationRequest& request) {
    Validate(scene, request, options.config);
    return Evaluation(scene, part, bin, request, options, *cache).Run();
  };
}

}  // namespace tubetwin
