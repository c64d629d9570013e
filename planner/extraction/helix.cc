#include <cmath>

#include "planner/extraction/generators.h"
#include "planner/extraction/within_walls.h"
#include "planner/scene_query/tubes.h"

namespace tubetwin {
namespace {

constexpr double kRadius_m = 0.05, kRise_m = 0.25;
constexpr int kPointsPerHalfTurn = 4;

CandidateMotion Helix(const ExtractionInput& input, int half_turns, int sense) {
  const Vector3 chord = ChordDirection(input.tube), across(-chord.y(), chord.x(), 0.0);
  CandidateMotion helix = BeginMotion(
      input, "helix",
      std::string(half_turns == 1 ? "helix_half" : "helix_full") + (sense > 0 ? "+" : "-"));
  const int points = half_turns * kPointsPerHalfTurn;
  for (int k = 1; k <= points; ++k) {
    // The circle's centre lies across the tube, so that the way begins along it.
    const double angle = sense * half_turns * kPi * k / points;
    helix.waypoints_N.push_back(kRadius_m *
                                    (std::sin(angle) * chord + (1.0 - std::cos(angle)) * across) +
                                Vector3(0, 0, kRise_m * k / points));
  }
  GoUp(helix, input.config.lift_m);
  KeepWithinWalls(input, helix);
  return helix;
}

}  // namespace

MotionSet MakeHelices(const ExtractionInput& input) {
  MotionSet set;
  for (const int half_turns : {1, 2}) {
    for (const int sense : {1, -1}) set.motions.push_back(Helix(input, half_turns, sense));
  }
  return set;
}

}  // namespace tubetwin
