#pragma once

#include "models/bin.h"
#include "models/gripper_spec.h"
#include "planner/motion/path_config.h"
#include "planner/motion/pick_path.h"
#include "planner/pick/pick_plan.h"

namespace tubetwin {

/// Stages of a pick's path, in order. Between them the cycle weighs.
enum PickStage {
  kApproachStage,   ///< Fingers open, over the grasp with the tool upright.
  kDescendStage,    ///< Down to the grasp, the last part guarded.
  kCloseStage,      ///< The fingers close on the tube.
  kFirstLiftStage,  ///< The first part of the motion, until the load can be weighed.
  kMotionStage,     ///< The rest of it.
};

/// What a path is made for besides a plan's grasp and motion.
struct PickPathInput {
  const GripperSpec& gripper;
  const Bin& bin;
  const PathConfig& config;
  double tube_radius_m = 0.0;
  double ramp_s = 0.0;  ///< Period with which the held tube swings (HeldPart); 0: rigid.
};

/// X_BE (E as fixed at the flange) at the moment of closing on a tube of `radius_m`: the pads'
/// centre is then at the grasp, a little behind E.
RigidTransform ToolPoseAtGrasp(const Grasp& grasp, double radius_m, const GripperSpec& gripper,
                               const Bin& bin);

/// The one description of how a tube is picked: to over the grasp, down, closing, the motion.
PickPath MakePickPath(const Grasp& grasp, const CandidateMotion& motion,
                      const PickPathInput& input);

/// Asks the arm whether it could run such paths, from wherever it is (RefusalFromOver). `planner`,
/// `bin` and `config` must outlive the function; threads may share it.
FeasibilityFunction PathFeasibility(const MotionPlanner& planner, const Bin& bin,
                                    const PathConfig& config, double tube_radius_m);

}  // namespace tubetwin
