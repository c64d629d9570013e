#include "planner/pick/pick_plan.h"

#include "models/base/json.h"

namespace tubetwin {

Json ToJson(const std::optional<Prediction>& prediction) {
  if (!prediction) return nullptr;
  return Json{{"displacement_m", prediction->displacement_m},
              {"extra_probability", prediction->extra_probability},
              {"samples", prediction->samples}};
}

Json ToJson(const PlanResult& result) {
  Json json = {{"schema", "tubetwin/plan/1"},
               {"frame", "bin"},
               {"ranking", Json::array()},
               {"candidates", Json::array()},
               {"rejections", Json::array()}};
  for (const PickPlan& plan : result.plans) {
    json["ranking"].push_back({{"target", plan.target},
                               {"class", ToString(plan.target_class)},
                               {"motion", ToJson(plan.motion)},
                               {"grasp", ToJson(plan.grasp)},
                               {"used_simulator", plan.used_simulator},
                               {"prediction", ToJson(plan.prediction)},
                               {"cost", plan.cost},
                               {"note", plan.note}});
  }
  for (const CandidateMotion& candidate : result.candidates) {
    json["candidates"].push_back(ToJson(candidate));
  }
  for (const Rejection& rejection : result.rejections) {
    json["rejections"].push_back({{"tube", rejection.tube},
                                  {"motion", rejection.motion},
                                  {"grasp", rejection.grasp},
                                  {"reason", rejection.reason}});
  }
  json["evaluation"] =
      result.evaluation.candidates.empty() ? Json(nullptr) : ToJson(result.evaluation);
  json["planning_s"] = result.planning_s;
  json["evaluator_s"] = result.evaluator_s;
  return json;
}

}  // namespace tubetwin
