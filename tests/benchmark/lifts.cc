// What the evaluator predicts against what then happens under another draw of the physics, lift by
// lift; lifts.sh runs it and lifts.py makes the tables.
//
//   lifts --part P --count N --arrangement A --seeds FROM TO --rows ROWS.jsonl [--samples K]
//         [--threads N]
//
// Each seed: a pile made under a drawn physics A, seen by the cell's eight views with noise and
// hand-eye error, modelled. Then one motion of each covered tube, drawn at random ("lift" rows),
// and the plan with the free tubes excluded ("choice" rows) are carried out on the true pile in a
// simulation of 1 ms with the physics A, and once more with another draw B: its own rest shapes,
// friction, stiffness and masses, which the evaluator does not know. The tube is held by a
// force-limited hand there, as in the evaluator; the cell's friction grasp is what campaigns try.
// Seeds that ROWS holds are skipped.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "models/arm/arm.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "models/cell_model.h"
#include "perception/perceive.h"
#include "planner/evaluator/evaluator.h"
#include "planner/evaluator/rollout.h"
#include "planner/grasp/grasps.h"
#include "planner/pick/make_path.h"
#include "planner/pick/pick_planner.h"
#include "planner/pick/rollout_scheduler.h"
#include "planner/scene_query/voxel_downsample.h"
#include "scenes/pile.h"
#include "tests/support/paper_cell.h"
#include "tests/support/paper_scan.h"
#include "tests/support/planning.h"
#include "twin/render/scan/ray_scene.h"

namespace tubetwin {
namespace {

struct Options {
  std::string part = "hose_b", arrangement = "threaded", rows;
  int count = 7, from = 1, to = 10, samples = 5, threads = 2;
};

Options ParseOptions(int argc, char** argv) {
  Options out;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const auto value = [&] {
      if (++i >= argc) throw Error(ErrorKind::kUsage, name + ": a value is needed");
      return std::string(argv[i]);
    };
    if (name == "--part") {
      out.part = value();
    } else if (name == "--arrangement") {
      out.arrangement = value();
    } else if (name == "--rows") {
      out.rows = value();
    } else if (name == "--count") {
      out.count = std::stoi(value());
    } else if (name == "--seeds") {
      out.from = std::stoi(value());
      out.to = std::stoi(value());
    } else if (name == "--samples") {
      out.samples = std::stoi(value());
    } else if (name == "--threads") {
      out.threads = std::stoi(value());
    } else {
      throw Error(ErrorKind::kUsage, "unknown option " + name);
    }
  }
  if (out.rows.empty()) throw Error(ErrorKind::kUsage, "--rows FILE is needed");
  return out;
}

ScanGeometry GeometryOf(const Pile& pile) {
  ScanGeometry out;
  const auto albedo = static_cast<float>(pile.part.albedo());
  const auto gloss = static_cast<float>(pile.part.gloss);
  for (const PileTube& tube : pile.tubes) {
    for (const AxisPiece& piece : PiecesWithin(tube.centerline_N, tube.radius_m)) {
      out.capsules.push_back({piece.from, piece.to, tube.radius_m, kLabelFirstTube, albedo, gloss});
    }
  }
  const double x = pile.bin.half_x_m(), y = pile.bin.half_y_m(), h = 0.5 * pile.bin.wall_m();
  const double t = 0.5 * Bin::kWallThickness_m;
  const auto box = [&](const Vector3& centre_N, const Vector3& half_m) {
    out.boxes.push_back({Translation(centre_N), half_m, kLabelCell, kCellAlbedo});
  };
  box({0, 0, -t}, {x + 2 * t, y + 2 * t, t});
  for (const double side : {-1.0, 1.0}) {
    box({side * (x + t), 0, h}, {t, y + 2 * t, h});
    box({0, side * (y + t), h}, {x + 2 * t, t, h});
  }
  return out;
}

std::vector<OrganizedCloud> Look(const Pile& pile, const RoundPhysics& physics,
                                 const RandomStream& stream, const Options& options) {
  std::vector<OrganizedCloud> views;
  ScanSettings settings = PaperScan();
  settings.noise_scale = physics.depth_noise_scale;
  const ScanGeometry geometry = GeometryOf(pile);
  for (const RigidTransform& X_BS : ScanPosesOf(PaperCell(), pile.bin)) {
    const RigidTransform X_NS = pile.bin.X_BN.inverse() * X_BS;
    views.push_back(CastScan(geometry, X_NS * physics.X_SbelievedS, settings,
                             stream.Fork("view", views.size()), Parallelism{options.threads}));
    views.back().X_NS = X_NS;
  }
  return views;
}

/// The true pile under one draw, with a model and data of its own.
class TrueWorld {
 public:
  TrueWorld(const Pile& pile, const RoundPhysics& physics)
      : scene_(Scaled(pile.tubes, physics.mass_scale), pile.part, pile.bin, physics.tube_friction,
               physics.bending_stiffness_Nm2, {Parallelism{1}, Fine(), FirstGripper()}),
        model_(mj_copyModel(nullptr, &scene_.model())),
        data_(MakeData(*model_)) {}

