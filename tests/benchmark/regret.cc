// What our choice among covered tubes costs more than the best motion that was offered, by two
// finer references; regret.sh runs it and regret.py makes the tables.
//
//   regret --part P --count N --arrangement A --piles N [--from SEED] [--motions M]
//          [--exclude-free] [--set planner.x=V]... [--rows ROWS.jsonl] [--threads N]
//
// Piles of the seeds from SEED on, seen as they are, until N have no free tube (--exclude-free:
// until N have a covered one; the free ones may not be chosen). Each is planned as the program
// does, the arm included. A reference is the evaluator at 1 ms with five drawn samples, which end
// only where nothing more can happen; it compares M of the motions that the choice asked about and
// the arm can carry out: the chosen one, the best by our own score, and others spread evenly over
// the rest of that order. Regret is the reference's cost of our choice less its best. Two
// references of other seeds share no sample; what each loses by the other's best is their
// agreement. Costs are not negative, so a motion is given up as soon as its samples alone make it
// dearer than the best so far: the best is the same. One row per pile, without --rows on standard
// output; seeds that ROWS holds are skipped.

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "models/arm/arm.h"
#include "models/base/config/config.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "models/cell_model.h"
#include "planner/evaluator/evaluator.h"
#include "planner/grasp/grasps.h"
#include "planner/pick/make_path.h"
#include "planner/pick/pick_planner.h"
#include "planner/pick/rollout_scheduler.h"
#include "scenes/pile.h"
#include "tests/support/paper_cell.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

const std::vector<Vector3> kNoPoints;

constexpr int kSamples = 5;
// The evaluator's: what a sample adds in which another tube comes along, a jam, a divergence.
constexpr double kExtraCost_m = 1.0, kJamCost_m = 1.0, kDivergedCost_m = 10.0;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr int kMostSeedsPerPile = 20;

// Ways of one tip have one name.
bool SameWay(const ObjectPath& a, const ObjectPath& b) {
  return a.waypoints_N == b.waypoints_N &&
         std::equal(a.rotations_N.begin(), a.rotations_N.end(), b.rotations_N.begin(),
                    b.rotations_N.end(),
                    [](const auto& p, const auto& q) { return p.coeffs() == q.coeffs(); });
}

struct Options {
  std::string part = "hose_b", arrangement = "threaded", rows;
  int count = 7, piles = 1, from = 1, motions = 12, threads = 1;
  bool exclude_free = false;
  std::vector<std::string> overrides;
};

Options ParseOptions(int argc, char** argv) {
  Options out;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const auto value = [&] {
      if (++i >= argc) throw Error(ErrorKind::kUsage, name + ": a value is needed");
      return std::string(argv[i]);
    };
    const auto number = [&] { return std::stoi(value()); };
    if (name == "--part") {
      out.part = value();
    } else if (name == "--arrangement") {
      out.arrangement = value();
    } else if (name == "--rows") {
      out.rows = value();
    } else if (name == "--set") {
      out.overrides.push_back(value());
    } else if (name == "--exclude-free") {
      out.exclude_free = true;
    } else if (name == "--count") {
      out.count = number();
    } else if (name == "--piles") {
      out.piles = number();
    } else if (name == "--from") {
      out.from = number();
    } else if (name == "--motions") {
      out.motions = number();
    } else if (name == "--threads") {
      out.threads = number();
    } else {
      throw Error(ErrorKind::kUsage, "unknown option " + name);
    }
  }
  return out;
}

/// A motion, where its tube is held, and what our own few samples made of it.
struct Offer {
  CandidateMotion motion;
  double at_m = 0.0;
  double own_m = 0.0;  ///< Displacement, and a metre per tube that is expected to come along.
};

Json ToJson(const Offer& offer) {
  return Json{{"tube", offer.motion.tube},
              {"motion", offer.motion.name},
              {"at_m", offer.at_m},
              {"own_m", offer.own_m}};
}

/// One finer evaluator over the offers of a pile, which must outlive it; remembers its samples.
class Reference {
 public:
  Reference(const TubeScene& scene, const Pile& pile, const std::vector<Offer>& offers,
            std::uint64_t seed, int threads)
      : scene_(scene),
        pile_(pile),
        offers_(offers),
        seed_(seed),
        evaluate_(MakeEvaluator({Parallelism{threads}, Fine(), FirstGripper()})),
        sums_(offers.size()) {}

  /// The cost of an offer by all samples, or a lower bound above `limit_m` of it.
  double CostOf(int k, double limit_m = kNoLimit) {
    Sum& sum = sums_[k];
    while (sum.samples < kSamples && AtLeast(sum) <= limit_m) Add(k);
    return AtLeast(sum);
  }

  /// The cheapest offer; `first` are asked about before the others.
  int Best(const std::vector<int>& first) {
    std::vector<int> order = first;
    for (int k = 0; k < static_cast<int>(offers_.size()); ++k) order.push_back(k);
    int best = order.front();
    for (const int k : order) {
      if (CostOf(k, CostOf(best)) < CostOf(best)) best = k;
    }
    return best;
  }

