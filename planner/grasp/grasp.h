#pragma once

#include "models/base/config/config.h"
#include "models/base/frames.h"
#include "models/base/json_fwd.h"

namespace tubetwin {

/// A way to hold a tube.
struct Grasp {
  int tube = 0;
  double at_m = 0.0;  ///< Arc length on the tube.
  /// The pads' centre at the moment of closing: z into the bin, y across the tube (closing).
  RigidTransform X_NG = RigidTransform::Identity();
  double opening_m = 0.0;    ///< Before closing.
  double clearance_m = 0.0;  ///< Of fingers and body to other tubes and walls, at most 20 mm.
  double cost = 0.0;
};
Json ToJson(const Grasp& grasp);

/// Where a gripper may hold a tube and what it costs; keys of config table [planner].
struct GraspConfig {
  double grasp_end_m = 0.02;          ///< Smallest distance of a grasp point from the tube's ends.
  double max_slope_deg = 40.0;        ///< Steepest tangent that a vertical gripper may take.
  double finger_clearance_m = 0.002;  ///< Smallest distance of fingers and gripper body to all.
  int max_points = 6;  ///< Largest number of 3 mm cubes with measured points in the way.
  double weight_height = 0.2, weight_centre = 0.5, weight_trajectory = 0.3;
  double weight_clearance = 0.1;  ///< Not in the paper: little room around the fingers costs.
  double weight_tilt = 0.1;       ///< Not in the paper: tools that lean cost, 35 degrees this much.
  double max_displacement_m = 1.0;

  void Visit(ConfigVisitor& v);
};

}  // namespace tubetwin
