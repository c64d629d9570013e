#include "planner/motion/path_builder.h"
#include "planner/resolution/strategies.h"

namespace tubetwin {
namespace {

constexpr double kOverFloor_m = 0.10;
constexpr double kRest_s = 0.3;

}  // namespace

PickPath MakePutback(const ResolutionInput& input) {
  const RigidTransform top = TiltStation(input);
  RigidTransform down = top;
  down.translation().z() = input.bin.X_BN.translation().z() + kOverFloor_m;
  PathBuilder path(input.paths, input.ramp_s);
  path.Line("to the tilt station", To(top), input.lift_speed_m_s);
  path.Line("lowering and lifting again", To(down), input.lift_speed_m_s);
  path.Pause("rest", kRest_s);
  path.Line("lifting again", To(top), input.lift_speed_m_s);
  return path.path();
}

}  // namespace tubetwin
