#pragma once

#include <string>
#include <utility>
#include <vector>

#include "planner/scene_query/object_path.h"
#include "planner/scene_query/rejection.h"

namespace tubetwin {

/// What a tube does after it was grasped.
struct CandidateMotion : TubePath {
  std::string kind;  ///< Which generator made it: "up", "escape", "tilt" ...; see registry.h.
  std::string name;  ///< "up", "escape+", "escape-2", ...: unique for its tube but for variants.
  /// Of motions of one name, which: they differ for the arm's sake only, and one is enough.
  int variant = 0;
  double speed_m_s = 0.25;
  double turn_speed_rad_s = 0.5;
  /// Escape: arc length range of the tube that passes under the occluder; no grasp there.
  double forbidden_from_m = 1.0, forbidden_to_m = 0.0;  ///< Empty when from > to.
  /// More such ranges: the gripper would run into another tube there.
  std::vector<std::pair<double, double>> blocked_m;
};
Json ToJson(const CandidateMotion& motion);

/// What a tube could do after it was grasped.
struct MotionSet {
  std::vector<CandidateMotion> motions;
  std::vector<Rejection> rejections;  ///< Motions that the bin's walls forbid, with the reason.
};

}  // namespace tubetwin
