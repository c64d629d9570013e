#include "planner/grasp/gripper_boxes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "models/base/error.h"
#include "models/clearance.h"

namespace tubetwin {
namespace {

// Box around a shape of the tool, in E.
OrientedBox ToolBox(const ArmModel& arm, const CellLayout& layout, const std::string& name) {
  using Shape = ClearanceChecker::Shape;
  for (const Shape& shape : ClearanceChecker::ArmShapes(arm, layout)) {
    if (shape.name != name) continue;
    const Vector3 half = shape.kind == Shape::Kind::kBox
                             ? shape.size_m
                             : Vector3(shape.size_m.x(), shape.size_m.x(), shape.size_m.y());
    return {layout.X_FE.inverse() * shape.X_LinkShape, half};
  }
  throw LogicError("the tool has no shape '" + name + "'");
}

// Box from its bounds in E.
OrientedBox Between(const Vector3& low, const Vector3& high) {
  return {Translation(0.5 * (low + high)), 0.5 * (high - low)};
}

}  // namespace

GripperGeometry MakeGripperGeometry(const ArmModel& arm, const CellLayout& layout) {
  return {GripperSpec(), ToolBox(arm, layout, "gripper chassis"),
          ToolBox(arm, layout, "gripper base")};
}

GripperBoxes MakeGripperBoxes(const GripperGeometry& gripper, double opening_m,
                              double tube_radius_m, double height_over_axis_m) {
  const GripperSpec& spec = gripper.spec;
  const double hx = 0.5 * spec.pad_width_m, hy = 0.5 * opening_m;
  const double outer = hy + spec.finger_thickness_m;
  const double tip = 0.5 * spec.pad_height_m;
  GripperBoxes boxes;
  boxes.chassis = gripper.chassis;
  boxes.base = gripper.base;
  // The fingers end at the chassis.
  const double top = gripper.chassis.X_AB.translation().z() + gripper.chassis.half_m.z();
  boxes.fingers = Between({-hx, -outer, top}, {hx, outer, tip});
  boxes.finger[0] = Between({-hx, -outer, top}, {hx, -hy, tip});
  boxes.finger[1] = Between({-hx, hy, top}, {hx, outer, tip});
  // Measured points of the tube itself and their noise stay below this box.
  constexpr double kOverTube_m = 0.005;
  boxes.above_tube =
      Between({-hx, -hy, top}, {hx, hy, height_over_axis_m - tube_radius_m - kOverTube_m});
  return boxes;
}

OrientedBox Moved(const RigidTransform& X_NE, const OrientedBox& box) {
  return {X_NE * box.X_AB, box.half_m};
}

double WallClearance(const OrientedBox& box_N, const Bin& bin, double enough_m) {
  // Half extents of the box along N's axes.
  const Vector3 reach = box_N.X_AB.linear().cwiseAbs() * box_N.half_m;
  const Vector3 centre = box_N.X_AB.translation();
  const double over_rim = centre.z() - reach.z() - bin.wall_m();
  const double inside = std::min(bin.half_x_m() - std::abs(centre.x()) - reach.x(),
                                 bin.half_y_m() - std::abs(centre.y()) - reach.y());
  return std::min(enough_m, std::max(over_rim, inside));
}

}  // namespace tubetwin
