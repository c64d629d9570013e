#include "planner/motion_types.h"

#include "hw_bridge/base/json.h"

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

Json ToJson(const CandidateMotion& motion) {
  Json json = {{"tube", motion.tube},
               {"motion", motion.name},
               {"waypoints_m", ToJson(motion.waypoints_N)},
               {"speed_m_s", motion.speed_m_s}};
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
                                  {"waypoints_m", ToJson(score.waypoints_N)},
                                  {"displacement_m", score.displacement_m},
                                  {"extra_probability", score.extra_probability},
                                  {"cost", score.cost},
                                  {"status", ToString(score.status)},
                                  {"sim_s", score.sim_s},
                                  {"wall_s", score.wall_s},
                                  {"samples", score.samples}});
  }
  json["best"] = result.best >= 0 ? Json(result.best) : Json(nullptr);
  json["settle_s"] = result.settle_s;
  json["wall_s"] = result.wall_s;
  json["threads"] = result.threads;
  return json;
}

}  // namespace tubetwin
