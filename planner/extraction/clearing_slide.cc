#include "planner/extraction/clearing_slide.h"

#include <algorithm>
#include <cmath>

#include "models/base/text.h"
#include "planner/scene_query/wall_clearance.h"

namespace tubetwin {
namespace {

constexpr double kStep_m = 0.020;  // Between places that are tried.

}  // namespace

ClearingSlide FindClearingSlide(const ExtractionInput& input, const TubeObstacles& around,
                                const PerceivedTube& tube, const Vector3& direction_N,
                                const Vector3& from_N) {
  ClearingSlide out;
  out.direction_N = direction_N;
  const double max_m = MaxSlideDistance(tube, direction_N, input.bin, input.config.wall_safety_m);
  for (double length_m = kStep_m; length_m <= max_m; length_m += kStep_m) {
    out.length_m = length_m;
    if (around.Covered(from_N + length_m * direction_N)) continue;
    out.clear = true;
    out.length_m = std::min(max_m, length_m + tube.radius_m);
    break;
  }
  if (!out.clear) return out;
  int touched = 0;
  for (double length_m = kStep_m; length_m <= out.length_m; length_m += 2.0 * kStep_m) {
    touched = std::max(touched, around.NewlyTouched(from_N + length_m * direction_N));
  }
  out.cost_m = out.length_m + kTouchCost_m * touched;
  return out;
}

void AddClearingSlide(const ExtractionInput& input, const TubeObstacles& around,
                      const ClearingSlide& slide, const std::string& kind, const std::string& name,
                      MotionSet& set) {
  if (!slide.clear) {
    set.rejections.push_back({input.tube.id, name, "",
                              "still covered where the bin's wall ends the slide, after " +
                                  Number(std::round(slide.length_m * 1e3)) + " mm"});
    return;
  }
  CandidateMotion motion = BeginMotion(input, kind, name);
  const Vector3 shift = slide.length_m * slide.direction_N;
  motion.waypoints_N.push_back(shift);
  GoUp(motion, input.config.lift_m);
  motion.blocked_m = around.BlockedGrasps(shift, input.config.grasp_step_m);
  set.motions.push_back(std::move(motion));
}

}  // namespace tubetwin
