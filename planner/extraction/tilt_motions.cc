#include "planner/extraction/tilt_motions.h"

#include <algorithm>
#include <cmath>

#include "models/base/text.h"
#include "planner/scene_query/tube_obstacles.h"
#include "planner/scene_query/wall_clearance.h"

namespace tubetwin {
namespace {

constexpr double kRaise_m = 0.05;  // Of the lid over the tube that slides out.
constexpr double kMostTilt_deg = 20.0;
constexpr double kTurnStep_deg =
    10.0;                             // Between waypoints: the hand's straight ways are arcs then.
constexpr double kNearest_m = 0.06;   // Of the far contact.
constexpr double kOnFloor_m = 0.004;  // A tube whose surface is lower lies on the floor.
constexpr double kMargin_m = 0.010;
constexpr double kStep_m = 0.005;

const PerceivedTube& TubeOf(const TubeScene& scene, int id) {
  return *std::find_if(scene.tubes.begin(), scene.tubes.end(),
                       [id](const PerceivedTube& tube) { return tube.id == id; });
}

Vector3 Flat(const Vector3& p) { return {p.x(), p.y(), 0.0}; }

double Lowest(const Polyline& line) {
  double low = line.front().z();
  for (const Vector3& p : line) low = std::min(low, p.z());
  return low;
}

/// Largest way along a horizontal direction from p of the line's points between two arc lengths.
double Reach(const Polyline& line, double from_m, double to_m, const Vector3& p,
             const Vector3& direction) {
  double reach = 0.0;
  for (double s = from_m; s <= to_m; s += kStep_m) {
    reach = std::max(reach, direction.dot(PointAt(line, s) - p));
  }
  return reach;
}

/// The lid's geometry at one crossing.
struct Lid {
  Vector3 contact = Vector3::Zero(), far = Vector3::Zero();
  Vector3 out = Vector3::UnitX();  ///< Horizontal, from the far contact to the crossing.
  double lever_m = 0.0;            ///< Horizontal distance of both.
  double overhang_m = 0.0;         ///< Of the near end beyond the crossing, along `out`.
};

Lid LidAt(const TubeScene& scene, const Crossing& crossing) {
  const PerceivedTube& over = TubeOf(scene, crossing.over);
  const double length = Length(over.centerline_N), at_m = crossing.at_over_m;
  const bool start_is_near = at_m < 0.5 * length;
  Lid lid;
  lid.contact = PointAt(over.centerline_N, at_m);
  lid.far = FarContact(scene, over, at_m, start_is_near ? +1 : -1, crossing.under);
  const Vector3 apart = Flat(lid.contact - lid.far);
  lid.lever_m = apart.norm();
  if (lid.lever_m > 1e-6) lid.out = apart / lid.lever_m;
  lid.overhang_m = Reach(over.centerline_N, start_is_near ? 0.0 : at_m,
                         start_is_near ? at_m : length, lid.contact, lid.out);
  return lid;
}

}  // namespace

Vector3 FarContact(const TubeScene& scene, const PerceivedTube& tube, double at_m, int side,
                   int not_id) {
  const Polyline& line = tube.centerline_N;
  const double length = Length(line);
  std::vector<double> contacts;
  for (const Crossing& crossing : scene.crossings) {
    if (crossing.over == tube.id && crossing.under != not_id)
      contacts.push_back(crossing.at_over_m);
  }
  for (double s = 0.0; s <= length; s += kStep_m) {
    if (PointAt(line, s).z() - tube.radius_m < kOnFloor_m) contacts.push_back(s);
  }
  double farthest = at_m;
  for (const double s : contacts) {
    if (side * (s - farthest) > 0.0) farthest = s;
  }
  if (farthest == at_m) farthest = side > 0 ? length : 0.0;
  return PointAt(line, farthest);
}

MotionSet MakeTilts(const TubeScene& scene, const PerceivedTube& tube, const Bin& bin,
                    const PlannerConfig& config) {
  MotionSet set;
  std::vector<Crossing> covers;
  for (const Crossing& crossing : scene.crossings) {
    if (crossing.under == tube.id) covers.push_back(crossing);
  }
  std::stable_sort(covers.begin(), covers.end(), [](const Crossing& a, const Crossing& b) {
    return a.at_under_m < b.at_under_m;
  });
  for (std::size_t k = 0; k < covers.size(); ++k) {
    CandidateMotion motion;
    motion.tube = tube.id;
    motion.name = k == 0 ? "tilt" : "tilt" + std::to_string(k + 1);
    motion.speed_m_s = config.lift_speed_m_s;
    const auto reject = [&](const std::string& reason) {
      set.rejections.push_back({tube.id, motion.name, "", reason});
    };
    const Lid lid = LidAt(scene, covers[k]);
    if (lid.lever_m < kNearest_m) {
      reject("the upper tube's far contact is " + Number(std::round(lid.lever_m * 1e3)) +
             " mm away, at least " + Number(kNearest_m * 1e3) + " mm are needed");
      continue;
    }
    const double tilt_rad =
        std::min(Radians(kMostTilt_deg), std::asin(std::min(1.0, kRaise_m / lid.lever_m)));
    const Vector3 axis = lid.out.cross(Vector3::UnitZ());  // Raises what lies towards `out`.
    motion.pivot_N = lid.far;
    const auto add = [&](const Vector3& shift, double angle_rad) {
      motion.waypoints_N.push_back(shift);
      motion.rotations_N.emplace_back(Eigen::AngleAxisd(angle_rad, axis));
    };
    add(Vector3::Zero(), 0.0);
    // Its lowest point stays at or over where the tube's lowest point was.
    const auto kept_up = [&](double angle_rad) {
      const RigidTransform turn =
          Translation(lid.far) *
          MakeTransform(Eigen::AngleAxisd(angle_rad, axis).matrix(), Vector3::Zero()) *
          Translation(-lid.far);
      const double low = Lowest(Transformed(turn, tube.centerline_N));
      return Vector3(0, 0, std::max(0.0, Lowest(tube.centerline_N) - low));
    };
    const int turns = static_cast<int>(std::ceil(Degrees(tilt_rad) / kTurnStep_deg - 1e-9));
    for (int i = 1; i <= turns; ++i) add(kept_up(tilt_rad * i / turns), tilt_rad * i / turns);

    PerceivedTube tilted = tube;
    tilted.centerline_N = Transformed(PoseAt(motion, turns), tube.centerline_N);
    const double wanted_m =
        lid.overhang_m + tube.radius_m + TubeOf(scene, covers[k].over).radius_m + kMargin_m;
    const double room_m = MaxSlideDistance(tilted, lid.out, bin, config.wall_safety_m);
    if (room_m < wanted_m) {
      reject("the bin's wall leaves " + Number(std::round(room_m * 1e3)) + " mm of the slide's " +
             Number(std::round(wanted_m * 1e3)) + " mm");
      continue;
    }
    const Vector3 slide = wanted_m * lid.out;
    add(motion.waypoints_N.back() + slide, tilt_rad);
    add(motion.waypoints_N.back() + Vector3(0, 0, config.lift_m), 0.0);
    motion.blocked_m = TubeObstacles(scene, tube).BlockedGrasps(slide, config.grasp_step_m);
    set.motions.push_back(std::move(motion));
  }
  return set;
}

}  // namespace tubetwin
