#include "planner/extraction/motions.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/text.h"
#include "planner/scene_query/wall_clearance.h"

namespace tubetwin {
namespace {

constexpr double kStretchStep_m = 0.002;
constexpr double kSameSlide_m = 0.005;
constexpr double kStretchMax_m = 0.15;  // Tubes that lie along each other do not hide for ever.

Polyline Flat(Polyline line) {
  for (Vector3& p : line) p.z() = 0.0;
  return line;
}

Vector3 Flat(const Vector3& p) { return {p.x(), p.y(), 0.0}; }

const PerceivedTube& TubeOf(const TubeScene& scene, int id) {
  for (const PerceivedTube& tube : scene.tubes) {
    if (tube.id == id) return tube;
  }
  TT_CHECK(!"a crossing names a tube of the scene");
  return scene.tubes.front();
}

std::string EscapeName(int sign, int index) {
  std::string name = sign > 0 ? "escape+" : "escape-";
  if (index > 0) name += std::to_string(index + 1);
  return name;
}

void AddEscape(const PerceivedTube& tube, const HiddenStretch& hidden, int sign, int index,
               const Bin& bin, const PlannerConfig& config, MotionSet& set) {
  const Polyline& line = tube.centerline_N;
  CandidateMotion motion;
  motion.tube = tube.id;
  motion.name = EscapeName(sign, index);
  motion.speed_m_s = config.lift_speed_m_s;

  const Vector3 from = PointAt(line, hidden.from_m), to = PointAt(line, hidden.to_m);
  Vector3 direction = sign * Flat(to - from);
  if (direction.norm() < 1e-4) {
    set.rejections.push_back(
        {tube.id, motion.name, "",
         "the hidden stretch stands upright: it has no direction to slide in"});
    return;
  }
  direction.normalize();

  // Sliding forward pulls what lies behind the crossing through under the other tube.
  const double length = Length(line);
  const Vector3 occluded_end = sign > 0 ? from : to;
  const std::vector<double> arc = ArcLengths(line);
  double variable_m = 0.0;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (sign > 0 ? arc[k] > hidden.from_m : arc[k] < hidden.to_m) continue;
    variable_m = std::max(variable_m, std::abs(direction.dot(line[k] - occluded_end)));
  }
  const double wanted_m = variable_m + std::max(config.escape_const_m, 3.0 * tube.radius_m);
  const double slide_m =
      std::min(wanted_m, MaxSlideDistance(tube, direction, bin, config.wall_safety_m));
  if (slide_m < tube.radius_m) {
    set.rejections.push_back({tube.id, motion.name, "",
                              "the bin's wall leaves " + Number(std::round(slide_m * 1e3)) +
                                  " mm of the slide's " + Number(std::round(wanted_m * 1e3)) +
                                  " mm"});
    return;
  }

  motion.forbidden_from_m = sign > 0 ? 0.0 : hidden.from_m;
  motion.forbidden_to_m = sign > 0 ? hidden.to_m : length;
  const Vector3 lifted(0, 0, config.escape_first_lift_m);
  const Vector3 slid = lifted + slide_m * direction;
  motion.waypoints_N = {Vector3::Zero(), lifted, slid, slid + Vector3(0, 0, config.lift_m)};
  // Crossings of a straight stretch, or a near wall, give the same slide again: one is enough, with
  // both sections forbidden.
  for (CandidateMotion& known : set.motions) {
    if (known.waypoints_N.size() < 3 || (known.waypoints_N[2] - slid).norm() > kSameSlide_m)
      continue;
    known.forbidden_from_m = std::min(known.forbidden_from_m, motion.forbidden_from_m);
    known.forbidden_to_m = std::max(known.forbidden_to_m, motion.forbidden_to_m);
    return;
  }
  set.motions.push_back(std::move(motion));
}

}  // namespace

CandidateMotion UpMotion(const PerceivedTube& tube, const PlannerConfig& config) {
  CandidateMotion motion;
  motion.tube = tube.id;
  motion.name = "up";
  motion.waypoints_N = {Vector3::Zero(), Vector3(0, 0, config.lift_m)};
  motion.speed_m_s = config.lift_speed_m_s;
  return motion;
}

HiddenStretch FindHiddenStretch(const PerceivedTube& over, const PerceivedTube& under,
                                const Crossing& crossing) {
  const double length = Length(under.centerline_N);
  const std::vector<double> arc = ArcLengths(under.centerline_N);
  const Polyline cover = Flat(SubLine(over.centerline_N, crossing.at_over_m - kStretchMax_m,
                                      crossing.at_over_m + kStretchMax_m));
  const auto hidden_at = [&](double s) {
    const Vector3 p = Flat(PointAt(under.centerline_N, s));
    if (Closest(cover, p).distance_m < over.radius_m) return true;
    if (under.node_visible.size() != arc.size()) return false;
    const auto next = std::lower_bound(arc.begin(), arc.end(), s);
    const std::size_t k = std::min<std::size_t>(next - arc.begin(), arc.size() - 1);
    return under.node_visible[k] == 0 && under.node_visible[k > 0 ? k - 1 : 0] == 0;
  };
  const auto walk = [&](double step) {
    double s = crossing.at_under_m;
    while (s + step >= 0.0 && s + step <= length &&
           std::abs(s + step - crossing.at_under_m) <= kStretchMax_m && hidden_at(s + step)) {
      s += step;
    }
    return s;
  };
  // One step at least, so that the stretch has a direction.
  return {std::max(0.0, std::min(walk(-kStretchStep_m), crossing.at_under_m - over.radius_m)),
          std::min(length, std::max(walk(kStretchStep_m), crossing.at_under_m + over.radius_m))};
}

std::vector<HiddenStretch> OccludedJoints(const PerceivedTube& tube) {
  std::vector<HiddenStretch> out;
  const std::vector<double> arc = ArcLengths(tube.centerline_N);
  const std::vector<char>& visible = tube.node_visible;
  for (std::size_t k = 1; k < visible.size() && k < arc.size(); ++k) {
    if (visible[k - 1] == 0 || visible[k] != 0) continue;
    std::size_t next = k;
    while (next < visible.size() && visible[next] == 0) ++next;
    if (next < arc.size()) out.push_back({arc[k - 1], arc[next]});
  }
  return out;
}

MotionSet MakeMotions(const TubeScene& scene, const PerceivedTube& tube, const Bin& bin,
                      const PlannerConfig& config) {
  MotionSet set;
  set.motions.push_back(UpMotion(tube, config));
  if (config.classes == "occluded_joints") {
    int index = 0;
    for (const HiddenStretch& joint : OccludedJoints(tube)) {
      for (const int sign : {+1, -1}) AddEscape(tube, joint, sign, index, bin, config, set);
      ++index;
    }
    return set;
  }
  std::vector<Crossing> covers;
  for (const Crossing& crossing : scene.crossings) {
    if (crossing.under == tube.id) covers.push_back(crossing);
  }
  std::stable_sort(covers.begin(), covers.end(), [](const Crossing& a, const Crossing& b) {
    return a.at_under_m < b.at_under_m;
  });
  for (std::size_t i = 0; i < covers.size(); ++i) {
    const HiddenStretch hidden = FindHiddenStretch(TubeOf(scene, covers[i].over), tube, covers[i]);
    for (const int sign : {+1, -1}) {
      AddEscape(tube, hidden, sign, static_cast<int>(i), bin, config, set);
    }
  }
  return set;
}

}  // namespace tubetwin
