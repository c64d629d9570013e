#include "planner/pick/evaluation.h"

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
