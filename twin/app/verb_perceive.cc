#include <filesystem>

#include <CLI/CLI.hpp>

#include "models/base/cloud/cloud.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/step_timer.h"
#include "models/base/text.h"
#include "perception/label_points.h"
#include "perception/perceive.h"
#include "twin/app/common.h"
#include "twin/app/input/cloud_input.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

/// The ending by which WriteCloud() chooses a format. Throws Error(kUsage) for any other.
std::string LabelledEnding(const std::string& name) {
  const std::string low = LowerCase(fs::path(name).filename().string());
  for (const std::string ending : {".pcd", ".ply", ".pcd.zst"}) {
    if (low.size() > ending.size() && low.ends_with(ending)) return ending;
  }
  throw Error(ErrorKind::kUsage,
              "--labelled '" + name + "': a name that ends in .pcd, .ply or .pcd.zst is needed");
}

/// F.pcd for the first cloud, F_1.pcd and so on for the others.
std::string LabelledName(const std::string& name, std::size_t view) {
  if (view == 0) return name;
  const std::size_t stem = name.size() - LabelledEnding(name).size();
  return name.substr(0, stem) + "_" + std::to_string(view) + name.substr(stem);
}

/// Where poses of --pose floor come from, for readers of tubes.json.
Json PoseJson(const FloorPose& fitted) {
  Json poses = Json::array();
  for (const RigidTransform& X_NS : fitted.X_NS) poses.push_back(ToJson(X_NS));
  return {{"from", "floor"}, {"walls", fitted.walls}, {"open", fitted.open}, {"X_NS", poses}};
}

struct PerceiveOptions {
  CloudInput input;
  std::string labelled;
};

int PerceiveClouds(const PerceiveOptions& given, const Common& common) {
  if (!given.labelled.empty()) LabelledEnding(given.labelled);
  const Part part = LoadPart(given.input.part);
  const Scenario scenario = LoadScenario({}, common, given.input.profile);
  Bin bin = ScenarioBin(scenario, std::nullopt);
  if (!given.input.bin.empty()) bin.size_m = ParseBinSize(given.input.bin);
  StepTimer timer;
  ViewsOfFiles read = ReadViews(given.input, bin, common);
  std::vector<OrganizedCloud>& views = read.clouds;
  const double load_ms = timer.Lap();
  TubeScene scene = Perceive(views, part, bin, scenario.perception, common.parallelism());
  scene.timing_ms.load = load_ms;
  for (const std::string& text : scene.warnings) Say(common, "warning: " + text);
  Json out = ToJson(scene);
  out["part"] = PartToJson(part);
  out["bin"] = ToJson(bin);
  if (read.fitted) out["pose"] = PoseJson(*read.fitted);
  if (!given.labelled.empty()) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      views[i].label = LabelPoints(views[i], scene, bin, common.parallelism());
      WriteCloud(views[i], LabelledName(given.labelled, i));
    }
  }
  WriteJsonFile(out, common.out);
  Say(common, std::to_string(scene.tubes.size()) + " tubes, " +
                  std::to_string(scene.crossings.size()) + " crossings, " +
                  std::to_string(scene.unexplained_N.size()) + " unexplained points; bin " +
                  ToString(scene.bin_content) + " (" + scene.bin_content_reason +
                  "): " + common.out);
  return 0;
}

}  // namespace

void AddPerceiveVerb(CLI::App& app, Common& common) {
  auto given = std::make_shared<PerceiveOptions>();
  CLI::App* verb = app.add_subcommand(
      "perceive",
      "Example: tubetwin perceive out/scan/view_*.pcd --part pvc_a --out tubes.json\n\n"
      "Tubes and crossings from clouds alone.");
  verb->add_option("clouds", given->input.clouds, "PCD or PLY files, one per view")->required();
  AddCloudOptions(*verb, given->input)->required();
  verb->add_option("--labelled", given->labelled,
                   "Also write each point's tube, as PCD or PLY by the name's ending: the first "
                   "cloud here, others with _1, _2 ...");
  AddCommonOptions(*verb, common, BinKeysAnd({"profile", "perception", "cell.model"}),
                   "tubes.json to write", true);
  verb->callback([given, &common] {
    common.action = [given, &common] { return PerceiveClouds(*given, common); };
  });
}

}  // namespace tubetwin
