#include "planner/scene_query/sweep.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "planner/scene_query/tubes.h"

namespace tubetwin {
namespace {

constexpr double kStep_m = 0.005;
constexpr double kChord_m = 0.001;        // Error of simplified lines, part of the margin.
constexpr double kOverlap_m = 0.003;      // More than perception's error: one lies in the other.
constexpr double kOverFingers_m = 0.015;  // of what they hang on, over what they hold
constexpr double kNearer_m = 3e-4;  // Coming nearer by less than this is arithmetic, not a push.

double Top(const Polyline& line) {
  double top = line.front().z();
  for (const Vector3& p : line) top = std::max(top, p.z());
  return top;
}

double Bottom(const Polyline& line) {
  double bottom = line.front().z();
  for (const Vector3& p : line) bottom = std::min(bottom, p.z());
  return bottom;
}

// Poses of the motion every kStep_m, the start first, and from which of them on it only rises.
struct Track {
  std::vector<RigidTransform> poses;
  std::size_t rising_from = 0;
  bool slides_first = false;  // What lies against the tube is dragged at once.
};

Track TrackOf(const TubePath& motion, const Polyline& moving) {
  double reach_m = 0.0;
  for (const Vector3& p : moving) reach_m = std::max(reach_m, (p - motion.pivot_N).norm());
  Track track{PosesAlong(motion, kStep_m, reach_m)};
  for (std::size_t k = 1; k < track.poses.size(); ++k) {
    const RigidTransform &before = track.poses[k - 1], &pose = track.poses[k];
    const Vector3 way = pose.translation() - before.translation();
    if (way.head<2>().norm() > 1e-9 || way.z() < 0.0 ||
        !pose.linear().isApprox(before.linear(), 1e-9)) {
      track.rising_from = k;
      if (k == 1) track.slides_first = true;
    }
  }
  return track;
}

bool Touches(const Polyline& moving, const Polyline& other, double radii_m, const Track& track,
             double margin_m) {
  const double top = Top(other);
  const double start = ClosestOfLines(moving, other).distance_m - radii_m;
  if (track.slides_first && start < margin_m) return true;
  if (start < -kOverlap_m) return true;  // They will push each other apart.
  const double allowed = std::min(margin_m, start - kNearer_m);
  for (std::size_t k = 1; k < track.poses.size(); ++k) {
    const Polyline moved = Transformed(track.poses[k], moving);
    // From here on it only rises, and it is over the other already.
    if (k > track.rising_from && Bottom(moved) > top + radii_m + margin_m) return false;
    if (ClosestOfLines(moved, other).distance_m - radii_m < allowed) return true;
  }
  return false;
}

// Ids of the others that it touches, at most `max_count` of them.
std::vector<int> Touched(const TubeScene& scene, const TubePath& motion, const Polyline& moving,
                         double radius_m, const Track& track, double margin_m,
                         std::size_t max_count) {
  std::vector<int> touched;
  for (const PerceivedTube& other : scene.tubes) {
    if (touched.size() == max_count) break;
    if (other.id == motion.tube) continue;
    if (Touches(moving, Simplified(other.centerline_N, kChord_m), radius_m + other.radius_m, track,
                margin_m)) {
      touched.push_back(other.id);
    }
  }
  return touched;
}

std::vector<int> TouchedByTube(const TubeScene& scene, const TubePath& motion, double margin_m,
                               std::size_t max_count) {
  TT_CHECK(!motion.waypoints_N.empty());
  const PerceivedTube& tube = TubeOf(scene, motion.tube);
  const Polyline moving = Simplified(tube.centerline_N, kChord_m);
  return Touched(scene, motion, moving, tube.radius_m, TrackOf(motion, moving), margin_m,
                 max_count);
}

std::optional<int> First(const std::vector<int>& ids) {
  return ids.empty() ? std::nullopt : std::optional<int>(ids.front());
}

}  // namespace

std::optional<int> FirstTouched(const TubeScene& scene, const TubePath& motion, double margin_m) {
  return First(TouchedByTube(scene, motion, margin_m, 1));
}

int CountTouched(const TubeScene& scene, const TubePath& motion, double margin_m) {
  return static_cast<int>(TouchedByTube(scene, motion, margin_m, scene.tubes.size()).size());
}

std::optional<int> FirstTouchedByFingers(const TubeScene& scene, const TubePath& motion,
                                         const Vector3& p_N, const GripperSpec& gripper,
                                         double margin_m) {
  TT_CHECK(!motion.waypoints_N.empty());
  const double radius_m = std::hypot(
      0.5 * gripper.pad_width_m, TubeOf(scene, motion.tube).radius_m + gripper.finger_thickness_m);
  const Polyline fingers = {p_N, p_N + Vector3(0, 0, gripper.finger_length_m + kOverFingers_m)};
  const Track track = TrackOf(motion, fingers);
  if (track.rising_from == 0) return std::nullopt;
  return First(Touched(scene, motion, fingers, radius_m, track, margin_m, 1));
}

}  // namespace tubetwin
