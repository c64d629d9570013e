#include "planner/scene_query/object_path.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/json.h"

namespace tubetwin {
namespace {

constexpr double kSheds_deg = 45.0;

RigidTransform About(const Vector3& pivot, const Vector3& shift, const Eigen::Quaterniond& turn) {
  return Translation(pivot + shift) * MakeTransform(turn.toRotationMatrix(), Vector3::Zero()) *
         Translation(-pivot);
}

}  // namespace

RigidTransform PoseAt(const ObjectPath& path, std::size_t k) {
  TT_CHECK(k < path.waypoints_N.size());
  if (!path.turns()) return Translation(path.waypoints_N[k]);
  return About(path.pivot_N, path.waypoints_N[k], path.rotations_N[k]);
}

std::vector<RigidTransform> PosesAlong(const ObjectPath& path, double step_m, double reach_m) {
  std::vector<RigidTransform> poses = {PoseAt(path, 0)};
  for (std::size_t k = 1; k < path.waypoints_N.size(); ++k) {
    const Vector3 from = path.waypoints_N[k - 1], leg = path.waypoints_N[k] - from;
    const double angle =
        path.turns() ? path.rotations_N[k - 1].angularDistance(path.rotations_N[k]) : 0.0;
    const int count =
        std::max(1, static_cast<int>(std::ceil((leg.norm() + angle * reach_m) / step_m)));
    for (int i = 1; i <= count; ++i) {
      const double share = static_cast<double>(i) / count;
      const Vector3 shift = from + leg * share;
      poses.push_back(path.turns()
                          ? About(path.pivot_N, shift,
                                  path.rotations_N[k - 1].slerp(share, path.rotations_N[k]))
                          : Translation(shift));
    }
  }
  return poses;
}

bool IsTurnedOver(const Eigen::Quaterniond& rotation, double more_than_deg) {
  return (rotation * Vector3::UnitZ()).z() < std::cos(Radians(more_than_deg));
}

bool ShedsByTilting(const ObjectPath& path) {
  return std::any_of(path.rotations_N.begin(), path.rotations_N.end(),
                     [](const auto& rotation) { return IsTurnedOver(rotation, kSheds_deg); });
}

void AddObjectPath(const ObjectPath& path, Json& json) {
  json["waypoints_m"] = ToJson(path.waypoints_N);
  if (!path.turns()) return;
  Json rotations = Json::array();
  for (const Eigen::Quaterniond& rotation : path.rotations_N) {
    rotations.push_back(QuaternionWxyz(rotation.toRotationMatrix()));
  }
  json["rotations_wxyz"] = std::move(rotations);
  json["pivot_m"] = ToJson(path.pivot_N);
}

ObjectPath ObjectPathFromJson(const JsonView& view) {
  ObjectPath path;
  path.waypoints_N = view.Field("waypoints_m").AsPolyline();
  const auto rotations = view.Optional("rotations_wxyz");
  if (!rotations) return path;
  for (std::size_t k = 0; k < rotations->Size(); ++k) {
    const JsonView rotation = rotations->Item(k);
    const std::vector<double> q = rotation.AsNumbers();
    if (q.size() != 4) rotation.Fail("four numbers are needed");
    path.rotations_N.emplace_back(RotationFromWxyz(q[0], q[1], q[2], q[3]));
  }
  if (path.rotations_N.size() != path.waypoints_N.size()) {
    rotations->Fail("one rotation for each waypoint is needed");
  }
  path.pivot_N = view.Field("pivot_m").AsVector3();
  return path;
}

}  // namespace tubetwin
