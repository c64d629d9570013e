#include "planner/choose.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "hw_bridge/base/error.h"
#include "hw_bridge/base/text.h"
#include "planner/grasps.h"
#include "planner/motions.h"

namespace tubetwin {
namespace {

constexpr double kApart_m = 0.020;  // Two tries nearer than this are one try.
// How often another tube came along by the displacement that was predicted
// (tests/benchmark/lifts.sh, hose_b threaded, seeds 1 to 23): 0 of 34 below 5 cm, 1 of 32 to 10 cm,
// 17 % to 20 cm, 50 % to 30 cm, 71 % to 50 cm, 89 % beyond. It counts as so many samples.
constexpr double kExtraPerMetre = 2.2, kQuiet_m = 0.05, kLeastExtra = 0.02, kMostExtra = 0.9;
constexpr double kPriorSamples = 5.0;

double WallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Order of preference; within a rank the cost decides.
enum Rank { kCertainFree, kCertainCovered, kDoubtfulFree, kDoubtfulCovered, kJams };

struct Option {
  Rank rank = kCertainFree;
  PickPlan plan;
};

// A tube with what was found out about it once.
struct Target {
  const PerceivedTube* tube = nullptr;
  std::string doubt;  // Empty: none.
  GraspSites sites;
};

// A motion of a covered tube and what the evaluator says of it.
struct Scored {
  const Target* target = nullptr;
  CandidateMotion motion;
  double grasp_at_m = 0.0, grasp_cost = 0.0;
  CandidateScore score;
  int samples = 0;  // That were asked for.
};

std::string DoubtAbout(const PerceivedTube& tube, const Part& part, const PlannerConfig& config) {
  const double share = tube.length_m / part.length_m;
  if (share < config.min_length_share) {
    return "only " + Number(std::round(share * 100)) + " % of the part's length is known, below " +
           Number(config.min_length_share * 100) + " %";
  }
  if (tube.confidence < config.min_confidence) {
    return "confidence " + Number(std::round(tube.confidence * 100) / 100) + ", below " +
           Number(config.min_confidence);
  }
  return "";
}

double TopOf(const TubeScene& scene) {
  double top = 0.0;
  for (const PerceivedTube& tube : scene.tubes) {
    for (const Vector3& p : tube.centerline_N) top = std::max(top, p.z());
  }
  return top;
}

class Chooser {
 public:
  Chooser(const TubeScene& scene, const std::vector<Vector3>& points_N, const Part& part,
          const Bin& bin, const PlannerConfig& config, const EvaluateFunction& evaluate,
          const FeasibilityFunction& feasible, std::uint64_t seed)
      : scene_(scene),
        points_N_(points_N),
        part_(part),
        bin_(bin),
        config_(config),
        evaluate_(evaluate),
        feasible_(feasible),
        seed_(seed),
        top_m_(TopOf(scene)) {}

  PlanResult Run() {
    const double start_s = WallSeconds();
    std::vector<Option> options = FreeOptions();
    TryAll(options, kCertainFree);
    if (result_.plans.empty()) {
      TryCovered(options);
    }
    Sort(options);
    TryAll(options, kJams);
    result_.planning_s = WallSeconds() - start_s;
    return std::move(result_);
  }

 private:
  TubeClass ClassOf(const PerceivedTube& tube) const {
    return config_.classes == "occluded_joints" ? tube.class_paper.value_or(tube.tube_class)
                                                : tube.tube_class;
  }

  std::vector<Target> Targets(bool free) {
    std::vector<Target> targets;
    for (const PerceivedTube& tube : scene_.tubes) {
      const TubeClass seen_as = ClassOf(tube);
      if ((seen_as == TubeClass::kFree) != free) continue;
      if (seen_as == TubeClass::kStrong && config_.classes == "occluded_joints") {
        result_.rejections.push_back({tube.id, "", "", "strongly occluded tubes are not picked"});
        continue;
      }
      if (tube.centerline_N.size() < 2 || Length(tube.centerline_N) <= 0.0) continue;
      Target target{&tube, DoubtAbout(tube, part_, config_), {}};
      target.sites = FindGraspSites(scene_, tube, points_N_, bin_, config_);
      Report(target.sites.rejections);
      if (target.sites.sites.empty()) {
        std::string reason = "no place where the gripper fits";
        if (!target.sites.rejections.empty()) {
          const Rejection& middle = target.sites.rejections[target.sites.rejections.size() / 2];
          reason += ", for example " + middle.grasp + ": " + middle.reason;
        }
        result_.rejections.push_back({tube.id, "", "", reason});
        continue;
      }
      targets.push_back(std::move(target));
    }
    return targets;
  }

