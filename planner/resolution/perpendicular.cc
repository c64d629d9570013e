#include "planner/resolution/strategies.h"

namespace tubetwin {

PickPath MakePerpendicular(const ResolutionInput& input) {
  const Vector3 axis_B = LoadAxis(input);
  const double angle_deg = input.config.angle_deg;
  return TiltPath(input, {-axis_B.y(), axis_B.x(), 0.0}, {angle_deg, -angle_deg});
}

}  // namespace tubetwin