  /// Tube `index`, held at the point of it that is nearest to p_N.
  Json Lift(int index, const Vector3& p_N, const CandidateMotion& motion) {
    const Polyline& line = scene_.tubes()[index].initial().centerline_N;
    const double share = Closest(line, p_N).s_m / Length(line);
    const RolloutOutcome outcome =
        RollOut(scene_, index, share, motion, true, Fine(), *model_, *data_);
    return Json{{"extra", outcome.extra},
                {"displacement_m", outcome.displacement_m},
                {"status", ToString(outcome.status)}};
  }

 private:
  static std::vector<PileTube> Scaled(std::vector<PileTube> tubes, double scale) {
    for (PileTube& tube : tubes) tube.mass_kg *= scale;
    return tubes;
  }
  static EvaluatorConfig Fine() {
    EvaluatorConfig config;
    config.timestep_s = 0.001;
    config.tolerance = 1e-8;
    config.hold_s = 1.0;
    return config;
  }

  RolloutScene scene_;
  MjModel model_;
  MjData data_;
};

/// The true tube that a perceived one is, by mean distance of its nodes; -1 beyond 5 mm.
int TrueIndex(const PerceivedTube& seen, const Pile& pile) {
  int best = -1;
  double least = 0.005;
  for (std::size_t k = 0; k < pile.tubes.size(); ++k) {
    double sum = 0.0;
    for (const Vector3& p : seen.centerline_N) {
      sum += Closest(pile.tubes[k].centerline_N, p).distance_m;
    }
    const double mean = sum / static_cast<double>(seen.centerline_N.size());
    if (mean >= least) continue;
    least = mean;
    best = static_cast<int>(k);
  }
  return best;
}

int CoversOf(const TubeScene& scene, int id) {
  return static_cast<int>(std::count_if(scene.crossings.begin(), scene.crossings.end(),
                                        [&](const Crossing& c) { return c.under == id; }));
}

class Trial {
 public:
  Trial(const Options& options, int seed)
      : options_(options),
        seed_(seed),
        stream_(static_cast<std::uint64_t>(seed), 0, "lifts"),
        part_(LoadPart(options.part)),
        a_(DrawPhysics({}, part_, stream_.Fork("a"))),
        b_(DrawPhysics({}, part_, stream_.Fork("b"))),
        pile_(GeneratePile(part_, Bin(), options.count, options.arrangement,
                           static_cast<std::uint64_t>(seed), a_)
                  .pile),
        views_(Look(pile_, a_, stream_.Fork("look"), options)),
        scene_(Perceive(views_, part_, pile_.bin, {}, Parallelism{options.threads})),
        world_a_(pile_, a_),
        world_b_(pile_, b_) {
    config_.samples = options.samples;
    config_.exclude_free = true;
  }

  std::vector<Json> Run() {
    std::vector<Json> rows = Lifts();
    rows.push_back(Choice());
    return rows;
  }

 private:
  Json Row(const char* kind, const PerceivedTube& tube, const CandidateMotion& motion, double at_m,
           const Json& predicted) {
    Json row{{"seed", seed_},
             {"kind", kind},
             {"tube", tube.id},
             {"class", ToString(tube.tube_class)},
             {"covers", CoversOf(scene_, tube.id)},
             {"motion", motion.name},
             {"at_m", at_m},
             {"predicted", predicted}};
    const int index = TrueIndex(tube, pile_);
    row["mistaken"] = index < 0;
    if (index < 0) return row;
    const Vector3 p_N = PointAt(tube.centerline_N, at_m);
    row["a"] = world_a_.Lift(index, p_N, motion);
    row["b"] = world_b_.Lift(index, p_N, motion);
    return row;
  }

