#include "planner/extraction/registry.h"

#include <algorithm>
#include <iterator>

#include "planner/extraction/generators.h"

namespace tubetwin {

const std::vector<ExtractionMotion>& ExtractionMotions() {
  using Tier = ExtractionMotion::Tier;
  static const std::vector<ExtractionMotion> motions = {
      {"up", Tier::kFirst, MakeUp},
      {"escape", Tier::kFirst, MakeEscapes},
      {"slide", Tier::kFirst, MakeSlides},
      {"escape_away", Tier::kFirst, MakeEscapesAway},
      {"tilt", Tier::kSecond, MakeTilts},
      {"tilt_and_shed", Tier::kSecond, MakeTiltAndShed},
      {"up_slow", Tier::kLast, MakeUpSlow},
      {"shake", Tier::kLast, MakeShake},
      {"hemisphere", Tier::kLast, MakeHemisphere},
      {"helix", Tier::kLast, MakeHelices},
  };
  return motions;
}

std::vector<ExtractionMotion> ExtractionMotionsOf(const ExtractionConfig& config) {
  std::vector<ExtractionMotion> chosen;
  std::copy_if(ExtractionMotions().begin(), ExtractionMotions().end(), std::back_inserter(chosen),
               [&](const ExtractionMotion& motion) {
                 return config.motions.empty() ||
                        std::count(config.motions.begin(), config.motions.end(), motion.kind) > 0;
               });
  return chosen;
}

MotionSet MakeMotions(const std::vector<ExtractionMotion>& kinds, ExtractionMotion::Tier tier,
                      const ExtractionInput& input) {
  MotionSet all;
  for (const ExtractionMotion& kind : kinds) {
    if (kind.tier != tier) continue;
    MotionSet set = kind.make(input);
    std::move(set.motions.begin(), set.motions.end(), std::back_inserter(all.motions));
    std::move(set.rejections.begin(), set.rejections.end(), std::back_inserter(all.rejections));
  }
  return all;
}

CandidateMotion BeginMotion(const ExtractionInput& input, const std::string& kind,
                            const std::string& name) {
  CandidateMotion motion;
  motion.tube = input.tube.id;
  motion.kind = kind;
  motion.name = name;
  motion.speed_m_s = input.config.lift_speed_m_s;
  motion.waypoints_N = {Vector3::Zero()};
  return motion;
}

void GoUp(CandidateMotion& motion, double by_m) {
  motion.waypoints_N.push_back(motion.waypoints_N.back() + Vector3(0, 0, by_m));
  if (motion.turns()) motion.rotations_N.push_back(motion.rotations_N.back());
}

}  // namespace tubetwin
