#include "planner/resolution/strategies.h"

namespace tubetwin {

PickPath MakePlus45(const ResolutionInput& input) {
  return TiltPath(input, LoadAxis(input), {input.config.angle_deg});
}

}  // namespace tubetwin
