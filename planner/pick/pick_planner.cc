#include "planner/pick/pick_planner.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "models/base/error.h"
#include "models/base/step_timer.h"
#include "models/base/text.h"
#include "planner/pick/rollout_scheduler.h"
#include "planner/scene_query/removal_order.h"

namespace tubetwin {
namespace {

constexpr double kManyReleased = 3.0;

struct Option {
  Rank rank = Rank::kCertainFree;
  PickPlan plan;
};

std::string DoubtAbout(const PerceivedTube& tube, const Part& part, const SearchConfig& config) {
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

// The scene with tubes by their ids and crossings by theirs and their place.
TubeScene Ordered(TubeScene scene) {
  std::sort(scene.tubes.begin(), scene.tubes.end(),
            [](const PerceivedTube& a, const PerceivedTube& b) { return a.id < b.id; });
  const auto key = [](const Crossing& c) {
    return std::tuple(c.under, c.at_under_m, c.over, c.at_over_m);
  };
  std::sort(scene.crossings.begin(), scene.crossings.end(),
            [&](const Crossing& a, const Crossing& b) { return key(a) < key(b); });
  return scene;
}

class PickPlanner {
 public:
  PickPlanner(const PickProblem& problem, const EvaluateFunction& evaluate,
              const FeasibilityFunction& feasible, std::uint64_t seed)
      : problem_(problem),
        scene_(problem.scene),
        config_(problem.config),
        evaluate_(evaluate),
        choice_(feasible),
        seed_(seed),
        top_m_(TopOf(scene_)) {}

  PlanResult Run() {
    const double start_s = WallClock_s();
    std::vector<Option> options = FreeOptions();
    TryAll(options, Rank::kCertainFree);
    if (result_.plans.empty()) TryCovered(options);
    Sort(options);
    TryAll(options, Rank::kJams);
    result_.planning_s = WallClock_s() - start_s;
    return std::move(result_);
  }

 private:
  TubeClass ClassOf(const PerceivedTube& tube) const {
    return config_.by_occluded_joints() ? tube.class_paper.value_or(tube.tube_class)
                                        : tube.tube_class;
  }

  std::vector<Target> Targets(bool free) {
    std::vector<Target> targets;
    for (const PerceivedTube& tube : scene_.tubes) {
      const TubeClass seen_as = ClassOf(tube);
      if ((seen_as == TubeClass::kFree) != free) continue;
      if (seen_as == TubeClass::kStrong && config_.by_occluded_joints()) {
        result_.rejections.push_back({tube.id, "", "", "strongly occluded tubes are not picked"});
        continue;
      }
      if (tube.centerline_N.size() < 2 || Length(tube.centerline_N) <= 0.0) continue;
      const double released = std::min(1.0, ReleasedBy(scene_, tube.id) / kManyReleased);
      Target target{&tube, DoubtAbout(tube, problem_.part, config_),
                    config_.weight_confidence * (1.0 - tube.confidence) +
                        config_.weight_release * (1.0 - released),
                    FindGraspSites(problem_.grasps(), tube)};
      Report(target.sites.rejections);
      if (target.sites.sites.empty()) {
        ReportNoSite(target);
        continue;
      }
      targets.push_back(std::move(target));
    }
    return targets;
  }

  void ReportNoSite(const Target& target) {
    std::string reason = "no place where the gripper fits, upright or leaning";
    const std::vector<Rejection>& all = target.sites.rejections;
    if (!all.empty()) {
      const Rejection& middle = all[all.size() / 2];
      reason += ", for example " + middle.grasp + ": " + middle.reason;
    }
    result_.rejections.push_back({target.tube->id, "", "", reason});
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
      const CandidateMotion up = StraightUp(problem_.extraction(*target.tube));
      result_.candidates.push_back(up);
      AddOptions(target, up, nullptr, options);
    }
    Sort(options);
    return options;
  }

  // Covered tubes that can be grasped, those in doubt last, else in the order of removal.
  std::vector<Target> CoveredTargets() {
    std::vector<Target> targets = Targets(false);
    std::map<int, int> place;
    for (const RemovalRank& rank : RemovalOrder(scene_)) {
      place.emplace(rank.tube, static_cast<int>(place.size()));
    }
    std::stable_sort(targets.begin(), targets.end(), [&](const Target& a, const Target& b) {
      if (a.doubt.empty() != b.doubt.empty()) return a.doubt.empty();
      return place.at(a.tube->id) < place.at(b.tube->id);
    });
    return targets;
  }

  // Scores motions of covered tubes until one promises to take its tube alone, tries the best, goes
  // on where the arm can run none of them.
  void TryCovered(std::vector<Option>& options) {
    const std::vector<Option> free = options;
    const std::vector<Target> targets = CoveredTargets();
    RolloutScheduler search({problem_, evaluate_, choice_, seed_, top_m_}, targets, result_);
    while (result_.plans.empty() && search.Next()) {
      options = free;
      for (const Scored& scored : search.scored()) {
        const std::size_t before = options.size();
        AddOptions(*scored.target, scored.motion, &scored.score, options);
        if (scored.samples > 0) continue;
        // Only a lower bound is known: after all that were rolled out whole.
        for (std::size_t k = before; k < options.size(); ++k) {
          options[k].rank = std::max(options[k].rank, Rank::kDoubtfulCovered);
          options[k].plan.note = "its roll-out was given up when another motion was better";
        }
      }
      Sort(options);
      TryAll(options, Rank::kCertainCovered);
    }
    search.Finish();
  }

  // All grasps of a tube for a motion; `score` null: the simulator was not needed.
  void AddOptions(const Target& target, const CandidateMotion& motion, const CandidateScore* score,
                  std::vector<Option>& options) {
    const PerceivedTube& tube = *target.tube;
    if (score != nullptr && score->status == CandidateScore::Status::kDiverged) {
      result_.rejections.push_back({tube.id, motion.name, "", "the simulation diverged"});
      return;
    }
    const GraspSet grasps = RankGrasps(problem_.grasps(), target.sites, tube, motion,
                                       score != nullptr ? score->displacement_m : 0.0, top_m_);
    Report(grasps.rejections);
    for (const Grasp& grasp : grasps.grasps) {
      Option option;
      option.rank = RankOf(ClassOf(tube) == TubeClass::kFree, !target.doubt.empty(), score);
      option.plan.target = tube.id;
      option.plan.target_class = ClassOf(tube);
      option.plan.motion = motion;
      option.plan.grasp = grasp;
      option.plan.used_simulator = score != nullptr;
      option.plan.cost = grasp.cost + target.cost;
      if (score != nullptr) {
        option.plan.prediction = Prediction{score->displacement_m, score->extra_probability,
                                            static_cast<int>(score->samples.size())};
        option.plan.cost += config_.weight_extra * ExtraProbability(*score, problem_.part);
      }
      option.plan.note =
          option.rank == Rank::kJams ? "the motion jammed in the simulator" : target.doubt;
      options.push_back(std::move(option));
    }
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
    if (IsNearAny(tried, option.plan.grasp.at_m)) return;
    tried.push_back(option.plan.grasp.at_m);
    PickPlan plan = option.plan;
    if (const auto refusal = choice_.RefusalOf(plan.grasp, plan.motion)) {
      Report({GraspChoice::ArmRejection(plan.motion, plan.grasp.at_m, *refusal)});
      return;
    }
    ++kept_[id];
    result_.plans.push_back(std::move(plan));
  }

  void Report(const std::vector<Rejection>& rejections) {
    result_.rejections.insert(result_.rejections.end(), rejections.begin(), rejections.end());
  }

  const PickProblem& problem_;
  const TubeScene& scene_;
  const PlannerConfig& config_;
  const EvaluateFunction& evaluate_;
  GraspChoice choice_;
  const std::uint64_t seed_;
  const double top_m_;
  PlanResult result_;
  std::map<int, int> kept_;  // Plans per tube.
  std::map<std::pair<int, std::string>, std::vector<double>> tried_;
};

}  // namespace

int ReleasedBy(const TubeScene& scene, int id) {
  return static_cast<int>(
      std::count_if(scene.tubes.begin(), scene.tubes.end(), [&](const PerceivedTube& tube) {
        bool covered = false;
        for (const Crossing& crossing : scene.crossings) {
          if (crossing.under != tube.id) continue;
          if (crossing.over != id) return false;
          covered = true;
        }
        return covered;
      }));
}

PlanResult PlanPicks(const PickProblem& problem, const EvaluateFunction& evaluate,
                     const FeasibilityFunction& feasible, std::uint64_t seed) {
  TT_CHECK(feasible);
  const TubeScene scene = Ordered(problem.scene);
  const PickProblem ordered{scene,           problem.points_N, problem.part,   problem.bin,
                            problem.gripper, problem.config,   problem.motions};
  return PickPlanner(ordered, evaluate, feasible, seed).Run();
}

}  // namespace tubetwin
