#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "models/bin.h"
#include "models/part.h"
#include "perception/scene/tube_scene.h"
#include "planner/extraction/registry.h"
#include "planner/grasp/grasps.h"
#include "planner/pick/evaluation.h"
#include "planner/pick/planner_config.h"

namespace tubetwin {

/// What the evaluator expects of a motion.
struct Prediction {
  double displacement_m = 0.0;
  double extra_probability = 0.0;
  int samples = 0;  ///< Roll-outs behind it; 0: the motion touches nothing.
};

/// One ranked way to pick: everything that its PickPath is made of.
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

/// What is to be picked from, and how; references outlive the call.
struct PickProblem {
  const TubeScene& scene;
  const std::vector<Vector3>& points_N;  ///< VoxelDownsample of the views, or empty.
  const Part& part;
  const Bin& bin;
  const GripperGeometry& gripper;
  const PlannerConfig& config;
  std::vector<ExtractionMotion> motions;  ///< Kinds that are tried: ExtractionMotionsOf(config).

  GraspInput grasps() const { return {scene, points_N, bin, gripper, config, config.grasp_step_m}; }
  ExtractionInput extraction(const PerceivedTube& tube) const { return {scene, tube, bin, config}; }
};

/// Whether the arm can carry out a grasp and the motion after it: nothing when it can, else why
/// not. Must be a pure function.
using FeasibilityFunction =
    std::function<std::optional<std::string>(const Grasp& grasp, const CandidateMotion& motion)>;

/// Null when there is none.
Json ToJson(const std::optional<Prediction>& prediction);
/// plan.json (schema tubetwin/plan/1).
Json ToJson(const PlanResult& result);

}  // namespace tubetwin
