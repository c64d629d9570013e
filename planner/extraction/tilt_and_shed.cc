#include <array>
#include <cmath>

#include "planner/extraction/generators.h"
#include "planner/scene_query/tubes.h"

namespace tubetwin {
namespace {

// Steep enough for rubber to slide on rubber, turned in one leg because the arm stands still at
// waypoints; half the tube stays over the walls.
constexpr double kTilt_deg = 75.0, kOverWalls_m = 0.01;
constexpr std::array<double, 3> kYaws_deg = {0.0, 60.0, -60.0};  // Of the variants.

CandidateMotion Shed(const ExtractionInput& input, const std::string& name, const Vector3& axis,
                     int variant) {
  const PerceivedTube& tube = input.tube;
  const double half_m = 0.5 * Length(tube.centerline_N);
  const double height_m =
      input.bin.wall_m() + half_m * std::sin(Radians(kTilt_deg)) + tube.radius_m + kOverWalls_m;
  CandidateMotion motion = BeginMotion(input, "tilt_and_shed", name);
  motion.variant = variant;
  motion.pivot_N = PointAt(tube.centerline_N, half_m);
  motion.rotations_N = {Eigen::Quaterniond::Identity()};
  GoUp(motion, height_m);
  // What slides off falls into the bin.
  const Vector3 over_middle(-motion.pivot_N.x(), -motion.pivot_N.y(), height_m);
  const Eigen::Quaterniond yaw(Eigen::AngleAxisd(Radians(kYaws_deg[variant]), Vector3::UnitZ()));
  for (const double angle_deg : {0.0, kTilt_deg, 0.0, -kTilt_deg, 0.0}) {
    motion.waypoints_N.push_back(over_middle);
    motion.rotations_N.push_back(yaw * Eigen::AngleAxisd(Radians(angle_deg), axis));
  }
  if (input.config.lift_m > height_m) {
    GoUp(motion, input.config.lift_m - height_m);
    motion.rotations_N.back() = yaw;
  }
  return motion;
}

}  // namespace

MotionSet MakeTiltAndShed(const ExtractionInput& input) {
  const Vector3 chord = ChordDirection(input.tube), across(-chord.y(), chord.x(), 0.0);
  MotionSet set;
  for (int k = 0; k < 3; ++k) set.motions.push_back(Shed(input, "roll", chord, k));
  for (int k = 0; k < 3; ++k) set.motions.push_back(Shed(input, "pitch", across, k));
  return set;
}

}  // namespace tubetwin
