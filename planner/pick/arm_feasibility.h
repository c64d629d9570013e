#pragma once

#include "models/bin.h"
#include "planner/motion/motion_planner.h"
#include "planner/pick/pick_planner.h"

namespace tubetwin {

/// X_BE (E as fixed at the flange) at the moment of closing on a tube of `radius_m`: the pads'
/// centre is then at the grasp, a little behind E.
RigidTransform ToolPoseAtGrasp(const Grasp& grasp, double radius_m, const Bin& bin);

/// Asks the arm: reach over the grasp at the carry height, a straight line down with the grasp's
/// opening, then the motion's legs with the pads closed on the tube, each with all limits and
/// clearances that MotionPlanner keeps. Nothing when all of it works, else the first refusal.
/// `motion` must outlive the function; threads may share it.
FeasibilityFunction ArmFeasibility(const MotionPlanner& motion, const CellLayout& layout,
                                   const Bin& bin, double radius_m);

}  // namespace tubetwin
