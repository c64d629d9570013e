#include "planner/extraction/generators.h"

namespace tubetwin {

CandidateMotion StraightUp(const ExtractionInput& input) {
  CandidateMotion up = BeginMotion(input, "up", "up");
  GoUp(up, input.config.lift_m);
  return up;
}

MotionSet MakeUp(const ExtractionInput& input) { return {{StraightUp(input)}, {}}; }

}  // namespace tubetwin
