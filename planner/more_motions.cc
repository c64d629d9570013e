#include "planner/more_motions.h"

#include <algorithm>
#include <cmath>

#include "hw_bridge/base/text.h"
#include "planner/sweep.h"
#include "planner/wall_room.h"

namespace tubetwin {
namespace {

constexpr double kChord_m = 0.001;    // Error of simplified lines.
constexpr double kSample_m = 0.010;   // Between points of the tube that slides.
constexpr double kWayStep_m = 0.020;  // Between places on the way that are tried.
constexpr int kDirections = 24;
constexpr double kApart_deg = 60.0;    // Of the two best directions.
constexpr double kTouchCost_m = 0.10;  // A newly touched tube costs as much as so long a way.
constexpr double kGripper_m = 0.045;   // Fingers around a tube, from its axis, and the hand above.
constexpr double kNearGrasp_m = 0.02;  // How it stands at the start is the grasp's own question.
constexpr double kShakeLift_m = 0.10, kShake_m = 0.04;
constexpr int kShakeStrokes = 3;
constexpr double kSlow_m_s = 0.10;
constexpr double kHemisphere_m = 0.15;
constexpr int kAzimuths = 8;
constexpr double kHelixRadius_m = 0.05, kHelixRise_m = 0.25;
constexpr int kHelixPoints = 8;  // In one turn.

struct Other {
  Polyline line;
  double radius_m = 0.0;
};

/// The tube that moves and the others, as points and simplified lines.
class Surround {
 public:
  Surround(const TubeScene& scene, const PerceivedTube& tube)
      : tube_(tube), points_(Resample(tube.centerline_N, kSample_m)) {
    for (const PerceivedTube& other : scene.tubes) {
      if (other.id == tube.id) continue;
      others_.push_back({Simplify(other.centerline_N, kChord_m), other.radius_m});
    }
  }

  /// Does any other tube lie over the moved one?
  bool Covered(const Vector3& shift) const {
    return std::any_of(others_.begin(), others_.end(), [&](const Other& other) {
      const double reach = tube_.radius_m + other.radius_m;
      return std::any_of(points_.begin(), points_.end(), [&](const Vector3& p) {
        return Over(other.line, p + shift, reach, p.z() + 0.5 * reach);
      });
    });
  }

  /// Tubes that the moved one overlaps although it did not at the start.
  int NewlyTouched(const Vector3& shift) const {
    const Polyline moving = Transformed(Translation(shift), Simplify(tube_.centerline_N, kChord_m));
    int count = 0;
    for (const Other& other : others_) {
      const double reach = tube_.radius_m + other.radius_m;
      const double before = ClosestOfLines(tube_.centerline_N, other.line).distance_m;
      const double now = ClosestOfLines(moving, other.line).distance_m;
      if (now < reach - 0.003 && now < before - 0.003) ++count;
    }
    return count;
  }

  /// Would a gripper that holds the tube at p meet another tube on the way?
  bool GripperMeets(const Vector3& p, const Vector3& way) const {
    const double length = way.norm();
    for (double gone = kNearGrasp_m; gone <= length; gone += 0.5 * kWayStep_m) {
      const Vector3 at = p + gone / length * way;
      for (const Other& other : others_) {
        if (Over(other.line, at, kGripper_m, at.z() - 0.5 * tube_.radius_m)) return true;
      }
    }
    return false;
  }

 private:
  /// Some point of the line lies within `reach` of p seen from above, higher than z.
  static bool Over(const Polyline& line, const Vector3& p, double reach, double z) {
    for (std::size_t k = 1; k < line.size(); ++k) {
      const Eigen::Vector2d a = line[k - 1].head<2>(), d = line[k].head<2>() - a;
      const double length2 = d.squaredNorm();
      const Eigen::Vector2d q = p.head<2>();
      const double t = length2 > 0.0 ? std::clamp(d.dot(q - a) / length2, 0.0, 1.0) : 0.0;
      if ((q - a - t * d).norm() >= reach) continue;
      if (line[k - 1].z() + t * (line[k].z() - line[k - 1].z()) > z) return true;
    }
    return false;
  }

