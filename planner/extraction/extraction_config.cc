#include "planner/extraction/extraction_config.h"

#include <algorithm>

#include "models/base/error.h"
#include "models/base/text.h"
#include "planner/extraction/registry.h"

namespace tubetwin {

void ExtractionConfig::Visit(ConfigVisitor& v) {
  v.Field("lift_m", "upward move after the grasp, and last move of an escape", lift_m, {0.05, 1.0});
  v.Field("escape_first_lift_m", "first upward move of an escape", escape_first_lift_m, {0.0, 0.3});
  v.Field("escape_const_m", "constant term of the slide, three tube radii at least", escape_const_m,
          {0.0, 0.5});
  v.Field("wall_safety_m", "distance that an escaping tube keeps from the walls", wall_safety_m,
          {0.0, 0.2});
  v.Field("lift_speed_m_s", "speed of the motions after the grasp", lift_speed_m_s, {0.01, 2.0});
  v.Field("grasp_step_m", "distance of grasp points along the tube", grasp_step_m, {0.001, 0.1});
  v.Field("motions", "kinds of extraction motions that are tried; empty: all of them", motions);
  std::vector<std::string> kinds;
  for (const ExtractionMotion& motion : ExtractionMotions()) kinds.push_back(motion.kind);
  for (const std::string& kind : motions) {
    if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) continue;
    throw Error(ErrorKind::kConfig,
                "planner.motions: there is no motion '" + kind + "'; there are " + Join(kinds));
  }
}

}  // namespace tubetwin
