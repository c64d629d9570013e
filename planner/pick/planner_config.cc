#include "planner/pick/planner_config.h"

namespace tubetwin {

void SearchConfig::Visit(ConfigVisitor& v) {
  v.Field("weight_confidence", "weight of doubt about the tube", weight_confidence, {0.0, 10.0});
  v.Field("weight_release", "weight of setting fewer than three tubes free", weight_release,
          {0.0, 10.0});
  v.Field("weight_extra", "weight of the probability that another tube comes along", weight_extra,
          {0.0, 10.0});
  v.Field("min_length_share", "tubes shorter than this share of the part come last",
          min_length_share, {0.0, 1.0});
  v.Field("min_confidence", "tubes with less confidence come last", min_confidence, {0.0, 1.0});
  v.Field("accept_extra",
          "more covered tubes are evaluated while the best motion brings another tube along with a "
          "larger probability",
          accept_extra, {0.0, 1.0});
  v.Field("separated",
          "so many covered tubes get tilts, and after that the long list of separations (shake, "
          "hemisphere, helices), where nothing else takes a tube alone",
          separated, {0, 100});
  v.Field("max_simulated_s",
          "no more motions are asked about after so much simulated time of budget_tubes hoses (of "
          "fewer more in proportion): the best of the others is taken",
          max_simulated_s, {1, 1e6});
  v.Field("budget_tubes", "number of hoses that max_simulated_s is meant for", budget_tubes,
          {1, 1000});
  v.Field("budget_rigid", "so many times max_simulated_s for rigid tubes", budget_rigid,
          {0.01, 1000});
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
}

void NudgeConfig::Visit(ConfigVisitor& v) {
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

void PlannerConfig::Visit(ConfigVisitor& v) {
  ExtractionConfig::Visit(v);
  GraspConfig::Visit(v);
  SearchConfig::Visit(v);
  NudgeConfig::Visit(v);
  escape_along_joints = by_occluded_joints();
}

}  // namespace tubetwin
