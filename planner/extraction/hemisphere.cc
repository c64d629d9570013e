#include <cmath>

#include "planner/extraction/generators.h"
#include "planner/extraction/within_walls.h"

namespace tubetwin {
namespace {

constexpr double kRadius_m = 0.15;
constexpr int kAzimuths = 8;

}  // namespace

MotionSet MakeHemisphere(const ExtractionInput& input) {
  MotionSet set;
  int point = 0;
  for (const double from_vertical_deg : {30.0, 60.0}) {
    const double flat_m = kRadius_m * std::sin(Radians(from_vertical_deg));
    const double rise_m = kRadius_m * std::cos(Radians(from_vertical_deg));
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = 2.0 * kPi * k / kAzimuths;
      CandidateMotion to = BeginMotion(input, "hemisphere", "hemisphere" + std::to_string(++point));
      to.waypoints_N.emplace_back(flat_m * std::cos(azimuth), flat_m * std::sin(azimuth), rise_m);
      GoUp(to, input.config.lift_m);
      KeepWithinWalls(input, to);
      set.motions.push_back(std::move(to));
    }
  }
  return set;
}

}  // namespace tubetwin