  std::vector<Option> FreeOptions() {
    std::vector<Option> options;
    if (config_.exclude_free) {
      for (const PerceivedTube& tube : scene_.tubes) {
        if (ClassOf(tube) != TubeClass::kFree) continue;
        result_.rejections.push_back({tube.id, "", "", "free tubes are excluded"});
      }
      return options;
    }
    for (const Target& target : Targets(true)) {
      const CandidateMotion up = UpMotion(*target.tube, config_);
      result_.candidates.push_back(up);
      AddOptions(target, up, nullptr, options);
    }
    Sort(options);
    return options;
  }

  // Covered tubes that can be grasped, those in doubt last, the least covered first.
  std::vector<Target> CoveredTargets() {
    std::vector<Target> targets = Targets(false);
    std::stable_sort(targets.begin(), targets.end(), [this](const Target& a, const Target& b) {
      if (a.doubt.empty() != b.doubt.empty()) return a.doubt.empty();
      return Covers(a.tube->id) < Covers(b.tube->id);
    });
    return targets;
  }

  int Covers(int id) const {
    return static_cast<int>(
        std::count_if(scene_.crossings.begin(), scene_.crossings.end(),
                      [id](const Crossing& crossing) { return crossing.under == id; }));
  }

  // Screens covered tubes until one of them promises to come alone, tries the best, goes on where
  // the arm can run none of them.
  void TryCovered(std::vector<Option>& options) {
    const std::vector<Target> targets = CoveredTargets();
    const std::vector<Option> free = options;
    for (std::size_t next = 0; next < targets.size() && result_.plans.empty();) {
      do {
        next = Screen(targets, next);
        Refine();
      } while (next < targets.size() && !AnyPromising());
      options = free;
      for (const Scored& scored : scored_) {
        AddOptions(*scored.target, scored.motion, &scored.score, options);
      }
      Sort(options);
      TryAll(options, kCertainCovered);
    }
    for (Scored& scored : scored_) {
      result_.evaluation.candidates.push_back(std::move(scored.score));
    }
    FindBest();
  }

  // One roll-out for every motion of tubes from `first` on, about max_candidates of them; returns
  // the first tube that is left.
  std::size_t Screen(const std::vector<Target>& targets, std::size_t first) {
    const std::size_t from = scored_.size();
    std::size_t next = first;
    while (next < targets.size() &&
           static_cast<int>(scored_.size() - from) < config_.max_candidates) {
      AddMotions(targets[next++]);
    }
    std::vector<Scored*> all;
    for (std::size_t k = from; k < scored_.size(); ++k) all.push_back(&scored_[k]);
    Evaluate(all, 1);
    return next;
  }

  void AddMotions(const Target& target) {
    MotionSet set = MakeMotions(scene_, *target.tube, bin_, config_);
    Report(set.rejections);
    for (CandidateMotion& motion : set.motions) {
      result_.candidates.push_back(motion);
      // The place where it would be held if all motions were equally good.
      const GraspSet grasps =
          RankGrasps(target.sites, *target.tube, motion, 0.0, top_m_, bin_, config_);
      if (grasps.grasps.empty()) {
        Report(grasps.rejections);
        result_.rejections.push_back(
            {target.tube->id, motion.name, "", "no grasp suits this motion"});
        continue;
      }
      const Grasp& best = grasps.grasps.front();
      scored_.push_back({&target, std::move(motion), best.at_m, best.cost, {}, 0});
    }
  }

