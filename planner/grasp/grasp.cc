#include "planner/grasp/grasp.h"

#include "models/base/json.h"

namespace tubetwin {

Json ToJson(const Grasp& grasp) {
  return Json{{"at_m", grasp.at_m},
              {"X_NG", ToJson(grasp.X_NG)},
              {"opening_m", grasp.opening_m},
              {"clearance_m", grasp.clearance_m},
              {"cost", grasp.cost}};
}

void GraspConfig::Visit(ConfigVisitor& v) {
  v.Field("grasp_end_m", "smallest distance of grasp points from the tube's ends", grasp_end_m,
          {0.0, 0.5});
  v.Field("max_slope_deg", "steepest tube that a vertical gripper takes", max_slope_deg, {0.0, 80});
  v.Field("finger_clearance_m", "smallest distance of the gripper to tubes and walls",
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
  v.Field("max_displacement_m", "displacement from which on all motions are equally bad",
          max_displacement_m, {0.01, 100.0});
}

}  // namespace tubetwin
