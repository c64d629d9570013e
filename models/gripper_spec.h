#pragma once

namespace tubetwin {

/// Robotiq 2F-85 as figures: stroke, force, speed, pads. Metres, newtons.
struct GripperSpec {
  double stroke_m = 0.085;    ///< Largest opening between the pads.
  double min_force_N = 20.0;  ///< Per pad.
  double max_force_N = 235.0;
  double min_speed_m_s = 0.020;  ///< Of the opening.
  double max_speed_m_s = 0.150;
  double pad_width_m = 0.022;         ///< Along the axis of a grasped tube.
  double pad_height_m = 0.0375;       ///< Along the tool's z.
  double finger_thickness_m = 0.013;  ///< Along the closing direction, behind the pad's face.
};

/// How far the pads have moved forward (along +z of the tool) at an opening, relative to fully
/// open: 0 at 85 mm, 13.8 mm when closed. Monotone interpolation of the table of the public model's
/// linkage.
double TipAdvance(double opening_m);

/// Height of the pads' centre along the tool: E lies at TipAdvance(0) - TipAdvance(opening) behind
/// X_FE's origin. Planner and twin both use this and nothing else.
inline double PadRetreat(double opening_m) { return TipAdvance(0.0) - TipAdvance(opening_m); }

/// Height of E over the tube's axis for a vertical grasp: 9 mm, or higher where the pads' lower
/// edge would come nearer than 2 mm to the floor. `axis_height_m` over the bin floor.
double GraspHeightOverAxis(double axis_height_m, const GripperSpec& spec = {});

}  // namespace tubetwin
