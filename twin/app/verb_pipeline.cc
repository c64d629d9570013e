#include <algorithm>
#include <cmath>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "models/base/cloud/cloud.h"
#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/text.h"
#include "planner/evaluator/evaluator.h"
#include "planner/pick/planner_config.h"
#include "twin/app/common.h"
#include "twin/app/input/file_advice.h"
#include "twin/render/scan/scan_geometry.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

// ---- scan ----

struct ScanOptions {
  std::string pile, view = "all", part, bin;
  bool labels = false;
};

ScanGeometry GeometryOf(const Pile& pile) {
  ScanGeometry out;
  const auto albedo = static_cast<float>(pile.part.albedo());
  const auto gloss = static_cast<float>(pile.part.gloss);
  for (std::size_t k = 0; k < pile.tubes.size(); ++k) {
    const Polyline line_B = Transformed(pile.bin.X_BN, pile.tubes[k].centerline_N);
    for (const AxisPiece& piece : PiecesWithin(line_B, pile.tubes[k].radius_m)) {
      out.capsules.push_back({piece.from, piece.to, pile.tubes[k].radius_m,
                              kLabelFirstTube + static_cast<std::uint32_t>(k), albedo, gloss});
    }
  }
  const double x = pile.bin.half_x_m(), y = pile.bin.half_y_m(), h = 0.5 * pile.bin.wall_m();
  const double t = 0.5 * Bin::kWallThickness_m;
  const auto box = [&](const Vector3& centre_N, const Vector3& half_m) {
    out.boxes.push_back({pile.bin.X_BN * Translation(centre_N), half_m, kLabelCell, kCellAlbedo});
  };
  box({0, 0, -t}, {x + 2 * t, y + 2 * t, t});
  for (const double side : {-1.0, 1.0}) {
    box({side * (x + t), 0, h}, {t, y + 2 * t, h});
    box({0, side * (y + t), h}, {x + 2 * t, t, h});
  }
  return out;
}

std::vector<std::size_t> ChosenViews(const std::string& text, std::size_t count) {
  std::vector<std::size_t> out;
  if (text == "all") {
    for (std::size_t i = 0; i < count; ++i) out.push_back(i);
    return out;
  }
  char* end = nullptr;
  const long n = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || n < 0 || n >= static_cast<long>(count)) {
    throw Error(ErrorKind::kUsage,
                "--view '" + text + "': all, or 0 to " + std::to_string(count - 1) + " is needed");
  }
  out.push_back(static_cast<std::size_t>(n));
  return out;
}

int ScanPile(const ScanOptions& scan, const Common& common) {
  const Scenario scenario = LoadScenario({}, common);
  const Pile pile = LoadGivenPile(scan.pile, GivenPile(scan.part, scan.bin, scenario, common));
  const std::uint64_t seed = static_cast<std::uint64_t>(scenario.seed);
  const RoundPhysics physics = ScenarioPhysics(scenario, pile.part);
  const CellModel model = ScenarioModel(scenario);
  ScanSettings settings = ScenarioScan(scenario, model, physics);
  settings.labels = scan.labels;
  const ScanGeometry geometry = GeometryOf(pile);
  const std::vector<RigidTransform> poses_BS =
      ScanPoses(scenario.scan, model, pile.bin, pile.part.radius_m);
  MakeFolder(common.out);
  for (const std::size_t i : ChosenViews(scan.view, poses_BS.size())) {
    const RigidTransform X_BS_true = poses_BS[i] * physics.X_SbelievedS;
    OrganizedCloud cloud =
        CastScan(geometry, X_BS_true, settings, RandomStream(seed, 0, "scan").Fork("view", i),
                 common.parallelism());
    cloud.X_NS = pile.bin.X_BN.inverse() * poses_BS[i];
    const std::string base = (fs::path(common.out) / ("view_" + std::to_string(i))).string();
    WritePcd(cloud, base + ".pcd");
    WritePly(cloud, base + ".ply");
    if (scan.labels) {
      WriteJsonFile(Json{{"X_NS_true", ToJson(pile.bin.X_BN.inverse() * X_BS_true)}},
                    base + ".truth.json");
    }
  }
  return 0;
}

// ---- evaluate ----

struct EvaluateOptions {
  std::string pile, part, bin, motions = "all";
  std::optional<int> tube;
  int samples = 1;
  bool full = false;
};

/// Every motion of the tube, of the variants of one name the first.
std::vector<CandidateMotion> AllMotions(const ExtractionInput& input) {
  std::vector<CandidateMotion> motions;
  for (const ExtractionMotion& kind : ExtractionMotionsOf(input.config)) {
    for (CandidateMotion& motion : kind.make(input).motions) {
      if (motion.variant == 0) motions.push_back(std::move(motion));
    }
  }
  return motions;
}

EvaluationRequest MakeRequest(const TubeScene& scene, const Pile& pile,
                              const EvaluateOptions& given, const PlannerConfig& planner) {
  EvaluationRequest request;
  request.samples = given.samples;
  request.full = given.full;
  bool found = false;
  for (const PerceivedTube& tube : scene.tubes) {
    if (given.tube && tube.id != *given.tube) continue;
    found = true;
    for (CandidateMotion& motion : AllMotions({scene, tube, pile.bin, planner})) {
      const bool up = motion.kind == "up";
      const bool escape = motion.kind == "escape" || motion.kind == "escape_away";
      if ((given.motions == "up" && !up) || (given.motions == "escape" && !escape)) continue;
      request.grasp_at_m.push_back(0.5 * tube.length_m);
      request.candidates.push_back(std::move(motion));
    }
  }
  if (!found) {
    std::vector<std::string> ids;
    for (const PerceivedTube& tube : scene.tubes) ids.push_back(std::to_string(tube.id));
    throw Error(ErrorKind::kBadData, "--tube " + std::to_string(*given.tube) + ": " + given.pile +
                                         " has the tubes " + Join(ids));
  }
  return request;
}

