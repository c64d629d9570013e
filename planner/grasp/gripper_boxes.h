#pragma once

#include <string>
#include <vector>

#include "models/cell_model.h"
#include "planner/scene_query/box_distance.h"

namespace tubetwin {

/// The gripper as the planner knows it: figures of fingers and pads, and the body that carries them
/// as boxes in frame E, of the gripper's list of shapes and the cell's calibration.
struct GripperGeometry {
  struct NamedBox {
    std::string name;
    OrientedBox box;
  };
  GripperSpec spec;
  NamedBox chassis;            ///< The one next to the pads: the fingers end there.
  std::vector<NamedBox> body;  ///< The rest of what carries them.
  double reach_m = 0.0;        ///< Of all of it from E.
};
GripperGeometry MakeGripperGeometry(const CellModel& model);

/// What the gripper fills around E, as boxes in frame E (x along the grasped tube, y closing, z out
/// of the tool), from the lower edge of the pads when closed on the tube up to its own body. All of
/// it comes down vertically.
struct GripperBoxes {
  OrientedBox fingers;     ///< Both fingers and the gap between them: no other tube may be there.
  OrientedBox finger[2];   ///< Towards -y and +y.
  OrientedBox above_tube;  ///< The gap over the tube that will be held.
  /// The chassis, then the rest of the body, then the bars of the fingers' linkage at that opening.
  std::vector<GripperGeometry::NamedBox> carrying;

  const OrientedBox& chassis() const { return carrying.front().box; }
};

/// Boxes at `opening_m` between the pads, for a tube of `tube_radius_m` whose axis lies
/// `height_over_axis_m` below E.
GripperBoxes MakeGripperBoxes(const GripperGeometry& gripper, double opening_m,
                              double tube_radius_m, double height_over_axis_m);

/// Both fingers with the gap between them first, then what carries them.
std::vector<GripperGeometry::NamedBox> Parts(const GripperBoxes& boxes);

/// Moved by X_NE into N.
OrientedBox Moved(const RigidTransform& X_NE, const OrientedBox& box);

/// Distance of a box to the bin's inner walls, negative when it reaches into one; `enough_m` when
/// it is higher than the walls' rim by that, or farther away. Walls only, not the floor.
double WallClearance(const OrientedBox& box_N, const Bin& bin, double enough_m);

}  // namespace tubetwin
