#pragma once

#include <string>

#include "planner/extraction/registry.h"
#include "planner/scene_query/tube_obstacles.h"

namespace tubetwin {

/// A horizontal slide that takes a tube out from under all others.
struct ClearingSlide {
  Vector3 direction_N = Vector3::UnitX();
  double length_m = 0.0;  ///< Until nothing covers the tube, plus a radius; or the wall's room.
  double cost_m = 0.0;    ///< Its length, and for each tube that it newly touches ten centimetres.
  bool clear = false;     ///< Nothing covers the tube at its end.
};

/// A newly touched tube costs as much as so long a slide.
inline constexpr double kTouchCost_m = 0.10;

/// Looks along a direction for where nothing covers `tube` any more, a tube of `around` that was
/// shifted by `from_N` already.
ClearingSlide FindClearingSlide(const ExtractionInput& input, const TubeObstacles& around,
                                const PerceivedTube& tube, const Vector3& direction_N,
                                const Vector3& from_N = Vector3::Zero());

/// Adds the slide and the lift after it as a motion, or a rejection where it is not clear.
void AddClearingSlide(const ExtractionInput& input, const TubeObstacles& around,
                      const ClearingSlide& slide, const std::string& kind, const std::string& name,
                      MotionSet& set);

}  // namespace tubetwin
