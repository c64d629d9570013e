#include <algorithm>
#include <cmath>

#include "models/base/text.h"
#include "planner/extraction/generators.h"
#include "planner/scene_query/tubes.h"
#include "planner/scene_query/wall_clearance.h"

namespace tubetwin {
namespace {

constexpr double kStretchStep_m = 0.002;
constexpr double kSameSlide_m = 0.005;
constexpr double kStretchMax_m = 0.15;  // Tubes that lie along each other do not hide for ever.

Polyline Flattened(Polyline line) {
  for (Vector3& p : line) p.z() = 0.0;
  return line;
}

std::string EscapeName(int sign, int index) {
  std::string name = sign > 0 ? "escape+" : "escape-";
  if (index > 0) name += std::to_string(index + 1);
  return name;
}

/// How far the slide has to go: what lies behind the crossing is pulled through under the other
/// tube.
double WantedSlide(const ExtractionInput& input, const HiddenStretch& hidden, int sign,
                   const Vector3& direction) {
  const Polyline& line = input.tube.centerline_N;
  const Vector3 occluded_end = PointAt(line, sign > 0 ? hidden.from_m : hidden.to_m);
  const std::vector<double> arc = ArcLengths(line);
  double variable_m = 0.0;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (sign > 0 ? arc[k] > hidden.from_m : arc[k] < hidden.to_m) continue;
    variable_m = std::max(variable_m, std::abs(direction.dot(line[k] - occluded_end)));
  }
  return variable_m + std::max(input.config.escape_const_m, 3.0 * input.tube.radius_m);
}

void AddEscape(const ExtractionInput& input, const HiddenStretch& hidden, int sign, int index,
               MotionSet& set) {
  const PerceivedTube& tube = input.tube;
  const ExtractionConfig& config = input.config;
  const Polyline& line = tube.centerline_N;
  CandidateMotion motion = BeginMotion(input, "escape", EscapeName(sign, index));
  const auto reject = [&](const std::string& reason) {
    set.rejections.push_back({tube.id, motion.name, "", reason});
  };
  Vector3 direction = sign * Flat(PointAt(line, hidden.to_m) - PointAt(line, hidden.from_m));
  if (direction.norm() < 1e-4) {
    return reject("the hidden stretch stands upright: it has no direction to slide in");
  }
  direction.normalize();
  const double wanted_m = WantedSlide(input, hidden, sign, direction);
  const double slide_m =
      std::min(wanted_m, MaxSlideDistance(tube, direction, input.bin, config.wall_safety_m));
  if (slide_m < tube.radius_m) {
    return reject("the bin's wall leaves " + Number(std::round(slide_m * 1e3)) +
                  " mm of the slide's " + Number(std::round(wanted_m * 1e3)) + " mm");
  }

  motion.forbidden_from_m = sign > 0 ? 0.0 : hidden.from_m;
  motion.forbidden_to_m = sign > 0 ? hidden.to_m : Length(line);
  const Vector3 lifted(0, 0, config.escape_first_lift_m);
  const Vector3 slid = lifted + slide_m * direction;
  motion.waypoints_N = {Vector3::Zero(), lifted, slid, slid + Vector3(0, 0, config.lift_m)};
  // Crossings of a straight stretch, or a near wall, give the same slide again: one is enough, with
  // both sections forbidden.
  for (CandidateMotion& known : set.motions) {
    if ((known.waypoints_N[2] - slid).norm() > kSameSlide_m) continue;
    known.forbidden_from_m = std::min(known.forbidden_from_m, motion.forbidden_from_m);
    known.forbidden_to_m = std::max(known.forbidden_to_m, motion.forbidden_to_m);
    return;
  }
  set.motions.push_back(std::move(motion));
}

}  // namespace

HiddenStretch FindHiddenStretch(const PerceivedTube& over, const PerceivedTube& under,
                                const Crossing& crossing) {
  const double length = Length(under.centerline_N);
  const std::vector<double> arc = ArcLengths(under.centerline_N);
  const Polyline cover = Flattened(SubLine(over.centerline_N, crossing.at_over_m - kStretchMax_m,
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

MotionSet MakeEscapes(const ExtractionInput& input) {
  std::vector<HiddenStretch> stretches;
  if (input.config.escape_along_joints) {
    stretches = OccludedJoints(input.tube);
  } else {
    for (const Crossing& cover : CoversOf(input.scene, input.tube.id)) {
      stretches.push_back(FindHiddenStretch(TubeOf(input.scene, cover.over), input.tube, cover));
    }
  }
  MotionSet set;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    for (const int sign : {+1, -1}) {
      AddEscape(input, stretches[i], sign, static_cast<int>(i), set);
    }
  }
  return set;
}

}  // namespace tubetwin
