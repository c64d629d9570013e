#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planner/motion/path_config.h"
#include "planner/motion/pick_path.h"
#include "planner/pick/pick_plan.h"

namespace tubetwin {

/// One touch of a tube from above with closed fingers, and the drag that follows.
struct NudgeStroke {
  /// Where E stands when the fingers press: their lower edge a little below the tube's crown. What
  /// is felt on the way down ends it.
  RigidTransform X_NE = RigidTransform::Identity();
  Vector3 travel_N = Vector3::Zero();  ///< Of the fingers, horizontal, always away from the walls.
};

/// A way to bring a tube to where it can be grasped.
struct Nudge {
  int tube = 0;
  double at_m = 0.0;                      ///< Arc length where the fingers touch first.
  Vector3 direction_N = Vector3::Zero();  ///< Horizontal unit vector.
  double travel_m = 0.0;                  ///< That the tube should make.
  bool rolls = false;  ///< A straight tube rolls under the fingers, half as far as they go.
  std::vector<NudgeStroke> strokes;
};

/// Whether the arm can carry out a nudge: nothing when it can, else why not. Must be a pure
/// function.
using NudgeFeasibility = std::function<std::optional<std::string>(const Nudge& nudge)>;

struct NudgeResult {
  std::optional<Nudge> nudge;         ///< None: nothing can be done so.
  std::vector<Rejection> rejections;  ///< Why tubes cannot be nudged.
};

/// Where no tube can be grasped: which tube to move away from a wall, a corner or a neighbour, and
/// how. A tube at a wall leaves no gap for fingers beside it, so they come from above, closed,
/// press lightly on its crown and drag it along: a straight tube rolls under them, half as far as
/// they go, until it leaves their lower face, and they are set down again; a bent one slides with
/// them. Of all free tubes, directions (inward from each wall that is near, between two of them,
/// away from a near neighbour) and touching points (from the centre of mass on) it is the nudge
/// with the shortest way to where `grasp_feasible` has a grasp for the tube, a little farther for
/// safety. Fingers and gripper keep `finger_clearance_m` to walls and other tubes on all of it,
/// never push towards a wall, and the tube arrives without touching what it did not touch before.
NudgeResult PlanNudge(const PickProblem& problem, const FeasibilityFunction& grasp_feasible,
                      const NudgeFeasibility& feasible);

/// Stages of a nudge's path: 0, to over the first touch with closed fingers, then three of each
/// stroke.
enum class StrokeStage { kPress, kDrag, kLift };
int NudgeStage(int stroke, StrokeStage stage);

/// The one description of how a tube is nudged. Contact ends pressing and dragging.
PickPath MakeNudgePath(const Nudge& nudge, const GripperSpec& gripper, const Bin& bin,
                       const PathConfig& config, const NudgeConfig& nudging);

/// Asks the arm whether it could run such paths, from wherever it is. All must outlive the
/// function.
NudgeFeasibility NudgePathFeasibility(const MotionPlanner& planner, const Bin& bin,
                                      const PathConfig& config, const NudgeConfig& nudging);

/// Null when there is none.
Json ToJson(const std::optional<Nudge>& nudge);

}  // namespace tubetwin
