#include "planner/gripper_boxes.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

// The public model's linkage (reference figures of the 2F-85): crank ends 43 mm behind the pads'
// centre and 26 mm outside the pads' faces, links 16 mm thick; body 75 mm across from 86 mm behind.
constexpr double kKnuckleBehind_m = 0.035;
constexpr double kKnuckleOutside_m = 0.034;
constexpr double kKnuckleHalfX_m = 0.0135;
constexpr double kPalmBehind_m = 0.086;
constexpr double kPalmHalf_m = 0.0375;
constexpr double kTopBehind_m = 0.145;  // The flange's coupling.

// Box from its bounds in E.
OrientedBox Between(const Vector3& low, const Vector3& high) {
  return {Translation(0.5 * (low + high)), 0.5 * (high - low)};
}

}  // namespace

GripperBoxes MakeGripperBoxes(double opening_m, double tube_radius_m, double height_over_axis_m,
                              const GripperSpec& spec) {
  const double hx = 0.5 * spec.pad_width_m, hy = 0.5 * opening_m;
  const double outer = hy + spec.finger_thickness_m;
  const double tip = 0.5 * spec.pad_height_m;
  GripperBoxes boxes;
  boxes.fingers = Between({-hx, -outer, -kPalmBehind_m}, {hx, outer, tip});
  boxes.finger[0] = Between({-hx, -outer, -kPalmBehind_m}, {hx, -hy, tip});
  boxes.finger[1] = Between({-hx, hy, -kPalmBehind_m}, {hx, outer, tip});
  // Measured points of the tube itself and their noise stay below this box.
  constexpr double kOverTube_m = 0.005;
  boxes.above_tube = Between({-hx, -hy, -kPalmBehind_m},
                             {hx, hy, height_over_axis_m - tube_radius_m - kOverTube_m});
  const double wide = hy + kKnuckleOutside_m;
  boxes.knuckles = Between({-kKnuckleHalfX_m, -wide, -kPalmBehind_m},
                           {kKnuckleHalfX_m, wide, -kKnuckleBehind_m});
  boxes.palm = Between({-kPalmHalf_m, -kPalmHalf_m, -kTopBehind_m},
                       {kPalmHalf_m, kPalmHalf_m, -kPalmBehind_m});
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
