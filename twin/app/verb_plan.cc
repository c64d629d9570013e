#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "perception/perceive.h"
#include "planner/evaluator/evaluator.h"
#include "planner/pick/make_path.h"
#include "planner/pick/nudge.h"
#include "planner/pick/pick_planner.h"
#include "planner/pick/runnable_plan.h"
#include "planner/scene_query/voxel_downsample.h"
#include "twin/app/common.h"
#include "twin/app/input/cloud_input.h"
#include "twin/app/input/file_advice.h"

namespace tubetwin {
namespace {

// Of the cycle the way of the arm; what it does with a load is not planned.
const UsedKeys kKeysOfPlanning = {"seed",
                                  "profile",
                                  "scan.views",
                                  "scan.overhead_m",
                                  "planner",
                                  "evaluator",
                                  "cycle.transfer_speed_m_s",
                                  "cycle.transfer_acceleration_m_s2",
                                  "cycle.approach_speed_m_s",
                                  "cycle.guarded_speed_m_s",
                                  "cycle.approach_m",
                                  "cycle.guarded_m",
                                  "cycle.first_lift_m",
                                  "cell.model",
                                  "calibration"};

/// `first`, then what planning uses.
UsedKeys PlanningKeysAnd(UsedKeys first) {
  first.insert(first.end(), kKeysOfPlanning.begin(), kKeysOfPlanning.end());
  return first;
}

/// What is planned in: perceived tubes, and the points of the clouds where these are given.
struct Seen {
  TubeScene scene;
  Part part;
  Bin bin;
  std::vector<Vector3> points_N;
};

Seen ReadScene(const CloudInput& input, const Scenario& scenario, const Common& common) {
  const std::string& file = input.clouds.front();
  if (!input.units.empty()) {
    throw Error(ErrorKind::kUsage, file + ": --units is for clouds; tubes.json is in metres");
  }
  const Json json = ReadJsonFile(file);
  const JsonView document(json, file);
  if (document.IsObject() && json.value("schema", Json()) == "tubetwin/pile/1") {
    throw Error(ErrorKind::kBadData,
                file + ": is a pile; allowed: perceived tubes, or clouds" + AdviceFor(file));
  }
  Seen seen{TubeSceneFromJson(document), {}, {}, {}};
  if (!input.part.empty()) {
    seen.part = LoadPart(input.part);
  } else if (const auto named = document.Optional("part")) {
    seen.part = PartFromJson(*named);
  } else {
    throw Error(ErrorKind::kUsage, file + ": names no part; give --part");
  }
  const bool has_bin = document.Optional("bin").has_value();
  // What is read of tubes.json needs no perception; its bin says where it stands.
  RequireUsedKeys(common,
                  PlanningKeysAnd(has_bin ? UsedKeys{"bin.size_m", "bin.mesh", "bin.mesh_units"}
                                          : BinKeysAnd({})),
                  "of tubes.json");
  seen.bin = ScenarioBin(scenario, std::nullopt);
  if (!has_bin && input.bin.empty()) {
    const auto& size_m = seen.bin.size_m;
    Say(common, file + ": names no bin; planned in the cell's, " + Number(size_m[0]) + " x " +
                    Number(size_m[1]) + " x " + Number(size_m[2]) + " m");
  }
  if (has_bin) {
    const std::optional<std::array<double, 3>> asked_m = AskedOverrides(scenario).bin_size_m;
    seen.bin = BinFromJson(document.Field("bin"));
    if (asked_m) seen.bin.size_m = *asked_m;
  }
  if (!input.bin.empty()) seen.bin.size_m = ParseBinSize(input.bin);
  return seen;
}

Seen PerceiveScene(const CloudInput& input, const Scenario& scenario, const Common& common) {
  if (input.part.empty()) throw Error(ErrorKind::kUsage, "plan of clouds: --part is needed");
  Seen seen{{}, LoadPart(input.part), ScenarioBin(scenario, std::nullopt), {}};
  if (!input.bin.empty()) seen.bin.size_m = ParseBinSize(input.bin);
  const std::vector<OrganizedCloud> views = ReadViews(input, seen.bin, common).clouds;
  seen.scene = Perceive(views, seen.part, seen.bin, scenario.perception, common.parallelism());
  seen.points_N = VoxelDownsample(views, seen.bin);
  return seen;
}

/// Where the arm stands when the cycle plans: at the last view, the fingers open.
PathStart AfterLooking(const MotionPlanner& planner, const Scenario& scenario, const Bin& bin,
                       double radius_m) {
  PathStart start;
  start.opening_m = planner.model().gripper.stroke_m;
  const RigidTransform X_BE =
      planner.PoseOfEForScan(ScanPoses(scenario.scan, planner.model(), bin, radius_m).back());
  if (const auto q = planner.Reach(X_BE)) start.q = *q;
  return start;
}

void Report(const PlanResult& result, const std::optional<RunnablePlan>& chosen,
            const std::optional<Nudge>& nudge) {
  if (nudge) {
    Print("no plan; tube %d would be nudged by %.0f mm; %zu rejections\n", nudge->tube,
          1e3 * nudge->travel_m, result.rejections.size());
  } else if (!chosen) {
    Print("no plan; %zu rejections\n", result.rejections.size());
  } else {
    const PickPlan& best = result.plans[chosen->index];
    Print("%zu plans; best: tube %d (%s) by %s, cost %.3f%s\n", result.plans.size(), best.target,
          ToString(best.target_class), best.motion.name.c_str(), best.cost,
          best.used_simulator ? ", simulated" : "");
  }
}

int Plan(const CloudInput& input, const Common& common) {
  const Scenario scenario = LoadScenario({}, common, input.profile);
  const bool one_scene = input.clouds.size() == 1 && input.clouds.front().ends_with(".json");
  const Seen seen =
      one_scene ? ReadScene(input, scenario, common) : PerceiveScene(input, scenario, common);
  const CellModel model = ScenarioModel(scenario);
  const GripperGeometry gripper = MakeGripperGeometry(model);
  const MotionPlanner planner(model, seen.bin);
  const PickProblem problem{seen.scene,
                            seen.points_N,
                            seen.part,
                            seen.bin,
                            gripper,
                            scenario.planner,
                            ExtractionMotionsOf(scenario.planner)};
  const FeasibilityFunction feasible =
      PathFeasibility(planner, seen.bin, scenario.cycle, seen.part.radius_m);
  PlanResult result =
      PlanPicks(problem, MakeEvaluator({common.parallelism(), scenario.evaluator, gripper}),
                feasible, static_cast<std::uint64_t>(scenario.seed));
  const auto chosen = FirstRunnable(problem, result.plans, planner, scenario.cycle,
                                    AfterLooking(planner, scenario, seen.bin, seen.part.radius_m),
                                    result.rejections);
  NudgeResult nudge;
  if (!chosen && scenario.planner.nudges > 0) {
    nudge = PlanNudge(problem, feasible,
                      NudgePathFeasibility(planner, seen.bin, scenario.cycle, scenario.planner));
    result.rejections.insert(result.rejections.end(), nudge.rejections.begin(),
                             nudge.rejections.end());
  }
  Json out = ToJson(result);
  out["chosen"] = chosen ? Json(chosen->index) : Json(nullptr);
  out["nudge"] = ToJson(nudge.nudge);
  if (nudge.nudge) {
    out["nudge"]["max_press_N"] = scenario.planner.nudge_press_N;
    out["nudge"]["max_force_N"] = scenario.planner.nudge_force_N;
  }
  WriteJsonFile(out, common.out);
  Report(result, chosen, nudge.nudge);
  return 0;
}

}  // namespace

void AddPlanVerb(CLI::App& app, Common& common) {
  auto input = std::make_shared<CloudInput>();
  CLI::App* verb = app.add_subcommand(
      "plan",
      "Example: tubetwin plan tubes.json --out plan.json\n\n"
      "What the pick cycle would do next: candidate motions, grasps, ranking, the chosen plan, and "
      "the reasons for rejections. From perceived tubes, or from clouds, whose points grasps then "
      "keep clear of.");
  verb->add_option("input", input->clouds, "tubes.json, or PCD or PLY files, one per view")
      ->required();
  AddCloudOptions(*verb, *input)
      ->description("Part name or part file; default: what tubes.json names");
  AddCommonOptions(*verb, common, PlanningKeysAnd(BinKeysAnd({"perception"})), "plan.json to write",
                   true);
  verb->callback(
      [input, &common] { common.action = [input, &common] { return Plan(*input, common); }; });
}

}  // namespace tubetwin