  Json Report(int k) {
    const double cost_m = CostOf(k);
    const Sum& sum = sums_[k];
    Json out = ToJson(offers_[k]);
    out["cost_m"] = cost_m;
    out["displacement_m"] = sum.displacement_m / kSamples;
    out["extra"] = sum.extra;
    out["jammed"] = sum.jammed;
    out["diverged"] = sum.diverged;
    return out;
  }

 private:
  struct Sum {
    int samples = 0, extra = 0, jammed = 0, diverged = 0;
    double displacement_m = 0.0;
  };

  static EvaluatorConfig Fine() {
    EvaluatorConfig config;
    config.timestep_s = 0.001;
    config.tolerance = 1e-8;
    config.give_up_m = 1000.0;
    return config;
  }

  /// Of the mean over all samples, from those that are known; the cost where all are.
  static double AtLeast(const Sum& sum) {
    double cost = (sum.displacement_m + kExtraCost_m * sum.extra) / kSamples;
    if (sum.diverged > 0) return cost + kDivergedCost_m;
    return 2 * sum.jammed >= kSamples ? cost + kJamCost_m : cost;
  }

  void Add(int k) {
    EvaluationRequest request;
    request.candidates = {offers_[k].motion};
    request.grasp_at_m = {offers_[k].at_m};
    request.first_sample = 1 + sums_[k].samples;  // The nominal one is the same for all seeds.
    request.seed = seed_;
    const CandidateScore score =
        evaluate_(scene_, pile_.part, pile_.bin, request).candidates.front();
    Sum& sum = sums_[k];
    ++sum.samples;
    sum.displacement_m += score.displacement_m;
    sum.extra += score.extra_probability > 0.5 ? 1 : 0;
    sum.jammed += score.status == CandidateScore::Status::kJammed ? 1 : 0;
    sum.diverged += score.status == CandidateScore::Status::kDiverged ? 1 : 0;
  }

  const TubeScene& scene_;
  const Pile& pile_;
  const std::vector<Offer>& offers_;
  const std::uint64_t seed_;
  const EvaluateFunction evaluate_;
  std::vector<Sum> sums_;
};

class Trial {
 public:
  Trial(const Options& options, const Pile& pile, const TubeScene& scene)
      : options_(options),
        pile_(pile),
        scene_(scene),
        motion_(PaperCell(), pile.bin),
        feasible_(PathFeasibility(motion_, pile_.bin, paths_, pile.part.radius_m)) {
    ConfigSource source;
    for (const std::string& text : options.overrides) source.AddOverride(text);
    source.Read([this](ConfigVisitor& v) {
      v.Section("planner", "", planner_);
      v.Section("evaluator", "", evaluator_);
    });
    planner_.exclude_free = true;
  }

  Json Run() {
    const PlanResult plan =
        PlanPicks({scene_, kNoPoints, pile_.part, pile_.bin, FirstGripper(), planner_,
                   ExtractionMotionsOf(planner_)},
                  MakeEvaluator({Parallelism{options_.threads}, evaluator_, FirstGripper()}),
                  feasible_, pile_.seed);
    Json row{{"choice", nullptr}, {"asked", plan.evaluation.candidates.size()}};
    if (plan.plans.empty()) return row;
    const PickPlan& chosen = plan.plans.front();
    std::vector<Offer> offers = Compared(plan);
    row["runnable"] = runnable_;
    row["compared"] = offers.size();
    row["choice"] = ToJson(offers.front());
    row["choice"]["predicted"] = ToJson(chosen.prediction);
    row["choice"]["cost"] = chosen.cost;

    Reference one(scene_, pile_, offers, 2 * pile_.seed + 1000000, options_.threads);
    Reference two(scene_, pile_, offers, 2 * pile_.seed + 1000001, options_.threads);
    const int best_one = one.Best({0}), best_two = two.Best({0, best_one});
    row["regret_m"] = {one.CostOf(0) - one.CostOf(best_one), two.CostOf(0) - two.CostOf(best_two)};
    // What each loses by the other's best.
    row["agreement_m"] = {one.CostOf(best_two) - one.CostOf(best_one),
                          two.CostOf(best_one) - two.CostOf(best_two)};
    row["choice_by"] = {one.Report(0), two.Report(0)};
    row["best"] = {one.Report(best_one), two.Report(best_two)};
    return row;
  }

 private:
  /// Where the arm can hold a tube for a motion.
  std::optional<double> RunnableAt(const CandidateMotion& motion) const {
    const auto tube =
        std::find_if(scene_.tubes.begin(), scene_.tubes.end(),
                     [&](const PerceivedTube& seen) { return seen.id == motion.tube; });
    double top_m = 0.0;
    for (const PerceivedTube& seen : scene_.tubes) {
      for (const Vector3& p : seen.centerline_N) top_m = std::max(top_m, p.z());
    }
    const GraspInput input{scene_,         kNoPoints, pile_.bin,
                           FirstGripper(), planner_,  planner_.grasp_step_m};
    const GraspSites sites = FindGraspSites(input, *tube);
    for (Grasp& grasp : RankGrasps(input, sites, *tube, motion, 0.0, top_m).grasps) {
      if (!feasible_(grasp, motion)) return grasp.at_m;
      grasp.X_NG.linear() = grasp.X_NG.linear() * RotZ(kPi);
      if (!feasible_(grasp, motion)) return grasp.at_m;
    }
    return std::nullopt;
  }

