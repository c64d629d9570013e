#pragma once

#include <string>
#include <vector>

#include "models/bin.h"
#include "perception/scene/tube_scene.h"
#include "planner/extraction/candidate_motion.h"
#include "planner/extraction/extraction_config.h"

namespace tubetwin {

/// What a generator of motions looks at; references outlive the call.
struct ExtractionInput {
  const TubeScene& scene;
  const PerceivedTube& tube;  ///< One of the scene's; crossings name tubes of the scene.
  const Bin& bin;
  const ExtractionConfig& config;
};

/// One kind of extraction motion.
struct ExtractionMotion {
  /// Its identity, in configuration and results.
  std::string kind;
  /// When it is asked about: kinds of a later tier only for tubes that nothing of the tiers before
  /// promises to take alone.
  enum class Tier { kFirst, kSecond, kLast } tier = Tier::kFirst;
  /// All motions of the kind for a tube, and why others cannot be. Pure; thread safe.
  MotionSet (*make)(const ExtractionInput& input) = nullptr;
};

/// Every kind, in the order in which they are asked about. To add one: a file with its generator
/// and a line here (planner/extraction/README.md).
const std::vector<ExtractionMotion>& ExtractionMotions();

/// Those that a configuration names.
std::vector<ExtractionMotion> ExtractionMotionsOf(const ExtractionConfig& config);

/// What the generators of one tier make for a tube, in order.
MotionSet MakeMotions(const std::vector<ExtractionMotion>& kinds, ExtractionMotion::Tier tier,
                      const ExtractionInput& input);

/// A motion of a kind for a tube that stands at its first waypoint.
CandidateMotion BeginMotion(const ExtractionInput& input, const std::string& kind,
                            const std::string& name);
/// Straight up by `config.lift_m`: "up", the one motion of free tubes.
CandidateMotion StraightUp(const ExtractionInput& input);
/// Adds a waypoint straight over the last one, turned as that is.
void GoUp(CandidateMotion& motion, double by_m);

}  // namespace tubetwin
