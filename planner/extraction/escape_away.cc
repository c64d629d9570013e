#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "planner/extraction/clearing_slide.h"
#include "planner/extraction/generators.h"
#include "planner/scene_query/wall_clearance.h"

namespace tubetwin {
namespace {

constexpr int kDirections = 24;
constexpr int kLegDirections = 12;  // Of either of two legs.
constexpr std::array<double, 2> kFirstLegs_m = {0.06, 0.12};
constexpr double kApart_deg = 60.0;     // Of the two best directions.
constexpr double kSameLine_deg = 25.0;  // A second leg nearer to the first's line is none.
constexpr const char* kKind = "escape_away";

Vector3 Direction(int k, int of) {
  const double angle = 2.0 * kPi * k / of;
  return {std::cos(angle), std::sin(angle), 0.0};
}

/// The cheapest clear slide on from a corner along one of the second legs' directions that is
/// cheaper than `max_cost_m`, or none.
std::optional<ClearingSlide> SecondLeg(const ExtractionInput& input, const TubeObstacles& around,
                                       const Vector3& corner, const Vector3& first,
                                       double max_cost_m) {
  PerceivedTube there = input.tube;
  there.centerline_N = Transformed(Translation(corner), input.tube.centerline_N);
  std::optional<ClearingSlide> best;
  for (int b = 0; b < kLegDirections; ++b) {
    const Vector3 second = Direction(b, kLegDirections);
    // Straight on was tried, and back is no slide.
    if (std::abs(second.dot(first)) > std::cos(Radians(kSameLine_deg))) continue;
    const ClearingSlide slide = FindClearingSlide(input, around, there, second, corner);
    if (!slide.clear || slide.cost_m >= max_cost_m) continue;
    max_cost_m = slide.cost_m;
    best = slide;
  }
  return best;
}

/// The cheapest slide of two legs that is cheaper than `best_cost_m`, or none.
std::optional<CandidateMotion> FindTwoLegs(const ExtractionInput& input,
                                           const TubeObstacles& around, double best_cost_m) {
  std::optional<CandidateMotion> best;
  for (int a = 0; a < kLegDirections; ++a) {
    const Vector3 first = Direction(a, kLegDirections);
    const double max_m = MaxSlideDistance(input.tube, first, input.bin, input.config.wall_safety_m);
    for (const double leg_m : kFirstLegs_m) {
      if (leg_m > max_m) break;
      const Vector3 corner = leg_m * first;
      const double corner_cost_m = leg_m + kTouchCost_m * around.NewlyTouched(corner);
      if (corner_cost_m >= best_cost_m) continue;
      const auto slide = SecondLeg(input, around, corner, first, best_cost_m - corner_cost_m);
      if (!slide) continue;
      best_cost_m = corner_cost_m + slide->cost_m;
      best = BeginMotion(input, kKind, "escape_corner");
      best->waypoints_N.push_back(corner);
      best->waypoints_N.push_back(corner + slide->length_m * slide->direction_N);
      GoUp(*best, input.config.lift_m);
    }
  }
  if (!best) return best;
  for (const int leg : {1, 2}) {
    const Vector3 from = best->waypoints_N[leg - 1], by = best->waypoints_N[leg] - from;
    const auto blocked = around.BlockedGrasps(by, input.config.grasp_step_m, from);
    best->blocked_m.insert(best->blocked_m.end(), blocked.begin(), blocked.end());
  }
  return best;
}

}  // namespace

MotionSet MakeEscapesAway(const ExtractionInput& input) {
  MotionSet set;
  const TubeObstacles around(input.scene, input.tube);
  if (!around.Covered(Vector3::Zero())) return set;
  std::vector<ClearingSlide> slides;
  for (int k = 0; k < kDirections; ++k) {
    const ClearingSlide slide =
        FindClearingSlide(input, around, input.tube, Direction(k, kDirections));
    if (slide.clear) slides.push_back(slide);
  }
  std::stable_sort(
      slides.begin(), slides.end(),
      [](const ClearingSlide& a, const ClearingSlide& b) { return a.cost_m < b.cost_m; });
  if (slides.empty()) {
    set.rejections.push_back(
        {input.tube.id, "escape_away", "", "covered in every direction as far as the walls allow"});
    return set;
  }
  const ClearingSlide& best = slides.front();
  AddClearingSlide(input, around, best, kKind, "escape_away", set);
  for (const ClearingSlide& slide : slides) {
    if (slide.direction_N.dot(best.direction_N) > std::cos(Radians(kApart_deg)) + 1e-9) continue;
    AddClearingSlide(input, around, slide, kKind, "escape_away2", set);
    break;
  }
  if (best.cost_m > best.length_m) {
    if (auto corner = FindTwoLegs(input, around, best.cost_m)) {
      set.motions.push_back(*std::move(corner));
    }
  }
  return set;
}

}  // namespace tubetwin