  // All samples for the most promising motions, until the best of all has them: one lucky roll-out
  // wins too easily among many.
  void Refine() {
    if (config_.samples <= 1) return;
    for (;;) {
      std::vector<Scored*> order;
      for (Scored& scored : scored_) order.push_back(&scored);
      std::stable_sort(order.begin(), order.end(), [this](const Scored* a, const Scored* b) {
        const Rank rank_a = RankOf(*a->target, &a->score), rank_b = RankOf(*b->target, &b->score);
        return rank_a != rank_b ? rank_a < rank_b : CostOf(*a) < CostOf(*b);
      });
      if (order.empty() || IsRefined(*order.front())) return;
      order.resize(std::min<std::size_t>(order.size(), config_.refined));
      std::erase_if(order, [this](const Scored* scored) { return IsRefined(*scored); });
      Evaluate(order, config_.samples);
    }
  }

  bool IsRefined(const Scored& scored) const {
    return scored.score.status != CandidateScore::Status::kDone ||
           scored.samples >= config_.samples;
  }

  double CostOf(const Scored& scored) const {
    const double share = std::min(scored.score.displacement_m / config_.max_displacement_m, 1.0);
    return scored.grasp_cost + config_.weight_trajectory * share +
           config_.weight_confidence * (1.0 - scored.target->tube->confidence) +
           config_.weight_extra * ExtraProbability(scored.score, part_);
  }

  bool AnyPromising() const {
    return std::any_of(scored_.begin(), scored_.end(), [this](const Scored& scored) {
      return RankOf(*scored.target, &scored.score) == kCertainCovered && IsRefined(scored) &&
             ExtraProbability(scored.score, part_) <= config_.accept_extra;
    });
  }

  // Evaluates motions with a number of samples and keeps the scores with them.
  void Evaluate(const std::vector<Scored*>& motions, int samples) {
    if (motions.empty()) return;
    EvaluationRequest request;
    request.seed = seed_;
    request.samples = samples;
    for (const Scored* scored : motions) {
      request.candidates.push_back(scored->motion);
      request.grasp_at_m.push_back(scored->grasp_at_m);
    }
    const std::vector<CandidateScore> scores = Evaluate(request);
    for (std::size_t k = 0; k < motions.size(); ++k) {
      motions[k]->score = scores[k];
      motions[k]->samples = samples;
    }
  }

  std::vector<CandidateScore> Evaluate(const EvaluationRequest& request) {
    TT_CHECK(evaluate_);
    const double start_s = WallSeconds();
    EvaluationResult answer = evaluate_(scene_, part_, bin_, request);
    TT_CHECK(answer.candidates.size() == request.candidates.size());
    result_.evaluator_s += WallSeconds() - start_s;
    result_.evaluation.settle_s += answer.settle_s;
    result_.evaluation.wall_s += answer.wall_s;
    result_.evaluation.threads = answer.threads;
    return std::move(answer.candidates);
  }

  void FindBest() {
    const std::vector<CandidateScore>& scores = result_.evaluation.candidates;
    for (std::size_t k = 0; k < scores.size(); ++k) {
      int& best = result_.evaluation.best;
      if (best < 0 || scores[k].cost < scores[best].cost) best = static_cast<int>(k);
    }
  }

  // All grasps of a tube for a motion; `score` null: the simulator was not needed.
  void AddOptions(const Target& target, const CandidateMotion& motion, const CandidateScore* score,
                  std::vector<Option>& options) {
    const PerceivedTube& tube = *target.tube;
    if (score != nullptr && score->status == CandidateScore::Status::kDiverged) {
      result_.rejections.push_back({tube.id, motion.name, "", "the simulation diverged"});
      return;
    }
    GraspSet grasps =
        RankGrasps(target.sites, tube, motion, score != nullptr ? score->displacement_m : 0.0,
                   top_m_, bin_, config_);
    Report(grasps.rejections);
    for (const Grasp& grasp : grasps.grasps) {
      Option option;
      option.rank = RankOf(target, score);
      option.plan.target = tube.id;
      option.plan.target_class = ClassOf(tube);
      option.plan.motion = motion;
      option.plan.grasp = grasp;
      option.plan.used_simulator = score != nullptr;
      if (score != nullptr) {
        option.plan.prediction = Prediction{score->displacement_m, score->extra_probability,
                                            static_cast<int>(score->samples.size())};
      }
      option.plan.cost =
          grasp.cost + config_.weight_confidence * (1.0 - tube.confidence) +
          (score != nullptr ? config_.weight_extra * ExtraProbability(*score, part_) : 0.0);
      option.plan.note = option.rank == kJams ? "the motion jammed in the simulator" : target.doubt;
      options.push_back(std::move(option));
    }
  }

