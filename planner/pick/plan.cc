#include "planner/pick/plan.h"

#include "models/base/json.h"

namespace tubetwin {

void PlannerConfig::Visit(ConfigVisitor& v) {
  v.Field("lift_m", "upward move after the grasp, and last move of an escape", lift_m, {0.05, 1.0});
  v.Field("escape_first_lift_m", "first upward move of an escape", escape_first_lift_m, {0.0, 0.3});
  v.Field("escape_const_m", "constant term of the slide, three tube radii at least", escape_const_m,
          {0.0, 0.5});
  v.Field("wall_safety_m", "distance that an escaping tube keeps from the walls", wall_safety_m,
          {0.0, 0.2});
  v.Field("grasp_step_m", "distance of grasp points along the tube", grasp_step_m, {0.001, 0.1});
  v.Field("grasp_end_m", "least distance of grasp points from the tube's ends", grasp_end_m,
          {0.0, 0.5});
  v.Field("max_slope_deg", "steepest tube that a vertical gripper takes", max_slope_deg, {0.0, 80});
  v.Field("finger_clearance_m", "least distance of the gripper to tubes and walls",
          finger_clearance_m, {0.0, 0.05});
  v.Field("max_points", "largest number of 3 mm cubes with measured points in the gripper's way",
          max_points, {0, 1e6});
  v.Field("weight_height", "weight of the height cost", weight_height, {0.0, 10.0});
  v.Field("weight_centre", "weight of the distance to the centre of mass", weight_centre,
          {0.0, 10.0});
  v.Field("weight_trajectory", "weight of the evaluator's displacement", weight_trajectory,
          {0.0, 10.0});
  v.Field("weight_clearance", "weight of little room around the gripper", weight_clearance,
          {0.0, 10.0});
  v.Field("weight_tilt", "weight of a tool that leans, by its share of 35 degrees", weight_tilt,
          {0.0, 10.0});
  v.Field("weight_confidence", "weight of doubt about the tube", weight_confidence, {0.0, 10.0});
  v.Field("weight_release", "weight of setting fewer than three tubes free", weight_release,
          {0.0, 10.0});
  v.Field("weight_extra", "weight of the probability that another tube comes along", weight_extra,
          {0.0, 10.0});
  v.Field("accept_extra",
          "more covered tubes are evaluated while the best motion brings another tube along with a "
          "larger probability",
          accept_extra, {0.0, 1.0});
  v.Field("max_simulated_s",
          "no more motions are asked about after so much simulated time of seven hoses (of fewer "
          "more in proportion, of rigid tubes thrice as much): the best of the others is taken",
          max_simulated_s, {1, 1e6});
  v.Field("separated",
          "so many covered tubes get tilts and tips, and after that the long list of separations "
          "(shake, hemisphere, helices), where nothing else takes a tube alone",
          separated, {0, 100});
  v.Field("max_displacement_m", "displacement from which on all motions are equally bad",
          max_displacement_m, {0.01, 100.0});
  v.Field("min_length_share", "tubes shorter than this share of the part come last",
          min_length_share, {0.0, 1.0});
  v.Field("min_confidence", "tubes with less confidence come last", min_confidence, {0.0, 1.0});
  v.Field("samples", "roll-outs of the best candidates; 1 gives the paper's cost", samples,
          {1, 64});
  v.Field("refined", "how many of the best candidates get all samples", refined, {1, 1000});
  v.Field("max_candidates", "motions that are simulated before it is known whether one will do",
          max_candidates, {1, 10000});
  v.Field("max_plans", "ranked plans that are checked for the arm", max_plans, {1, 100});
  v.Field("plans_per_tube", "of these, at most so many for one tube", plans_per_tube, {1, 100});
  v.Choice("classes",
           "what a tube's class is counted by: crossings over it, or the occluded_joints of the "
           "leao2020 profile, which picks no strongly occluded tube and escapes along the joint",
           classes, {"crossings", "occluded_joints"});
  v.Field("exclude_free", "free tubes stay but may not be chosen", exclude_free);
  v.Field("lift_speed_m_s", "speed of the motions after the grasp", lift_speed_m_s, {0.01, 2.0});
  v.Field("nudges",
          "where no tube can be grasped, one is pushed away from its wall or neighbour and the bin "
          "looked into again, so many times before each pick; 0: never",
          nudges, {0, 10});
  v.Field("nudge_press_N", "force that ends the way down onto a tube that is to be pushed",
          nudge_press_N, {1, 20});
  v.Field("nudge_force_N", "force along the way that ends a push", nudge_force_N, {2, 60});
  v.Field("nudge_speed_m_s", "speed of the fingers while they push a tube", nudge_speed_m_s,
          {0.005, 0.1});
}

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
                               {"grasp",
                                {{"at_m", plan.grasp.at_m},
                                 {"X_NG", ToJson(plan.grasp.X_NG)},
                                 {"opening_m", plan.grasp.opening_m},
                                 {"clearance_m", plan.grasp.clearance_m},
                                 {"cost", plan.grasp.cost}}},
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
