#include <algorithm>
#include <cmath>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "models/base/cloud/cloud.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/step_timer.h"
#include "models/base/text.h"
#include "perception/label_points.h"
#include "perception/perceive.h"
#include "perception/view/floor_pose.h"
#include "twin/app/common.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

/// Fewer points show nothing that could be judged.
constexpr std::size_t kFewestPoints = 50;

struct PerceiveOptions {
  std::vector<std::string> clouds;
  std::string part, bin, profile, pose, labelled;
};

RigidTransform ParsePose(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.c_str();
  while (*at != '\0') {
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    if (end == at || !std::isfinite(value)) break;
    numbers.push_back(value);
    at = *end == ',' ? end + 1 : end;
    if (*end != ',' && *end != '\0') break;
  }
  if (numbers.size() != 7 || *at != '\0') {
    throw Error(ErrorKind::kUsage,
                "--pose '" + text + "': tx,ty,tz,qw,qx,qy,qz is needed (metres, scanner in bin)");
  }
  const Eigen::Vector4d q(numbers[3], numbers[4], numbers[5], numbers[6]);
  if (std::abs(q.norm() - 1.0) > 1e-2) {
    throw Error(ErrorKind::kUsage, "--pose '" + text + "': qw,qx,qy,qz has length " +
                                       Number(q.norm()) + ", 1 is needed");
  }
  return MakeTransform(RotationFromWxyz(q[0], q[1], q[2], q[3]),
                       Vector3(numbers[0], numbers[1], numbers[2]));
}

void RequirePoints(const OrganizedCloud& cloud, const std::string& file) {
  const auto valid = static_cast<std::size_t>(std::count_if(
      cloud.p_SP.begin(), cloud.p_SP.end(), [](const auto& p) { return IsValid(p); }));
  if (valid < kFewestPoints) {
    throw Error(ErrorKind::kBadData,
                file + ": x y z: " + std::to_string(valid) + " of " + std::to_string(cloud.size()) +
                    " points are valid, at least " + std::to_string(kFewestPoints) + " are needed");
  }
}

RigidTransform FitPose(const OrganizedCloud& cloud, const Bin& bin, const std::string& file) {
  try {
    return FitFloorPose(cloud, bin);
  } catch (const Error& error) {
    throw Error(error.kind(), file + ": x y z: " + error.what());
  }
}

/// Files that know no pose say nothing or the identity, and no scanner looks up from the middle of
/// the bin's floor.
bool HasPose(const OrganizedCloud& cloud) {
  return cloud.X_NS.matrix() != RigidTransform::Identity().matrix();
}

/// The clouds as the pipeline gets them: each with a pose, none with labels.
std::vector<OrganizedCloud> ReadViews(const PerceiveOptions& given, const Bin& bin,
                                      const Common& common) {
  const bool from_floor = given.pose == "floor";
  std::optional<RigidTransform> X_NS;
  if (!given.pose.empty() && !from_floor) X_NS = ParsePose(given.pose);
  int fitted = 0;
  std::vector<OrganizedCloud> views;
  for (const std::string& file : given.clouds) {
    views.push_back(ReadCloud(file));
    OrganizedCloud& view = views.back();
    RequirePoints(view, file);
    view.label.clear();  // The pipeline never sees labels.
    if (HasPose(view)) {
      if (!given.pose.empty()) Say(common, file + ": has a pose, so --pose is not used for it");
      continue;
    }
    if (from_floor) {
      if (++fitted > 1) {
        throw Error(ErrorKind::kUsage,
                    file +
                        ": --pose floor is for one cloud: half a turn of the bin between two "
                        "would go unseen");
      }
      view.X_NS = FitPose(view, bin, file);
      continue;
    }
    if (!X_NS) {
      throw Error(ErrorKind::kBadData,
                  file +
                      ": VIEWPOINT (PCD) or camera (PLY) is absent or the identity: the file "
                      "has no pose of the scanner in the bin, --pose is needed");
    }
    view.X_NS = *X_NS;
  }
  return views;
}

/// F.pcd for the first cloud, F_1.pcd and so on for the others.
std::string LabelledName(const std::string& name, std::size_t view) {
  if (view == 0) return name;
  const fs::path path(name);
  fs::path out = path.parent_path() / path.stem();
  out += "_" + std::to_string(view);
  out += path.extension();
  return out.string();
}

int PerceiveClouds(const PerceiveOptions& given, const Common& common) {
  const Part part = LoadPart(given.part);
  Bin bin;
  if (!given.bin.empty()) bin.size_m = ParseBinSize(given.bin);
  const Scenario scenario = LoadScenario({}, common, given.profile);
  StepTimer timer;
  std::vector<OrganizedCloud> views = ReadViews(given, bin, common);
  const double load_ms = timer.Lap();
  TubeScene scene = Perceive(views, part, bin, scenario.perception, common.parallelism());
  scene.timing_ms.load = load_ms;
  for (const std::string& text : scene.warnings) Say(common, "warning: " + text);
  Json out = ToJson(scene);
  out["part"] = PartToJson(part);
  out["bin"] = ToJson(bin);
  if (!given.labelled.empty()) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      views[i].label = LabelPoints(views[i], scene, bin, common.parallelism());
      WritePcd(views[i], LabelledName(given.labelled, i));
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
  verb->add_option("clouds", given->clouds, "PCD or PLY files, one per view")->required();
  verb->add_option("--part", given->part, "Part name or part file")->required();
  verb->add_option("--bin", given->bin, "Inner size of the bin: long,short,wall in metres");
  verb->add_option("--profile", given->profile, "Pipeline profile")
      ->check(CLI::IsMember(PipelineProfiles()));
  verb->add_option("--pose", given->pose,
                   "tx,ty,tz,qw,qx,qy,qz of the scanner in the bin, where a file has none; floor: "
                   "fitted to floor and walls (half a turn of the bin stays open)");
  verb->add_option("--labelled", given->labelled,
                   "Also write each point's tube: the first cloud here, others with _1, _2 ...");
  AddCommonOptions(*verb, common, "tubes.json to write", true);
  verb->callback([given, &common] {
    common.action = [given, &common] { return PerceiveClouds(*given, common); };
  });
}

}  // namespace tubetwin