  Rank RankOf(const Target& target, const CandidateScore* score) const {
    if (score != nullptr && score->status == CandidateScore::Status::kJammed) return kJams;
    const bool free = ClassOf(*target.tube) == TubeClass::kFree;
    if (target.doubt.empty()) return free ? kCertainFree : kCertainCovered;
    return free ? kDoubtfulFree : kDoubtfulCovered;
  }

  static void Sort(std::vector<Option>& options) {
    std::stable_sort(options.begin(), options.end(), [](const Option& a, const Option& b) {
      if (a.rank != b.rank) return a.rank < b.rank;
      return a.plan.cost < b.plan.cost;
    });
  }

  // Checks sorted options up to a rank, best first; what was tried before is not tried again.
  void TryAll(const std::vector<Option>& options, Rank last) {
    for (const Option& option : options) {
      if (option.rank <= last) Try(option);
    }
  }

  void Try(const Option& option) {
    const int id = option.plan.target;
    if (static_cast<int>(result_.plans.size()) >= config_.max_plans) return;
    if (kept_[id] >= config_.plans_per_tube) return;
    std::vector<double>& tried = tried_[{id, option.plan.motion.name}];
    for (const double at_m : tried) {
      if (std::abs(at_m - option.plan.grasp.at_m) < kApart_m - 1e-9) return;
    }
    tried.push_back(option.plan.grasp.at_m);
    PickPlan plan = option.plan;
    const std::optional<std::string> against = feasible_(plan.grasp, plan.motion);
    if (against) {
      plan.grasp.X_NG.linear() = plan.grasp.X_NG.linear() * RotZ(kPi);
      if (feasible_(plan.grasp, plan.motion)) {
        result_.rejections.push_back(
            {id, plan.motion.name, "at " + Number(std::round(plan.grasp.at_m * 1e3) / 1e3) + " m",
             "arm: " + *against});
        return;
      }
    }
    ++kept_[id];
    result_.plans.push_back(std::move(plan));
  }

  void Report(const std::vector<Rejection>& rejections) {
    result_.rejections.insert(result_.rejections.end(), rejections.begin(), rejections.end());
  }

  const TubeScene& scene_;
  const std::vector<Vector3>& points_N_;
  const Part& part_;
  const Bin& bin_;
  const PlannerConfig& config_;
  const EvaluateFunction& evaluate_;
  const FeasibilityFunction& feasible_;
  const std::uint64_t seed_;
  const double top_m_;
  PlanResult result_;
  std::vector<Scored> scored_;
  std::map<int, int> kept_;  // Plans per tube.
  std::map<std::pair<int, std::string>, std::vector<double>> tried_;
};

}  // namespace

double ExtraProbability(const CandidateScore& score, const Part& part) {
  if (score.status == CandidateScore::Status::kPruned) return 0.0;
  const double expected =
      std::clamp(kExtraPerMetre * (score.displacement_m - kQuiet_m), kLeastExtra, kMostExtra);
  const double weight = part.is_hose() ? kPriorSamples : 1.0;
  const double n = static_cast<double>(score.samples.size());
  return (n * score.extra_probability + weight * expected) / (n + weight);
}

PlanResult PlanPicks(const TubeScene& scene, const std::vector<Vector3>& points_N, const Part& part,
                     const Bin& bin, const PlannerConfig& config, const EvaluateFunction& evaluate,
                     const FeasibilityFunction& feasible, std::uint64_t seed) {
  TT_CHECK(feasible);
  return Chooser(scene, points_N, part, bin, config, evaluate, feasible, seed).Run();
}

}  // namespace tubetwin
