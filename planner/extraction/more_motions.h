#pragma once

#include "planner/extraction/motions.h"

namespace tubetwin {

/// Ways out from under other tubes that are computed from all of them together, tried beside "up"
/// and the paper's escapes. All stay on the floor plane first: the tube slides without being
/// lifted, so that what lies on it is not carried, then goes up by `config.lift_m`.
///
/// "slide+", "slide-": along the tube's own end-to-end chord, in the sense of growing arc length
/// and against it, as a drawer is pulled. "escape_away", "escape_away2": of 24 horizontal
/// directions the two best (at least 60 degrees apart) by way and by tubes that are newly touched;
/// "escape_corner" where both would push others and two legs, 6 or 12 cm and then as far as needed,
/// cost less.
/// Each goes as far as it takes until no other tube covers the moved one, plus a radius; where the
/// walls end the way before that (whole tube, `wall_safety_m`) it is a rejection. `blocked_m` are
/// the places where the gripper would run into another tube on the way. Precondition: as
/// MakeMotions.
MotionSet MakeWaysOut(const TubeScene& scene, const PerceivedTube& tube, const Bin& bin,
                      const PlannerConfig& config);

/// Motions for tubes that nothing better takes alone: "up_slow" (0.1 m/s); "shake" (up 10 cm, three
/// strokes of 8 cm across the tube, up); "hemisphere1" to "hemisphere16" (targets on a hemisphere
/// of 15 cm: eight azimuths at 30 and at 60 degrees from the vertical; the seventeenth, its top, is
/// "up"; after Moosmann et al. 2021); "helix_half+-", "helix_full+-" (half a turn and a whole one
/// on a circle of 5 cm radius while rising 25 cm, in both senses; after Zhang et al. 2022). All end
/// `lift_m` over where they are then. Horizontal ways are shortened at the walls, with the whole
/// tube.
MotionSet MakeSeparations(const PerceivedTube& tube, const Bin& bin, const PlannerConfig& config);

/// "roll" and "pitch", for tubes that others hang on however they are pulled: up, over the bin's
/// middle, turned by 75 degrees about the tube's end-to-end chord (roll) or about the horizontal
/// across it (pitch) to one side and the other, until what lies over the tube or hooks into it has
/// slid off into the bin; level again and up to `lift_m`. As high, even beyond `lift_m`, as the
/// half that hangs down needs to stay over the walls. As the arm does not reach every such turn,
/// each comes three times under its name, the tube turned about the vertical by 0, 60 and -60
/// degrees on the way to the middle: one of them is enough.
MotionSet MakeTips(const PerceivedTube& tube, const Bin& bin, const PlannerConfig& config);

/// Whether a rotation turns the vertical by more than an angle.
bool IsTurnedOver(const Eigen::Quaterniond& rotation, double more_than_deg = 1.0);
/// Whether a tube is turned over so far, by more than 45 degrees, that others slide off it.
bool IsTip(const ObjectPath& way);

}  // namespace tubetwin
