#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/cell/checked_trajectory.h"
#include "models/base/cloud/cloud.h"
#include "models/base/config/config.h"
#include "models/bin.h"
#include "models/clearance.h"
#include "models/layout.h"
#include "models/part.h"
#include "perception/scene/tube_scene.h"
#include "planner/extraction/motion_types.h"

namespace tubetwin {

/// Config table [planner]; defaults are the paper's Table 2 where it gives them.
struct PlannerConfig {
  double lift_m = 0.40;  ///< Upward move.
  double escape_first_lift_m = 0.05;
  double escape_const_m =
      0.0375;                   ///< d_const; three radii of the tube are used where that is more.
  double wall_safety_m = 0.01;  ///< Escapes keep the whole tube this far from the bin's walls.
  double grasp_step_m = 0.01;   ///< Between grasp points along the tube.
  double grasp_end_m = 0.02;    ///< Least distance of a grasp point from the tube's ends.
  double max_slope_deg = 40.0;  ///< Steepest tangent that a vertical gripper may take.
  double finger_clearance_m = 0.002;  ///< Least distance of fingers and gripper body to all.
  int max_points = 6;  ///< Largest number of 3 mm cubes with measured points in the way.
  double weight_height = 0.2, weight_centre = 0.5, weight_trajectory = 0.3;
  double weight_clearance = 0.1;  ///< Not in the paper: little room around the fingers costs.
  double weight_tilt = 0.1;       ///< Not in the paper: tools that lean cost, 35 degrees this much.
  double weight_confidence = 0.2;  ///< Not in the paper: doubt about the tube costs.
  double weight_release = 0.1;     ///< Not in the paper: setting fewer than three tubes free costs.
  double weight_extra = 3.0;       ///< Not in the paper: probability that another tube comes along.
  double max_displacement_m = 1.0;
  double min_length_share = 0.7;  ///< Tubes shorter than this share of the part come last.
  double min_confidence = 0.3;    ///< Tubes below come last.
  /// Not in the paper: more tubes are evaluated while another one comes along more often than this.
  double accept_extra = 0.15;
  /// So many tubes get tilts and tips, and after that the long list of separations, where nothing
  /// else promises to take a tube alone. 0: none, as in the paper.
  int separated = 7;
  /// Roll-outs for one choice among seven hoses end after so much simulated time, part of which is
  /// kept for samples of the best motions; fewer tubes get more in proportion, rigid ones thrice.
  double max_simulated_s = 30.0;
  int samples = 5;          ///< Roll-outs of the best candidates; 1 is the paper's cost.
  int refined = 2;          ///< So many of the best candidates get all samples.
  int max_candidates = 12;  ///< Motions that are simulated before it is known whether one will do.
  int max_plans = 8;        ///< Ranked plans that are checked for the arm and returned.
  int plans_per_tube = 3;
  /// What a tube's class is counted by: "crossings" over it, or the "occluded_joints" of the
  /// leao2020 profile, whose strongly occluded tubes are not picked and whose escapes follow the
  /// joint.
  std::string classes = "crossings";
  bool exclude_free = false;  ///< Free tubes stay but may not be chosen.
  double lift_speed_m_s = 0.25;
  /// Not in the paper: where no tube can be grasped, one is pushed free and the bin looked into
  /// again, so many times before each pick. 0: never.
  int nudges = 2;
  double nudge_press_N = 3.0;     ///< Force that ends the way down onto a tube.
  double nudge_force_N = 15.0;    ///< Force along the way that ends a push.
  double nudge_speed_m_s = 0.03;  ///< Of the fingers while they push.
  void Visit(ConfigVisitor& v);
};

/// A way to hold a tube. E at the moment of closing.
struct Grasp {
  int tube = 0;
  double at_m = 0.0;  ///< Arc length on the tube.
  RigidTransform X_NG =
      RigidTransform::Identity();  ///< z into the bin, y across the tube (closing).
  double opening_m = 0.0;          ///< Before closing.
  double clearance_m = 0.0;        ///< Of fingers and body to other tubes and walls, at most 20 mm.
  double cost = 0.0;
};

/// Why something was not offered. `motion` or `grasp` empty: it holds for all of them.
struct Rejection {
  int tube = 0;
  std::string motion, grasp, reason;
};

/// What the evaluator expects of a motion.
struct Prediction {
  double displacement_m = 0.0;
  double extra_probability = 0.0;
  int samples = 0;  ///< Roll-outs behind it; 0: the motion touches nothing.
};

/// One ranked way to pick: everything the pick cycle needs, arm-feasible as checked.
struct PickPlan {
  int target = 0;
  TubeClass target_class = TubeClass::kFree;
  CandidateMotion motion;
  Grasp grasp;
  bool used_simulator = false;
  std::optional<Prediction> prediction;  ///< Of covered tubes.
  double cost = 0.0;
  std::string note;  ///< Why it is ranked last, when doubt about the tube puts it there.
};

struct PlanResult {
  std::vector<PickPlan> plans;  ///< Best first.
  std::vector<Rejection> rejections;
  std::vector<CandidateMotion> candidates;
  EvaluationResult evaluation;                 ///< Empty when the simulator was not needed.
  double planning_s = 0.0, evaluator_s = 0.0;  ///< Wall.
};
/// Null when there is none.
Json ToJson(const std::optional<Prediction>& prediction);
/// plan.json (schema tubetwin/plan/1).
Json ToJson(const PlanResult& result);

}  // namespace tubetwin
