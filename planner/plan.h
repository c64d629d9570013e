#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/base/cloud.h"
#include "hw_bridge/base/config.h"
#include "hw_bridge/cell/checked_trajectory.h"
#include "models/bin.h"
#include "models/clearance.h"
#include "models/layout.h"
#include "models/part.h"
#include "perception/tube_scene.h"
#include "planner/motion_types.h"

namespace tubetwin {

/// Config table [planner]; defaults are the paper's Table 2 where it gives them.
struct PlannerConfig {
  double lift_m = 0.40;  ///< Upward move.
  double escape_first_lift_m = 0.05;
  double escape_const_m = 0.0375;  ///< d_const, at least three radii.
  double grasp_step_m = 0.01;
  double weight_height = 0.2, weight_centre = 0.5, weight_trajectory = 0.3;
  double max_displacement_m = 1.0;
  bool exclude_free = false;  ///< Free tubes stay but may not be chosen.
  double lift_speed_m_s = 0.25;
  void Visit(ConfigVisitor& v);
};

/// A way to hold a tube. E at the moment of closing.
struct Grasp {
  int tube = 0;
  double at_m = 0.0;  ///< Arc length on the tube.
  RigidTransform X_NG =
      RigidTransform::Identity();  ///< z into the bin, y across the tube (closing).
  double opening_m = 0.0;          ///< Before closing.
  double cost = 0.0;
};

struct Rejection {
  int tube = 0;
  std::string motion, grasp, reason;
};

/// One ranked way to pick: everything the pick cycle needs, arm-feasible as checked.
struct PickPlan {
  int target = 0;
  TubeClass target_class = TubeClass::kFree;
  CandidateMotion motion;
  Grasp grasp;
  bool used_simulator = false;
  double cost = 0.0;
};

struct PlanResult {
  std::vector<PickPlan> plans;  ///< Best first.
  std::vector<Rejection> rejections;
  std::vector<CandidateMotion> candidates;
  EvaluationResult evaluation;                 ///< Empty when the simulator was not needed.
  double planning_s = 0.0, evaluator_s = 0.0;  ///< Wall.
};
Json ToJson(const PlanResult& result);

}  // namespace tubetwin
