#include "planner/extraction/more_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "models/base/text.h"
#include "planner/scene_query/tube_obstacles.h"
#include "planner/scene_query/wall_clearance.h"

namespace tubetwin {
namespace {

constexpr double kWayStep_m = 0.020;  // Between places on the way that are tried.
constexpr int kDirections = 24;
constexpr int kLegDirections = 12;  // Of either of two legs.
constexpr std::array<double, 2> kFirstLegs_m = {0.06, 0.12};
constexpr double kApart_deg = 60.0;    // Of the two best directions.
constexpr double kTouchCost_m = 0.10;  // A newly touched tube costs as much as so long a way.
constexpr double kShakeLift_m = 0.10, kShake_m = 0.04;
constexpr int kShakeStrokes = 3;
constexpr double kSlow_m_s = 0.10;
// A tip: steep enough for rubber to slide on rubber, turned in one leg because the arm stands still
// at waypoints; half the tube stays over the walls.
constexpr double kTip_deg = 75.0, kOverWalls_m = 0.01;
constexpr double kTipped_deg = 45.0;
constexpr std::array<double, 3> kTipYaws_deg = {0.0, 60.0, -60.0};
constexpr double kHemisphere_m = 0.15;
constexpr int kAzimuths = 8;
constexpr double kHelixRadius_m = 0.05, kHelixRise_m = 0.25;
constexpr int kHelixPoints = 8;  // In one turn.

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

/// How far along a direction nothing covers the tube any more; the wall's room when it never ends.
struct WayOut {
  Vector3 direction = Vector3::UnitX();
  double way_m = 0.0, cost_m = 0.0;
  bool clear = false;
};

/// From where the tube was shifted to.
WayOut FindWayOut(const TubeObstacles& around, const PerceivedTube& tube, const Vector3& direction,
                  const Bin& bin, const PlannerConfig& config,
                  const Vector3& from = Vector3::Zero()) {
  WayOut out;
  out.direction = direction;
  const double room = MaxSlideDistance(tube, direction, bin, config.wall_safety_m);
  for (double way = kWayStep_m; way <= room; way += kWayStep_m) {
    out.way_m = way;
    if (around.Covered(from + way * direction)) continue;
    out.clear = true;
    out.way_m = std::min(room, way + tube.radius_m);
    break;
  }
  if (!out.clear) return out;
  int touched = 0;
  for (double way = kWayStep_m; way <= out.way_m; way += 2.0 * kWayStep_m) {
    touched = std::max(touched, around.NewlyTouched(from + way * direction));
  }
  out.cost_m = out.way_m + kTouchCost_m * touched;
  return out;
}

void AddWayOut(const TubeObstacles& around, const PerceivedTube& tube, const WayOut& way,
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
  motion.blocked_m = around.BlockedGrasps(slide, config.grasp_step_m);
  set.motions.push_back(std::move(motion));
}

Vector3 Direction(int k, int of) {
  const double angle = 2.0 * kPi * k / of;
  return {std::cos(angle), std::sin(angle), 0.0};
}

/// The cheapest way out of two legs that is cheaper than `best_cost_m`, or none.
std::optional<CandidateMotion> FindTwoLegs(const TubeObstacles& around, const PerceivedTube& tube,
                                           const Bin& bin, const PlannerConfig& config,
                                           double best_cost_m) {
  std::optional<CandidateMotion> best;
  for (int a = 0; a < kLegDirections; ++a) {
    const Vector3 first = Direction(a, kLegDirections);
    const double room_m = MaxSlideDistance(tube, first, bin, config.wall_safety_m);
    for (const double leg_m : kFirstLegs_m) {
      if (leg_m > room_m) break;
      const Vector3 corner = leg_m * first;
      PerceivedTube there = tube;
      there.centerline_N = Transformed(Translation(corner), tube.centerline_N);
      const double corner_cost_m = leg_m + kTouchCost_m * around.NewlyTouched(corner);
      if (corner_cost_m >= best_cost_m) continue;
      for (int b = 0; b < kLegDirections; ++b) {
        const Vector3 second = Direction(b, kLegDirections);
        // Straight on was tried, and back is no way.
        if (std::abs(second.dot(first)) > std::cos(Radians(25.0))) continue;
        const WayOut way = FindWayOut(around, there, second, bin, config, corner);
        if (!way.clear || corner_cost_m + way.cost_m >= best_cost_m) continue;
        best_cost_m = corner_cost_m + way.cost_m;
        best = Named(tube, "escape_corner", config);
        best->waypoints_N.push_back(corner);
        best->waypoints_N.push_back(corner + way.way_m * second);
        GoUp(*best, config.lift_m);
      }
    }
  }
  if (!best) return best;
  for (const int leg : {1, 2}) {
    const Vector3 from = best->waypoints_N[leg - 1], way = best->waypoints_N[leg] - from;
    const auto blocked = around.BlockedGrasps(way, config.grasp_step_m, from);
    best->blocked_m.insert(best->blocked_m.end(), blocked.begin(), blocked.end());
  }
  return best;
}

/// A horizontal shift, shortened so that the whole tube keeps off the walls.
Vector3 WithinWalls(const PerceivedTube& tube, const Vector3& shift, const Bin& bin,
                    const PlannerConfig& config) {
  const Vector3 flat(shift.x(), shift.y(), 0.0);
  if (flat.norm() < 1e-9) return shift;
  const double room = MaxSlideDistance(tube, flat.normalized(), bin, config.wall_safety_m);
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
  const TubeObstacles around(scene, tube);
  if (!around.Covered(Vector3::Zero())) return set;
  const Vector3 chord = ChordDirection(tube);
  AddWayOut(around, tube, FindWayOut(around, tube, chord, bin, config), "slide+", config, set);
  AddWayOut(around, tube, FindWayOut(around, tube, -chord, bin, config), "slide-", config, set);
  std::vector<WayOut> ways;
  for (int k = 0; k < kDirections; ++k) {
    const WayOut way = FindWayOut(around, tube, Direction(k, kDirections), bin, config);
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
  const WayOut& best = ways.front();
  if (best.cost_m > best.way_m) {
    if (auto corner = FindTwoLegs(around, tube, bin, config, best.cost_m)) {
      set.motions.push_back(*std::move(corner));
    }
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

MotionSet MakeTips(const PerceivedTube& tube, const Bin& bin, const PlannerConfig& config) {
  MotionSet set;
  const double half_m = 0.5 * Length(tube.centerline_N);
  const double height_m =
      bin.wall_m() + half_m * std::sin(Radians(kTip_deg)) + tube.radius_m + kOverWalls_m;
  const Vector3 chord = ChordDirection(tube), across(-chord.y(), chord.x(), 0.0);
  const auto add = [&](const std::string& name, const Vector3& axis, double yaw_deg) {
    CandidateMotion tip = Named(tube, name, config);
    tip.pivot_N = PointAt(tube.centerline_N, half_m);
    tip.rotations_N = {Eigen::Quaterniond::Identity()};
    const auto go = [&](const Vector3& to, const Eigen::Quaterniond& rotation) {
      tip.waypoints_N.push_back(to);
      tip.rotations_N.push_back(rotation);
    };
    go({0, 0, height_m}, Eigen::Quaterniond::Identity());
    // What slides off falls into the bin.
    const Vector3 over_middle(-tip.pivot_N.x(), -tip.pivot_N.y(), height_m);
    const Eigen::Quaterniond yaw(Eigen::AngleAxisd(Radians(yaw_deg), Vector3::UnitZ()));
    for (const double angle_deg : {0.0, kTip_deg, 0.0, -kTip_deg, 0.0}) {
      go(over_middle, yaw * Eigen::AngleAxisd(Radians(angle_deg), axis));
    }
    if (config.lift_m > height_m) {
      GoUp(tip, config.lift_m - height_m);
      tip.rotations_N.push_back(yaw);
    }
    set.motions.push_back(std::move(tip));
  };
  for (const double yaw_deg : kTipYaws_deg) add("roll", chord, yaw_deg);
  for (const double yaw_deg : kTipYaws_deg) add("pitch", across, yaw_deg);
  return set;
}

bool IsTurnedOver(const Eigen::Quaterniond& rotation, double more_than_deg) {
  return (rotation * Vector3::UnitZ()).z() < std::cos(Radians(more_than_deg));
}

bool IsTip(const ObjectPath& way) {
  return std::any_of(way.rotations_N.begin(), way.rotations_N.end(),
                     [](const auto& rotation) { return IsTurnedOver(rotation, kTipped_deg); });
}

}  // namespace tubetwin