  /// The chosen motion first, then those that it is compared with.
  std::vector<Offer> Compared(const PlanResult& plan) {
    const PickPlan& chosen = plan.plans.front();
    std::vector<Offer> others;
    Offer choice{chosen.motion, chosen.grasp.at_m, 0.0};
    for (const CandidateScore& score : plan.evaluation.candidates) {
      const double own_m = score.displacement_m +
                           kExtraCost_m * ExtraProbability(score, pile_.part) +
                           (score.status == CandidateScore::Status::kJammed ? kJamCost_m : 0.0);
      if (score.tube == chosen.target && score.motion == chosen.motion.name) {
        choice.own_m = own_m;
        continue;
      }
      const auto motion = std::find_if(
          plan.candidates.begin(), plan.candidates.end(), [&](const CandidateMotion& candidate) {
            return candidate.tube == score.tube && candidate.name == score.motion &&
                   SameWay(candidate, score);
          });
      if (const std::optional<double> at_m = RunnableAt(*motion)) {
        others.push_back({*motion, *at_m, own_m});
      }
    }
    runnable_ = static_cast<int>(others.size()) + 1;
    std::stable_sort(others.begin(), others.end(),
                     [](const Offer& a, const Offer& b) { return a.own_m < b.own_m; });
    std::vector<Offer> out = {choice};
    const int room = std::min(options_.motions - 1, static_cast<int>(others.size()));
    const int best = std::clamp(options_.motions / 2 - 1, 0, room);
    out.insert(out.end(), others.begin(), others.begin() + best);
    const int rest = static_cast<int>(others.size()) - best, spread = room - best;
    for (int k = 0; k < spread; ++k) {
      out.push_back(others[best + (2 * k + 1) * rest / (2 * spread)]);
    }
    return out;
  }

  const Options& options_;
  const Pile& pile_;
  const TubeScene& scene_;
  const MotionPlanner motion_;
  const PathConfig paths_;
  const FeasibilityFunction feasible_;
  PlannerConfig planner_;
  EvaluatorConfig evaluator_;
  int runnable_ = 0;
};

/// One pile's row; "left_out" where it has a free tube that it must not have.
Json RowOf(const Options& options, int seed) {
  const Part part = LoadPart(options.part);
  const Pile pile = GeneratePile(part, Bin(), options.count, options.arrangement,
                                 static_cast<std::uint64_t>(seed), NominalPhysics(part))
                        .pile;
  std::vector<Polyline> lines_N;
  for (const PileTube& tube : pile.tubes) lines_N.push_back(tube.centerline_N);
  const TubeScene scene = PerfectScene(lines_N, part.radius_m);
  const int free = static_cast<int>(
      std::count_if(scene.tubes.begin(), scene.tubes.end(),
                    [](const PerceivedTube& tube) { return tube.tube_class == TubeClass::kFree; }));
  Json row{{"seed", seed},
           {"part", part.name},
           {"arrangement", options.arrangement},
           {"tubes", scene.tubes.size()},
           {"free", free}};
  row["left_out"] = options.exclude_free ? free == options.count : free > 0;
  if (!row["left_out"].get<bool>()) row.update(Trial(options, pile, scene).Run());
  return row;
}

/// Rows of before, by seed; a line that was cut off is none.
std::vector<Json> RowsOf(const std::string& path) {
  std::vector<Json> out;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    Json row = Json::parse(line, nullptr, false);
    if (!row.is_discarded()) out.push_back(std::move(row));
  }
  return out;
}

int Run(const Options& options) {
  const std::vector<Json> before = RowsOf(options.rows);
  int kept = 0;
  for (int seed = options.from; kept < options.piles; ++seed) {
    if (seed - options.from >= kMostSeedsPerPile * options.piles) {
      std::fprintf(stderr, "regret: %d piles of %d asked, seeds %d to %d hold no more\n", kept,
                   options.piles, options.from, seed - 1);
      return 1;
    }
    const auto found = std::find_if(before.begin(), before.end(), [&](const Json& row) {
      return row.at("seed").get<int>() == seed;
    });
    const Json row = found != before.end() ? *found : RowOf(options, seed);
    if (!row.at("left_out").get<bool>()) ++kept;
    if (found != before.end()) continue;
    if (options.rows.empty()) {
      std::cout << row.dump() << std::endl;
    } else {
      std::ofstream(options.rows, std::ios::app) << row.dump() + "\n" << std::flush;
    }
  }
  return 0;
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) {
  try {
    return tubetwin::Run(tubetwin::ParseOptions(argc, argv));
  } catch (const tubetwin::Error& e) {
    std::fprintf(stderr, "regret: %s\n", e.what());
    return 65;
  }
}
