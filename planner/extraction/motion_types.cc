#include "planner/extraction/motion_types.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/json.h"

namespace tubetwin {

const char* ToString(CandidateScore::Status status) {
  switch (status) {
    case CandidateScore::Status::kDone:
      return "done";
    case CandidateScore::Status::kJammed:
      return "jammed";
    case CandidateScore::Status::kDiverged:
      return "diverged";
    case CandidateScore::Status::kPruned:
      return "pruned";
  }
  return "?";
}

namespace {

RigidTransform About(const Vector3& pivot, const Vector3& shift, const Eigen::Quaterniond& turn) {
  return Translation(pivot + shift) * MakeTransform(turn.toRotationMatrix(), Vector3::Zero()) *
         Translation(-pivot);
}

}  // namespace

RigidTransform PoseAt(const ObjectPath& way, std::size_t k) {
  TT_CHECK(k < way.waypoints_N.size());
  if (!way.turns()) return Translation(way.waypoints_N[k]);
  return About(way.pivot_N, way.waypoints_N[k], way.rotations_N[k]);
}

std::vector<RigidTransform> PosesAlong(const ObjectPath& way, double step_m, double reach_m) {
  std::vector<RigidTransform> poses = {PoseAt(way, 0)};
  for (std::size_t k = 1; k < way.waypoints_N.size(); ++k) {
    const Vector3 from = way.waypoints_N[k - 1], leg = way.waypoints_N[k] - from;
    const double angle =
        way.turns() ? way.rotations_N[k - 1].angularDistance(way.rotations_N[k]) : 0.0;
    const int count =
        std::max(1, static_cast<int>(std::ceil((leg.norm() + angle * reach_m) / step_m)));
    for (int i = 1; i <= count; ++i) {
      const double share = static_cast<double>(i) / count;
      const Vector3 shift = from + leg * share;
      poses.push_back(way.turns() ? About(way.pivot_N, shift,
                                          way.rotations_N[k - 1].slerp(share, way.rotations_N[k]))
                                  : Translation(shift));
    }
  }
  return poses;
}

void AddObjectPath(const ObjectPath& way, Json& json) {
  json["waypoints_m"] = ToJson(way.waypoints_N);
  if (!way.turns()) return;
  Json rotations = Json::array();
  for (const Eigen::Quaterniond& rotation : way.rotations_N) {
    rotations.push_back(QuaternionWxyz(rotation.toRotationMatrix()));
  }
  json["rotations_wxyz"] = std::move(rotations);
  json["pivot_m"] = ToJson(way.pivot_N);
}

ObjectPath ObjectPathFromJson(const JsonView& view) {
  ObjectPath way;
  way.waypoints_N = view.Field("waypoints_m").AsPolyline();
  const auto rotations = view.Optional("rotations_wxyz");
  if (!rotations) return way;
  for (std::size_t k = 0; k < rotations->Size(); ++k) {
    const JsonView rotation = rotations->Item(k);
    const std::vector<double> q = rotation.AsNumbers();
    if (q.size() != 4) rotation.Fail("four numbers are needed");
    way.rotations_N.emplace_back(RotationFromWxyz(q[0], q[1], q[2], q[3]));
  }
  if (way.rotations_N.size() != way.waypoints_N.size()) {
    rotations->Fail("one rotation for each waypoint is needed");
  }
  way.pivot_N = view.Field("pivot_m").AsVector3();
  return way;
}

Json ToJson(const CandidateMotion& motion) {
  Json json = {{"tube", motion.tube}, {"motion", motion.name}, {"speed_m_s", motion.speed_m_s}};
  AddObjectPath(motion, json);
  if (motion.forbidden_from_m <= motion.forbidden_to_m) {
    json["forbidden_m"] = {motion.forbidden_from_m, motion.forbidden_to_m};
  }
  return json;
}

Json ToJson(const EvaluationResult& result) {
  Json json = {{"schema", "tubetwin/scores/1"}, {"candidates", Json::array()}};
  for (const CandidateScore& score : result.candidates) {
    json["candidates"].push_back({{"tube", score.tube},
                                  {"motion", score.motion},
                                  {"displacement_m", score.displacement_m},
                                  {"extra_probability", score.extra_probability},
                                  {"cost", score.cost},
                                  {"status", ToString(score.status)},
                                  {"lower_bound", score.lower_bound},
                                  {"sim_s", score.sim_s},
                                  {"wall_s", score.wall_s},
                                  {"samples", score.samples}});
    AddObjectPath(score, json["candidates"].back());
  }
  json["best"] = result.best >= 0 ? Json(result.best) : Json(nullptr);
  json["settle_s"] = result.settle_s;
  json["wall_s"] = result.wall_s;
  json["threads"] = result.threads;
  return json;
}

}  // namespace tubetwin