  const PerceivedTube& tube_;
  const Polyline points_;
  std::vector<Other> others_;
};

CandidateMotion Named(const PerceivedTube& tube, const std::string& name,
                      const PlannerConfig& config) {
  CandidateMotion motion;
  motion.tube = tube.id;
  motion.name = name;
  motion.speed_m_s = config.lift_speed_m_s;
  motion.waypoints_N = {Vector3::Zero()};
  return motion;
}

void GoUp(CandidateMotion& motion, double by_m) {
  motion.waypoints_N.push_back(motion.waypoints_N.back() + Vector3(0, 0, by_m));
}

/// Where the gripper may not hold: it would meet a tube on the straight way.
void Block(const Surround& around, const PerceivedTube& tube, const Vector3& way,
           const PlannerConfig& config, CandidateMotion& motion) {
  const double length = Length(tube.centerline_N), half = 0.5 * config.grasp_step_m;
  for (double s = 0.0; s <= length; s += config.grasp_step_m) {
    if (!around.GripperMeets(PointAt(tube.centerline_N, s), way)) continue;
    motion.blocked_m.emplace_back(s - half, s + half);
  }
}

/// How far along a direction nothing covers the tube any more; the wall's room when it never ends.
struct WayOut {
  Vector3 direction = Vector3::UnitX();
  double way_m = 0.0, cost_m = 0.0;
  bool clear = false;
};

WayOut FindWayOut(const Surround& around, const PerceivedTube& tube, const Vector3& direction,
                  const Bin& bin, const PlannerConfig& config) {
  WayOut out;
  out.direction = direction;
  const double room = AllowedSlide(tube, direction, bin, config.wall_safety_m);
  for (double way = kWayStep_m; way <= room; way += kWayStep_m) {
    out.way_m = way;
    if (around.Covered(way * direction)) continue;
    out.clear = true;
    out.way_m = std::min(room, way + tube.radius_m);
    break;
  }
  if (!out.clear) return out;
  int touched = 0;
  for (double way = kWayStep_m; way <= out.way_m; way += 2.0 * kWayStep_m) {
    touched = std::max(touched, around.NewlyTouched(way * direction));
  }
  out.cost_m = out.way_m + kTouchCost_m * touched;
  return out;
}

void AddWayOut(const Surround& around, const PerceivedTube& tube, const WayOut& way,
               const std::string& name, const PlannerConfig& config, MotionSet& set) {
  if (!way.clear) {
    set.rejections.push_back({tube.id, name, "",
                              "still covered where the bin's wall ends the slide, after " +
                                  Number(std::round(way.way_m * 1e3)) + " mm"});
    return;
  }
  CandidateMotion motion = Named(tube, name, config);
  const Vector3 slide = way.way_m * way.direction;
  motion.waypoints_N.push_back(slide);
  GoUp(motion, config.lift_m);
  Block(around, tube, slide, config, motion);
  set.motions.push_back(std::move(motion));
}

/// A horizontal shift, shortened so that the whole tube keeps off the walls.
Vector3 WithinWalls(const PerceivedTube& tube, const Vector3& shift, const Bin& bin,
                    const PlannerConfig& config) {
  const Vector3 flat(shift.x(), shift.y(), 0.0);
  if (flat.norm() < 1e-9) return shift;
  const double room = AllowedSlide(tube, flat.normalized(), bin, config.wall_safety_m);
  const Vector3 kept = flat * std::min(1.0, room / flat.norm());
  return {kept.x(), kept.y(), shift.z()};
}

Vector3 ChordDirection(const PerceivedTube& tube) {
  Vector3 chord = tube.centerline_N.back() - tube.centerline_N.front();
  chord.z() = 0.0;
  return chord.norm() > 1e-3 ? chord.normalized() : Vector3(Vector3::UnitX());
}

}  // namespace

MotionSet MakeWaysOut(const TubeScene& scene, const PerceivedTube& tube, const Bin& bin,
                      const PlannerConfig& config) {
  MotionSet set;
  const Surround around(scene, tube);
  if (!around.Covered(Vector3::Zero())) return set;
  const Vector3 chord = ChordDirection(tube);
  AddWayOut(around, tube, FindWayOut(around, tube, chord, bin, config), "slide+", config, set);
  AddWayOut(around, tube, FindWayOut(around, tube, -chord, bin, config), "slide-", config, set);
  std::vector<WayOut> ways;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * kPi * k / kDirections;
    const WayOut way =
        FindWayOut(around, tube, Vector3(std::cos(angle), std::sin(angle), 0.0), bin, config);
    if (way.clear) ways.push_back(way);
  }
  std::stable_sort(ways.begin(), ways.end(),
                   [](const WayOut& a, const WayOut& b) { return a.cost_m < b.cost_m; });
  if (ways.empty()) {
    set.rejections.push_back(
        {tube.id, "escape_away", "", "covered in every direction as far as the walls allow"});
    return set;
  }
  AddWayOut(around, tube, ways.front(), "escape_away", config, set);
  for (const WayOut& way : ways) {
    if (way.direction.dot(ways.front().direction) > std::cos(Radians(kApart_deg)) + 1e-9) continue;
    AddWayOut(around, tube, way, "escape_away2", config, set);
    break;
  }
  return set;
}

