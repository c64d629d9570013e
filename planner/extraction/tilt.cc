#include <algorithm>
#include <cmath>
#include <optional>

#include "models/base/text.h"
#include "planner/extraction/generators.h"
#include "planner/scene_query/tube_obstacles.h"
#include "planner/scene_query/tubes.h"
#include "planner/scene_query/wall_clearance.h"

namespace tubetwin {
namespace {

constexpr double kRaise_m = 0.05;  // Of the lid over the tube that slides out.
constexpr double kMaxTilt_deg = 20.0;
constexpr double kTurnStep_deg =
    10.0;                             // Between waypoints: the hand's straight ways are arcs then.
constexpr double kMinLever_m = 0.06;  // Of the far contact.
constexpr double kOnFloor_m = 0.004;  // A tube whose surface is lower lies on the floor.
constexpr double kMargin_m = 0.010;
constexpr double kStep_m = 0.005;

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

/// Builds the motion under one lid.
class LidTilt {
 public:
  LidTilt(const ExtractionInput& input, const Lid& lid, CandidateMotion& motion)
      : tube_(input.tube), lid_(lid), motion_(motion), axis_(lid.out.cross(Vector3::UnitZ())) {
    motion_.pivot_N = lid.far;
    motion_.waypoints_N.clear();
    Add(Vector3::Zero(), 0.0);
  }

  /// Turns in steps, so that the hand's straight ways are arcs, its lowest point kept at or over
  /// where the tube's lowest point was.
  void TurnBy(double angle_rad) {
    const int turns = static_cast<int>(std::ceil(Degrees(angle_rad) / kTurnStep_deg - 1e-9));
    for (int i = 1; i <= turns; ++i) Add(KeptUp(angle_rad * i / turns), angle_rad * i / turns);
  }

  /// Goes on from the last waypoint, turned by that angle then.
  void Go(const Vector3& by, double angle_rad) { Add(motion_.waypoints_N.back() + by, angle_rad); }

 private:
  void Add(const Vector3& shift, double angle_rad) {
    motion_.waypoints_N.push_back(shift);
    motion_.rotations_N.emplace_back(Eigen::AngleAxisd(angle_rad, axis_));
  }

  Vector3 KeptUp(double angle_rad) const {
    const RigidTransform turn =
        Translation(lid_.far) *
        MakeTransform(Eigen::AngleAxisd(angle_rad, axis_).matrix(), Vector3::Zero()) *
        Translation(-lid_.far);
    const double low = Lowest(Transformed(turn, tube_.centerline_N));
    return Vector3(0, 0, std::max(0.0, Lowest(tube_.centerline_N) - low));
  }

  const PerceivedTube& tube_;
  const Lid& lid_;
  CandidateMotion& motion_;
  const Vector3 axis_;  ///< Raises what lies towards `out`.
};

/// The motion under one lid into `motion`; why there is none, or nothing.
std::optional<std::string> TiltUnder(const ExtractionInput& input, const Crossing& cover,
                                     CandidateMotion& motion) {
  const Lid lid = LidAt(input.scene, cover);
  if (lid.lever_m < kMinLever_m) {
    return "the upper tube's far contact is " + Number(std::round(lid.lever_m * 1e3)) +
           " mm away, at least " + Number(kMinLever_m * 1e3) + " mm are needed";
  }
  const double tilt_rad =
      std::min(Radians(kMaxTilt_deg), std::asin(std::min(1.0, kRaise_m / lid.lever_m)));
  LidTilt tilt(input, lid, motion);
  tilt.TurnBy(tilt_rad);

  PerceivedTube tilted = input.tube;
  tilted.centerline_N =
      Transformed(PoseAt(motion, motion.waypoints_N.size() - 1), input.tube.centerline_N);
  const double wanted_m =
      lid.overhang_m + input.tube.radius_m + TubeOf(input.scene, cover.over).radius_m + kMargin_m;
  const double max_m = MaxSlideDistance(tilted, lid.out, input.bin, input.config.wall_safety_m);
  if (max_m < wanted_m) {
    return "the bin's wall leaves " + Number(std::round(max_m * 1e3)) + " mm of the slide's " +
           Number(std::round(wanted_m * 1e3)) + " mm";
  }
  const Vector3 slide = wanted_m * lid.out;
  tilt.Go(slide, tilt_rad);
  tilt.Go(Vector3(0, 0, input.config.lift_m), 0.0);
  motion.blocked_m =
      TubeObstacles(input.scene, input.tube).BlockedGrasps(slide, input.config.grasp_step_m);
  return std::nullopt;
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

MotionSet MakeTilts(const ExtractionInput& input) {
  MotionSet set;
  int count = 0;
  for (const Crossing& cover : CoversOf(input.scene, input.tube.id)) {
    const std::string name = ++count == 1 ? "tilt" : "tilt" + std::to_string(count);
    CandidateMotion motion = BeginMotion(input, "tilt", name);
    if (auto against = TiltUnder(input, cover, motion)) {
      set.rejections.push_back({input.tube.id, name, "", *against});
    } else {
      set.motions.push_back(std::move(motion));
    }
  }
  return set;
}

}  // namespace tubetwin
