#include "twin/app/cloud_input.h"

#include <algorithm>
#include <cmath>

#include <CLI/CLI.hpp>

#include "models/base/error.h"
#include "models/base/text.h"
#include "perception/view/floor_pose.h"

namespace tubetwin {
namespace {

/// Fewer points show nothing that could be judged.
constexpr std::size_t kFewestPoints = 50;

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

}  // namespace

std::vector<OrganizedCloud> ReadViews(const CloudInput& given, const Bin& bin,
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

CLI::Option* AddCloudOptions(CLI::App& verb, CloudInput& input) {
  CLI::Option* part = verb.add_option("--part", input.part, "Part name or part file");
  verb.add_option("--bin", input.bin, "Inner size of the bin: long,short,wall in metres");
  verb.add_option("--profile", input.profile, "Pipeline profile")
      ->check(CLI::IsMember(PipelineProfiles()));
  verb.add_option("--pose", input.pose,
                  "tx,ty,tz,qw,qx,qy,qz of the scanner in the bin, where a file has none; floor: "
                  "fitted to floor and walls (half a turn of the bin stays open)");
  return part;
}

}  // namespace tubetwin
