#pragma once

#include <vector>

#include "planner/extraction/registry.h"

namespace tubetwin {

// The generators of registry.cc, one a file.

/// Straight up by `config.lift_m`. "up".
MotionSet MakeUp(const ExtractionInput& input);

/// For each crossing under another tube in the order of arc length, the paper's two escapes (Leão
/// et al. 2020, section 3.3.1): a small lift, a slide along the hidden stretch's direction on the
/// floor plane in either sense by d_var + d_const, a lift. "escape+" slides towards growing arc
/// length, so what lies before the crossing passes under the other tube and may not be grasped;
/// later crossings are "escape+2", "escape-2" and so on, left out where an earlier slide ends
/// within 5 mm (its forbidden section then grows). The slide is shortened so that the whole tube's
/// bounding box stays clear of the walls; less than a radius is rejected. With
/// `config.escape_along_joints` the OccludedJoints stand for the crossings, as printed.
MotionSet MakeEscapes(const ExtractionInput& input);

/// "slide+", "slide-": along the tube's own end-to-end chord, in the sense of growing arc length
/// and against it, as a drawer is pulled: on the floor plane without being lifted, so that what
/// lies on it is not carried, until no other tube covers it, plus a radius, then up. Where the
/// walls end the way before that (whole tube, `wall_safety_m`) it is a rejection. `blocked_m` are
/// the places where the gripper would run into another tube on the way.
MotionSet MakeSlides(const ExtractionInput& input);

/// Slides likewise in directions that are computed from all tubes together: "escape_away",
/// "escape_away2": of 24 horizontal directions the two best (at least 60 degrees apart) by way and
/// by tubes that are newly touched; "escape_corner" where both would push others and two legs, 6 or
/// 12 cm and then as far as needed, cost less.
MotionSet MakeEscapesAway(const ExtractionInput& input);

/// For each tube that lies over this one, in the order of the crossings along this one: "tilt",
/// "tilt2", ... The occluder is a lid: it rests on this tube and farther away on its far contact,
/// the floor or another tube. This tube turns about the far contact and so raises the lid by about
/// 5 cm without sliding on it (at most 20 degrees), slides out past the lid's near end, and goes up
/// by `lift_m` while it turns back. Raised as a whole where it would go through the floor. Rejected
/// are lids whose far contact is nearer than 6 cm, and ways that the bin's walls end before the
/// near end is passed (whole tube, `wall_safety_m`). `blocked_m` as MakeSlides.
MotionSet MakeTilts(const ExtractionInput& input);

/// "roll" and "pitch", for tubes that others hang on however they are pulled: up, over the bin's
/// middle, turned by 75 degrees about the tube's end-to-end chord (roll) or about the horizontal
/// across it (pitch) to one side and the other, until what lies over the tube or hooks into it has
/// slid off into the bin; level again and up to `lift_m`. As high, even beyond `lift_m`, as the
/// half that hangs down needs to stay over the walls. As the arm does not reach every such turn,
/// each comes three times under its name, the tube turned about the vertical by 0, 60 and -60
/// degrees on the way to the middle: one of them is enough.
MotionSet MakeTiltAndShed(const ExtractionInput& input);

// For tubes that nothing better takes alone. All end `lift_m` over where they are then; horizontal
// ways are shortened at the walls, with the whole tube.

/// "up_slow": up at 0.1 m/s.
MotionSet MakeUpSlow(const ExtractionInput& input);
/// "shake": up 10 cm, three strokes of 8 cm across the tube, up.
MotionSet MakeShake(const ExtractionInput& input);
/// "hemisphere1" to "hemisphere16": targets on a hemisphere of 15 cm, eight azimuths at 30 and at
/// 60 degrees from the vertical; the seventeenth, its top, is "up" (after Moosmann et al. 2021).
MotionSet MakeHemisphere(const ExtractionInput& input);
/// "helix_half+-", "helix_full+-": half a turn and a whole one on a circle of 5 cm radius while
/// rising 25 cm, in both senses (after Zhang et al. 2022).
MotionSet MakeHelices(const ExtractionInput& input);

// What some of them are made of, for tests.

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

/// Where a tube rests beyond a crossing at which it lies over another: the farthest place, on
/// either side of arc length `at_m` (`side` +1 or -1), where it lies over a tube other than
/// `not_id` or on the floor; the end on that side where nothing carries it. On its axis, frame N.
Vector3 FarContact(const TubeScene& scene, const PerceivedTube& tube, double at_m, int side,
                   int not_id);

}  // namespace tubetwin
