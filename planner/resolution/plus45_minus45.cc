#include "planner/resolution/strategies.h"

namespace tubetwin {

PickPath MakePlus45Minus45(const ResolutionInput& input) {
  const double angle_deg = input.config.angle_deg;
  return TiltPath(input, LoadAxis(input), {angle_deg, -angle_deg});
}

}  // namespace tubetwin
