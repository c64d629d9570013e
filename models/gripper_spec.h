#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/model_file.h"
#include "models/shape.h"

namespace tubetwin {

/// A gripper with two parallel pads as figures, read from a gripper file (models/grippers). Metres,
/// newtons; frames: K the sensor's tool face that it is screwed to, E between the pads (x along a
/// grasped tube, y closing, z out of the tool).
struct GripperSpec {
  std::string name;
  std::string controller = "none";  ///< Whose registers it has: "robotiq", or "none".
  double stroke_m = 0.0;            ///< Largest opening between the pads.
  double min_force_N = 0.0;         ///< Per pad.
  double max_force_N = 0.0;
  double min_speed_m_s = 0.0;  ///< Of the opening.
  double max_speed_m_s = 0.0;
  int opening_counts = 0;           ///< Steps of the measured and asked opening over the stroke.
  int command_counts = 0;           ///< Steps of asked force and speed between their ends.
  double pad_width_m = 0.0;         ///< Along the axis of a grasped tube.
  double pad_height_m = 0.0;        ///< Along the tool's z.
  double finger_thickness_m = 0.0;  ///< Along the closing direction, behind the pad's face.
  double finger_length_m = 0.0;     ///< From the pads' lower edge towards the palm.
  /// How far the pads stand forward at an opening, against fully open: {opening, advance}, metres,
  /// openings rising. One row for pads that move on straight lines.
  std::vector<std::array<double, 2>> tip_advance_m;
  double mass_kg = 0.0;           ///< With fingers, without what couples it to the sensor.
  double coupling_mass_kg = 0.0;  ///< Between the sensor's tool face and the gripper.
  double finger_mass_kg = 0.0;    ///< One finger with its crank.
  double palm_centre_m = 0.0;     ///< Centre of mass of palm and coupling, along z of K.
  /// What does not move with the fingers, in K. The one that is nearest to the pads is the chassis,
  /// where the fingers end.
  std::vector<Shape> body;
  /// More of a finger than the bar of `finger_length_m` behind its pad, for instance the bars of a
  /// linkage: one box or capsule of the finger at +y, mirrored for the other, with its pose in the
  /// frame of E at rows of openings, linear in between.
  struct Link {
    Shape shape;  ///< Its pose is not used.
    struct Row {
      double opening_m, y_m, z_m, angle_rad;  ///< Centre, and the turn about x.
    };
    std::vector<Row> rows;  ///< Openings rising.
  };
  std::vector<Link> links;
};

/// How far the pads have moved forward (along +z of the tool) at an opening, relative to fully
/// open: 0 fully open. Monotone cubic interpolation of the gripper's table.
double TipAdvance(const GripperSpec& gripper, double opening_m);

/// Height of the pads' centre along the tool: E lies at TipAdvance(0) - TipAdvance(opening) behind
/// X_FE's origin. Planner and twin both use this and nothing else.
inline double PadRetreat(const GripperSpec& gripper, double opening_m) {
  return TipAdvance(gripper, 0.0) - TipAdvance(gripper, opening_m);
}

/// Smallest height of the pads' centre over a floor for a vertical tool: their lower edge stays
/// 2 mm over it.
double MinPadHeight(const GripperSpec& gripper);

/// Height of E over the tube's axis for a vertical grasp: 9 mm, or higher where MinPadHeight asks
/// for it. `axis_height_m` over the bin floor.
double GraspHeightOverAxis(double axis_height_m, const GripperSpec& gripper);

/// Pose in the frame of E of a link of the finger at side +1 (+y) or -1, at an opening.
RigidTransform LinkPose(const GripperSpec::Link& link, double opening_m, int side);

/// Of a gripper file, shipped or a user's own. Throws Error(kConfig) with file:line:column.
GripperSpec ReadGripper(const ModelFile& file);

}  // namespace tubetwin