MotionSet MakeSeparations(const PerceivedTube& tube, const Bin& bin, const PlannerConfig& config) {
  MotionSet set;
  const auto keep = [&](CandidateMotion motion) {
    for (Vector3& p : motion.waypoints_N) p = WithinWalls(tube, p, bin, config);
    set.motions.push_back(std::move(motion));
  };
  CandidateMotion slow = Named(tube, "up_slow", config);
  slow.speed_m_s = std::min(kSlow_m_s, config.lift_speed_m_s);
  GoUp(slow, config.lift_m);
  keep(slow);

  const Vector3 chord = ChordDirection(tube), across(-chord.y(), chord.x(), 0.0);
  CandidateMotion shake = Named(tube, "shake", config);
  GoUp(shake, kShakeLift_m);
  for (int k = 0; k < kShakeStrokes; ++k) {
    shake.waypoints_N.push_back(Vector3(0, 0, kShakeLift_m) +
                                (k % 2 == 0 ? kShake_m : -kShake_m) * across);
  }
  shake.waypoints_N.emplace_back(0, 0, kShakeLift_m);
  GoUp(shake, config.lift_m);
  keep(shake);

  int point = 0;
  for (const double from_vertical_deg : {30.0, 60.0}) {
    const double flat = kHemisphere_m * std::sin(Radians(from_vertical_deg));
    const double rise = kHemisphere_m * std::cos(Radians(from_vertical_deg));
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = 2.0 * kPi * k / kAzimuths;
      CandidateMotion to = Named(tube, "hemisphere" + std::to_string(++point), config);
      to.waypoints_N.emplace_back(flat * std::cos(azimuth), flat * std::sin(azimuth), rise);
      GoUp(to, config.lift_m);
      keep(to);
    }
  }

  for (const int turns : {1, 2}) {  // Half turns.
    for (const int sense : {1, -1}) {
      CandidateMotion helix = Named(
          tube, std::string(turns == 1 ? "helix_half" : "helix_full") + (sense > 0 ? "+" : "-"),
          config);
      const int points = turns * kHelixPoints / 2;
      for (int k = 1; k <= points; ++k) {
        // The circle's centre lies across the tube, so that the way begins along it.
        const double angle = sense * turns * kPi * k / points;
        helix.waypoints_N.push_back(
            kHelixRadius_m * (std::sin(angle) * chord + (1.0 - std::cos(angle)) * across) +
            Vector3(0, 0, kHelixRise_m * k / points));
      }
      GoUp(helix, config.lift_m);
      keep(helix);
    }
  }
  return set;
}

}  // namespace tubetwin
