#include "twin/app/input/cloud_input.h"

#include <algorithm>
#include <optional>

#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/foreign/length_unit.h"
#include "models/base/text.h"
#include "perception/view/bin_evidence.h"
#include "perception/view/floor_ways.h"
#include "twin/app/input/file_advice.h"
#include "twin/app/input/view_pose.h"

namespace tubetwin {
namespace {

/// A cloud; the refusal of another file says which verb takes it.
OrganizedCloud ReadGivenCloud(const std::string& file, std::optional<double> unit_m) {
  const std::string low = LowerCase(file);
  for (const char* ending : {".pcd", ".ply", ".pcd.zst", ".ply.zst"}) {
    if (low.ends_with(ending)) return ReadCloud(file, unit_m);
  }
  try {
    return ReadCloud(file, unit_m);
  } catch (const Error& error) {
    throw Error(error.kind(), error.what() + AdviceFor(file));
  }
}

/// Fewer points show nothing that could be judged.
constexpr std::size_t kFewestPoints = 50;

void RequirePoints(const OrganizedCloud& cloud, const std::string& file) {
  const auto valid = static_cast<std::size_t>(std::count_if(
      cloud.p_SP.begin(), cloud.p_SP.end(), [](const auto& p) { return IsValid(p); }));
  if (valid < kFewestPoints) {
    throw Error(ErrorKind::kBadData,
                file + ": x y z: " + std::to_string(valid) + " of " + std::to_string(cloud.size()) +
                    " points are valid, at least " + std::to_string(kFewestPoints) + " are needed");
  }
}

/// Throws Error(kBadData) when nothing that is in the bin, and nothing of the bin, is seen.
void RequireBinSeen(const std::vector<ViewOfFile>& views, const Bin& bin, const Common& common) {
  BinEvidence all;
  for (const ViewOfFile& view : views) {
    const BinEvidence seen = CompareWithBin(view.cloud.p_SP, view.cloud.X_NS, bin);
    all += seen;
    if (views.size() > 1 && seen.inside < kFewestPoints) {
      Say(common, "warning: " + view.file + ": " + std::to_string(seen.inside) + " of " +
                      std::to_string(seen.valid) + " points lie in the bin: check its pose");
    }
  }
  if (all.inside < kFewestPoints) {
    throw Error(ErrorKind::kBadData,
                views.front().file + (views.size() > 1 ? " and others" : "") +
                    ": x y z: " + std::to_string(all.inside) + " of " + std::to_string(all.valid) +
                    " points lie in the bin of " + SizeText(bin) +
                    ", and neither its floor nor its walls are seen: check the pose (scanner in "
                    "the bin, metres; --pose) and --bin");
  }
  const std::string warning = BinWarning(all);
  if (!warning.empty()) Say(common, "warning: " + warning);
}

}  // namespace

ViewsOfFiles ReadViews(const CloudInput& given, const Bin& bin, const Common& common) {
  std::optional<RigidTransform> X_NS;
  if (!given.pose.empty() && given.pose != "floor") X_NS = ParsePose(given.pose);
  std::vector<ViewOfFile> views;
  for (const std::string& file : given.clouds) {
    views.push_back({file, ReadGivenCloud(file, MetresPer(given.units))});
    RequirePoints(views.back().cloud, file);
    views.back().cloud.label.clear();  // The pipeline never sees labels.
  }
  ViewsOfFiles out;
  if (given.pose == "floor") {
    out.fitted = UseFloorPose(bin, views, common);
  } else if (X_NS) {
    UseGivenPose(*X_NS, views, common);
  } else {
    RequireOwnPoses(views);
  }
  RequireBinSeen(views, bin, common);
  for (ViewOfFile& view : views) out.clouds.push_back(std::move(view.cloud));
  const std::string other = OtherBinSeen(out.clouds, bin);
  if (!other.empty()) Say(common, "warning: " + other);
  return out;
}

CLI::Option* AddCloudOptions(CLI::App& verb, CloudInput& input) {
  CLI::Option* part = verb.add_option("--part", input.part, "Part name or part file");
  verb.add_option("--bin", input.bin, "Inner size of the bin: long,short,wall in metres");
  verb.add_option("--profile", input.profile, "Pipeline profile")
      ->check(CLI::IsMember(PipelineProfiles()));
  verb.add_option(
      "--pose", input.pose,
      "tx,ty,tz,qw,qx,qy,qz of the scanner in the bin (metres); wins over what a file says; "
      "floor: fitted to floor and walls (half a turn of the bin stays open)");
  AddUnitsOption(verb, input.units);
  return part;
}

void AddUnitsOption(CLI::App& verb, std::string& units) {
  verb.add_option("--units", units,
                  "Unit of the clouds' lengths; default: what a file says, else metres")
      ->check(CLI::IsMember(LengthUnits()));
}

}  // namespace tubetwin