int EvaluatePile(const EvaluateOptions& given, const Common& common) {
  const Scenario scenario = LoadScenario({}, common);
  const Pile pile = LoadGivenPile(given.pile, GivenPile(given.part, given.bin, scenario, common));
  const TubeScene scene = SceneOfPile(pile);
  EvaluationRequest request = MakeRequest(scene, pile, given, scenario.planner);
  request.seed = static_cast<std::uint64_t>(scenario.seed);
  const EvaluateFunction evaluate = MakeEvaluator(
      {common.parallelism(), scenario.evaluator, MakeGripperGeometry(ScenarioModel(scenario))});
  const EvaluationResult result = evaluate(scene, pile.part, pile.bin, request);
  const Json json = ToJson(result);
  WriteJsonFile(json, common.out);
  if (common.json) {
    PrintJson(json);
  } else if (!common.quiet) {
    Print("tube  motion      status    displacement_m  extra  cost\n");
    for (const CandidateScore& score : result.candidates) {
      Print("%4d  %-10s  %-8s  %14.4f  %5.2f  %.4f\n", score.tube, score.motion.c_str(),
            ToString(score.status), score.displacement_m, score.extra_probability, score.cost);
    }
  }
  return 0;
}

}  // namespace

namespace {

/// What the picture of a pile that lies still depends on.
UsedKeys KeysOfScan() {
  return PileKeysAnd({"seed",
                      "physics.randomize",
                      "physics.depth_noise_scale",
                      "physics.hand_eye_error_m",
                      "physics.hand_eye_error_deg",
                      "scan.views",
                      "scan.resolution",
                      "scan.overhead_m",
                      "cell.model",
                      "calibration.X_BS",
                      "cell.scanner.hand_eye_error",
                      "cell.scanner.shadows",
                      "cell.scanner.hard_range",
                      "cell.scanner.soft_range",
                      "cell.scanner.incidence",
                      "cell.scanner.weak_signal",
                      "cell.scanner.highlights",
                      "cell.scanner.flying_pixels",
                      "cell.scanner.interreflections",
                      "cell.scanner.noise",
                      "cell.scanner.bias"});
}

/// What motions and roll-outs of the evaluator alone depend on: no grasp is chosen.
UsedKeys KeysOfEvaluate() {
  return PileKeysAnd({"seed", "profile", "planner.lift_m", "planner.escape_first_lift_m",
                      "planner.escape_const_m", "planner.wall_safety_m", "planner.lift_speed_m_s",
                      "planner.motions", "planner.classes", "evaluator", "cell.model",
                      "calibration.X_FK", "calibration.X_FE"});
}

}  // namespace

void AddScanVerb(CLI::App& app, Common& common) {
  auto given = std::make_shared<ScanOptions>();
  CLI::App* verb =
      app.add_subcommand("scan",
                         "Example: tubetwin scan p.json --view all --labels --out out/scan\n\n"
                         "What the scanner would see: organised PCD and PLY per view.");
  verb->add_option("pile", given->pile, "pile.json, CSV or the public set's text")->required();
  verb->add_option("--view", given->view, "all, or the number of one view");
  verb->add_option("--part", given->part, "Part name or part file");
  verb->add_option("--bin", given->bin, "Inner size of the bin: long,short,wall in metres");
  verb->add_flag("--labels", given->labels,
                 "Write each point's tube and the true pose, for scoring");
  AddCommonOptions(*verb, common, KeysOfScan(), "Folder for view_N.pcd and .ply", true);
  verb->callback(
      [given, &common] { common.action = [given, &common] { return ScanPile(*given, common); }; });
}

void AddEvaluateVerb(CLI::App& app, Common& common) {
  auto given = std::make_shared<EvaluateOptions>();
  CLI::App* verb = app.add_subcommand(
      "evaluate",
      "Example: tubetwin evaluate p.json --motions all --samples 3 --out scores.json\n\n"
      "The evaluator alone: what lifting each tube would do to the others.");
  verb->add_option("pile", given->pile, "pile.json, CSV or the public set's text")->required();
  verb->add_option("--part", given->part, "Part name or part file");
  verb->add_option("--bin", given->bin, "Inner size of the bin: long,short,wall in metres");
  verb->add_option("--tube", given->tube, "Only this tube's candidates");
  verb->add_option("--motions", given->motions, "Which candidates")
      ->check(CLI::IsMember({"up", "escape", "all"}));
  verb->add_option("--samples", given->samples, "Roll-outs per candidate")
      ->check(CLI::Range(1, 1000));
  verb->add_flag("--full", given->full, "Nothing pruned or cut short");
  AddCommonOptions(*verb, common, KeysOfEvaluate(), "scores.json to write", true);
  verb->callback([given, &common] {
    common.action = [given, &common] { return EvaluatePile(*given, common); };
  });
}

}  // namespace tubetwin
