#include "planner/extraction/candidate_motion.h"

#include "models/base/json.h"

namespace tubetwin {

Json ToJson(const CandidateMotion& motion) {
  Json json = {{"tube", motion.tube}, {"motion", motion.name}, {"speed_m_s", motion.speed_m_s}};
  AddObjectPath(motion, json);
  if (motion.forbidden_from_m <= motion.forbidden_to_m) {
    json["forbidden_m"] = {motion.forbidden_from_m, motion.forbidden_to_m};
  }
  return json;
}

}  // namespace tubetwin
