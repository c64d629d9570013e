#include "planner/extraction/generators.h"
#include "planner/extraction/within_walls.h"
#include "planner/scene_query/tubes.h"

namespace tubetwin {
namespace {

constexpr double kLift_m = 0.10, kHalfStroke_m = 0.04;
constexpr int kStrokes = 3;

}  // namespace

MotionSet MakeShake(const ExtractionInput& input) {
  const Vector3 chord = ChordDirection(input.tube), across(-chord.y(), chord.x(), 0.0);
  CandidateMotion shake = BeginMotion(input, "shake", "shake");
  GoUp(shake, kLift_m);
  for (int k = 0; k < kStrokes; ++k) {
    shake.waypoints_N.push_back(Vector3(0, 0, kLift_m) +
                                (k % 2 == 0 ? kHalfStroke_m : -kHalfStroke_m) * across);
  }
  shake.waypoints_N.emplace_back(0, 0, kLift_m);
  GoUp(shake, input.config.lift_m);
  KeepWithinWalls(input, shake);
  return {{shake}, {}};
}

}  // namespace tubetwin
