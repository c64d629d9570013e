#pragma once

#include <vector>

#include "models/bin.h"
#include "perception/scene/tube_scene.h"
#include "planner/extraction/motion_types.h"
#include "planner/pick/plan.h"

namespace tubetwin {

/// Straight up by `config.lift_m`.
CandidateMotion UpMotion(const PerceivedTube& tube, const PlannerConfig& config);

/// The stretch of the lower tube that the upper one hides at a crossing, arc lengths on the lower
/// tube: where the upper tube covers it from above, and the unseen nodes next to that.
struct HiddenStretch {
  double from_m = 0.0, to_m = 0.0;
};
HiddenStretch FindHiddenStretch(const PerceivedTube& over, const PerceivedTube& under,
                                const Crossing& crossing);

/// Where unseen nodes lie between seen ones: the joints of the leao2020 profile that something lies
/// over, in the order of arc length.
std::vector<HiddenStretch> OccludedJoints(const PerceivedTube& tube);

/// What a tube could do after it was grasped.
struct MotionSet {
  std::vector<CandidateMotion> motions;
  std::vector<Rejection> rejections;  ///< Motions that the bin's walls forbid, with the reason.
};

/// "up" and, for each crossing under another tube in the order of arc length, the paper's two
/// escapes (Leão et al. 2020, section 3.3.1): a small lift, a slide along the hidden stretch's
/// direction on the floor plane in either sense by d_var + d_const, a lift. "escape+" slides
/// towards growing arc length, so what lies before the crossing passes under the other tube and may
/// not be grasped; later crossings are "escape+2", "escape-2" and so on, left out where an earlier
/// slide ends within 5 mm (its forbidden section then grows). The slide is shortened so that the
/// whole tube's bounding box stays clear of the walls; less than a radius is rejected.
/// With `config.classes` "occluded_joints" the OccludedJoints stand for the crossings, as printed.
/// Precondition: the crossings' ids are tubes of the scene.
MotionSet MakeMotions(const TubeScene& scene, const PerceivedTube& tube, const Bin& bin,
                      const PlannerConfig& config);

}  // namespace tubetwin
