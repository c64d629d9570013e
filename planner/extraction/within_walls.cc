#include "planner/extraction/within_walls.h"

#include <algorithm>

#include "planner/scene_query/tubes.h"
#include "planner/scene_query/wall_clearance.h"

namespace tubetwin {

void KeepWithinWalls(const ExtractionInput& input, CandidateMotion& motion) {
  for (Vector3& p : motion.waypoints_N) {
    const Vector3 flat = Flat(p);
    if (flat.norm() < 1e-9) continue;
    const double max_m =
        MaxSlideDistance(input.tube, flat.normalized(), input.bin, input.config.wall_safety_m);
    const Vector3 kept = flat * std::min(1.0, max_m / flat.norm());
    p = {kept.x(), kept.y(), p.z()};
  }
}

}  // namespace tubetwin
