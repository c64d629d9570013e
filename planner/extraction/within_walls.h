#pragma once

#include "planner/extraction/registry.h"

namespace tubetwin {

/// Shortens the horizontal shift of every waypoint so that the whole tube keeps `wall_safety_m` off
/// the walls.
void KeepWithinWalls(const ExtractionInput& input, CandidateMotion& motion);

}  // namespace tubetwin
