#include <algorithm>

#include "planner/extraction/generators.h"

namespace tubetwin {
namespace {

constexpr double kSlow_m_s = 0.10;

}  // namespace

MotionSet MakeUpSlow(const ExtractionInput& input) {
  CandidateMotion slow = BeginMotion(input, "up_slow", "up_slow");
  slow.speed_m_s = std::min(kSlow_m_s, input.config.lift_speed_m_s);
  GoUp(slow, input.config.lift_m);
  return {{slow}, {}};
}

}  // namespace tubetwin
