#include "planner/grasp/gripper_boxes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr double kLeastReach_m = 0.20;  // of the gripper's body from E

using NamedBox = GripperGeometry::NamedBox;

// Box from its bounds in E.
OrientedBox Between(const Vector3& low, const Vector3& high) {
  return {Translation(0.5 * (low + high)), 0.5 * (high - low)};
}

}  // namespace

GripperGeometry MakeGripperGeometry(const CellModel& model) {
  GripperGeometry out;
  out.spec = model.gripper;
  out.reach_m = kLeastReach_m;
  const RigidTransform X_EF = model.layout.X_FE.inverse();
  const auto end = [](const NamedBox& box) {  // the pads are beyond this
    return box.box.X_AB.translation().z() + box.box.half_m.z();
  };
  for (const Shape& shape : model.gripper.body) {
    NamedBox box{shape.name, {X_EF * (model.layout.X_FK * shape.X_LinkShape), HalfExtent(shape)}};
    out.reach_m = std::max(out.reach_m, box.box.X_AB.translation().norm() + box.box.half_m.z());
    if (out.chassis.name.empty()) {
      out.chassis = std::move(box);
      continue;
    }
    if (end(box) > end(out.chassis)) std::swap(box, out.chassis);
    out.body.push_back(std::move(box));
  }
  TT_CHECK(!out.chassis.name.empty());
  return out;
}

GripperBoxes MakeGripperBoxes(const GripperGeometry& gripper, double opening_m,
                              double tube_radius_m, double height_over_axis_m) {
  const GripperSpec& spec = gripper.spec;
  const double hx = 0.5 * spec.pad_width_m, hy = 0.5 * opening_m;
  const double outer = hy + spec.finger_thickness_m;
  const double tip = 0.5 * spec.pad_height_m;
  GripperBoxes boxes;
  boxes.carrying.push_back(gripper.chassis);
  boxes.carrying.insert(boxes.carrying.end(), gripper.body.begin(), gripper.body.end());
  for (const GripperSpec::Link& link : spec.links) {
    for (const int side : {+1, -1}) {
      boxes.carrying.push_back(
          {link.shape.name, {LinkPose(link, opening_m, side), HalfExtent(link.shape)}});
    }
  }
  // The fingers end at the chassis.
  const double top = boxes.chassis().X_AB.translation().z() + boxes.chassis().half_m.z();
  boxes.fingers = Between({-hx, -outer, top}, {hx, outer, tip});
  boxes.finger[0] = Between({-hx, -outer, top}, {hx, -hy, tip});
  boxes.finger[1] = Between({-hx, hy, top}, {hx, outer, tip});
  // Measured points of the tube itself and their noise stay below this box.
  constexpr double kOverTube_m = 0.005;
  boxes.above_tube =
      Between({-hx, -hy, top}, {hx, hy, height_over_axis_m - tube_radius_m - kOverTube_m});
  return boxes;
}

std::vector<NamedBox> Parts(const GripperBoxes& boxes) {
  std::vector<NamedBox> parts = {{"fingers", boxes.fingers}};
  parts.insert(parts.end(), boxes.carrying.begin(), boxes.carrying.end());
  return parts;
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