  /// One random motion of each covered tube that can be grasped.
  std::vector<Json> Lifts() {
    EvaluationRequest request;
    request.samples = options_.samples;
    request.seed = static_cast<std::uint64_t>(seed_);
    std::vector<const PerceivedTube*> tubes;
    RandomStream pick = stream_.Fork("pick");
    const std::vector<Vector3> points_N = VoxelDownsample(views_, pile_.bin);
    const GraspInput grasps{scene_,         points_N, pile_.bin,
                            FirstGripper(), config_,  config_.grasp_step_m};
    for (const PerceivedTube& tube : scene_.tubes) {
      if (tube.tube_class == TubeClass::kFree) continue;
      const GraspSites sites = FindGraspSites(grasps, tube);
      const MotionSet set = MotionsOf(kPaperKinds, scene_, tube, pile_.bin, config_);
      const auto k = static_cast<std::size_t>(pick.Uniform(0.0, 1.0) * set.motions.size());
      const CandidateMotion& motion = set.motions[std::min(k, set.motions.size() - 1)];
      const GraspSet ranked = RankGrasps(grasps, sites, tube, motion, 0.0, 1.0);
      if (ranked.grasps.empty()) continue;
      request.candidates.push_back(motion);
      request.grasp_at_m.push_back(ranked.grasps.front().at_m);
      tubes.push_back(&tube);
    }
    std::vector<Json> rows;
    if (tubes.empty()) return rows;
    const EvaluationResult result = Evaluate()(scene_, part_, pile_.bin, request);
    for (std::size_t k = 0; k < tubes.size(); ++k) {
      const CandidateScore& score = result.candidates[k];
      Json predicted = ToJson(std::optional(Prediction{
          score.displacement_m, score.extra_probability, static_cast<int>(score.samples.size())}));
      predicted["probability"] = ExtraProbability(score, part_);  // What the choice goes by.
      rows.push_back(
          Row("lift", *tubes[k], request.candidates[k], request.grasp_at_m[k], predicted));
    }
    return rows;
  }

  Json Choice() {
    const MotionPlanner motion(PaperCell(), pile_.bin);
    const std::vector<Vector3> points_N = VoxelDownsample(views_, pile_.bin);
    const PathConfig paths;
    const PlanResult result = PlanPicks(
        {scene_, points_N, part_, pile_.bin, FirstGripper(), config_, ExtractionMotionsOf(config_)},
        Evaluate(), PathFeasibility(motion, pile_.bin, paths, part_.radius_m),
        static_cast<std::uint64_t>(seed_));
    Json row{{"seed", seed_}, {"kind", "choice"}, {"motion", nullptr}};
    if (!result.plans.empty()) {
      const PickPlan& plan = result.plans.front();
      for (const PerceivedTube& tube : scene_.tubes) {
        if (tube.id != plan.target) continue;
        row = Row("choice", tube, plan.motion, plan.grasp.at_m, ToJson(plan.prediction));
      }
    }
    row["planning_s"] = result.planning_s;
    row["evaluator_s"] = result.evaluator_s;
    row["candidates"] = result.evaluation.candidates.size();
    return row;
  }

  EvaluateFunction Evaluate() const {
    return MakeEvaluator({Parallelism{options_.threads}, {}, FirstGripper()});
  }

  const Options& options_;
  const int seed_;
  const RandomStream stream_;
  const Part part_;
  const RoundPhysics a_, b_;
  const Pile pile_;
  const std::vector<OrganizedCloud> views_;
  const TubeScene scene_;
  PlannerConfig config_;
  TrueWorld world_a_, world_b_;
};

std::set<int> DoneSeeds(const std::string& rows) {
  std::set<int> out;
  std::ifstream in(rows);
  for (std::string line; std::getline(in, line);) {
    const Json row = Json::parse(line, nullptr, false);
    // The choice is the last row of its seed.
    if (!row.is_discarded() && row.at("kind") == "choice") out.insert(row.at("seed").get<int>());
  }
  return out;
}

int Run(const Options& options) {
  const std::set<int> done = DoneSeeds(options.rows);
  for (int seed = options.from; seed <= options.to; ++seed) {
    if (done.contains(seed)) continue;
    std::string lines;
    for (const Json& row : Trial(options, seed).Run()) lines += row.dump() + "\n";
    std::ofstream(options.rows, std::ios::app) << lines << std::flush;
  }
  return 0;
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) {
  try {
    return tubetwin::Run(tubetwin::ParseOptions(argc, argv));
  } catch (const tubetwin::Error& e) {
    std::fprintf(stderr, "lifts: %s\n", e.what());
    return 65;
  }
}
