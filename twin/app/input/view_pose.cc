#include "twin/app/input/view_pose.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

/// A scanner stands nearer to the bin than this; ten times as much is a pose in millimetres.
constexpr double kFarthest_m = 10.0;
/// Poses that differ by less are the same, written with few decimals.
constexpr double kSameShift_m = 1e-4;
const double kSameTurn_rad = Radians(0.01);

std::string PlaceText(const Vector3& p, double factor) {
  return Number(factor * p.x()) + ", " + Number(factor * p.y()) + ", " + Number(factor * p.z());
}

/// Why `p_NS` is no scanner's place; empty when it may be one.
std::string FarPlace(const Vector3& p_NS) {
  if (p_NS.norm() <= kFarthest_m) return {};
  return "the scanner at (" + PlaceText(p_NS, 1.0) + ") m, allowed is at most " +
         Number(kFarthest_m) + " m from the bin; is it in millimetres? In metres it is " +
         PlaceText(p_NS, 1e-3);
}

std::string PoseText(const RigidTransform& X) {
  char text[160];
  const auto q = QuaternionWxyz(X.linear());
  const Vector3& p = X.translation();
  std::snprintf(text, sizeof text, "%.5g,%.5g,%.5g,%.5g,%.5g,%.5g,%.5g", p.x(), p.y(), p.z(), q[0],
                q[1], q[2], q[3]);
  return text;
}

struct PoseDifference {
  double shift_m = 0.0, turn_rad = 0.0;
  bool none() const { return shift_m < kSameShift_m && turn_rad < kSameTurn_rad; }
};
PoseDifference Difference(const RigidTransform& a, const RigidTransform& b) {
  return {(a.translation() - b.translation()).norm(),
          Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle()};
}

/// Gives the view another pose and tells of one that it had.
void Replace(ViewOfFile& view, const RigidTransform& X_NS, const char* instead,
             const Common& common) {
  const PoseDifference difference = Difference(view.cloud.X_NS, X_NS);
  const bool unsaid = view.cloud.X_NS.matrix() == RigidTransform::Identity().matrix();
  if (!unsaid && !difference.none()) {
    char off[80];
    std::snprintf(off, sizeof off, "%.4g m and %.4g degrees off", difference.shift_m,
                  Degrees(difference.turn_rad));
    Say(common, view.file + ": " + instead + ", not the file's own pose " +
                    PoseText(view.cloud.X_NS) + ", which is " + off);
  }
  view.cloud.X_NS = X_NS;
}

}  // namespace

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
    const Eigen::Vector4d unit = q.normalized();
    throw Error(
        ErrorKind::kUsage,
        "--pose '" + text + "': qw,qx,qy,qz has length " + Number(q.norm()) + ", 1 is needed" +
            (q.norm() > 0 ? "; of that direction: " + Number(unit[0]) + "," + Number(unit[1]) +
                                "," + Number(unit[2]) + "," + Number(unit[3])
                          : ""));
  }
  const Vector3 p_NS(numbers[0], numbers[1], numbers[2]);
  const std::string far = FarPlace(p_NS);
  if (!far.empty()) throw Error(ErrorKind::kUsage, "--pose '" + text + "': " + far);
  return MakeTransform(RotationFromWxyz(q[0], q[1], q[2], q[3]), p_NS);
}

bool HasPose(const OrganizedCloud& cloud) { return cloud.X_NS.translation().norm() > kSameShift_m; }

void UseGivenPose(const RigidTransform& X_NS, std::vector<ViewOfFile>& views,
                  const Common& common) {
  const ViewOfFile* first = nullptr;
  for (ViewOfFile& view : views) {
    if (!HasPose(view.cloud)) continue;
    if (first != nullptr && !Difference(first->cloud.X_NS, view.cloud.X_NS).none()) {
      throw Error(ErrorKind::kUsage,
                  "--pose is one pose for all clouds, but " + first->file + " and " + view.file +
                      " say that they were taken from different ones: leave --pose away to use "
                      "theirs, or give the clouds one at a time");
    }
    if (first == nullptr) first = &view;
  }
  for (ViewOfFile& view : views) Replace(view, X_NS, "--pose is used", common);
}

FloorPose UseFloorPose(const Bin& bin, std::vector<ViewOfFile>& views, const Common& common) {
  std::vector<OrganizedCloud> clouds;
  for (const ViewOfFile& view : views) {
    if (HasPose(view.cloud) != HasPose(views.front().cloud)) {
      throw Error(ErrorKind::kBadData,
                  "--pose floor: of " + views.front().file + " and " + view.file +
                      " one knows where it was taken from and the other does not, so how they "
                      "stand to each other stays open: give clouds of one kind");
    }
    clouds.push_back(view.cloud);
  }
  FloorPose fitted;
  try {
    fitted = FitFloorPose(clouds, bin);
  } catch (const Error& error) {
    throw Error(error.kind(), views.front().file + (views.size() > 1 ? " and others" : "") +
                                  ": --pose floor: " + error.what());
  }
  for (std::size_t k = 0; k < views.size(); ++k) {
    Replace(views[k], fitted.X_NS[k], "--pose floor is used", common);
  }
  Say(common, "pose fitted to the floor and the walls " + fitted.walls + ": " +
                  PoseText(fitted.X_NS.front()) + "; " + fitted.open +
                  " looks the same, the scanner's x axis is taken to point along +x");
  return fitted;
}

void RequireOwnPoses(const std::vector<ViewOfFile>& views) {
  for (const ViewOfFile& view : views) {
    const std::string what = view.file + ": VIEWPOINT (PCD) or camera (PLY)";
    if (!HasPose(view.cloud)) {
      throw Error(ErrorKind::kBadData,
                  what +
                      " is absent, or turns the axes only: the file has no pose of the scanner in "
                      "the bin, --pose is needed");
    }
    const std::string far = FarPlace(view.cloud.X_NS.translation());
    if (!far.empty()) {
      throw Error(ErrorKind::kBadData, what + " has " + far + ": give that with --pose");
    }
  }
}

}  // namespace tubetwin
