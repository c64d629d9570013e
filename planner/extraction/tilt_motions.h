#pragma once

#include "planner/extraction/motions.h"

namespace tubetwin {

/// For each tube that lies over this one, in the order of the crossings along this one: "tilt",
/// "tilt2", ... The occluder is a lid: it rests on this tube and farther away on its far contact,
/// the floor or another tube. This tube turns about the far contact and so raises the lid by about
/// 5 cm without sliding on it (at most 20 degrees), slides out past the lid's near end, and goes up
/// by `lift_m` while it turns back. Raised as a whole where it would go through the floor. Rejected
/// are lids whose far contact is nearer than 6 cm, and ways that the bin's walls end before the
/// near end is passed (whole tube, `wall_safety_m`). `blocked_m` are the places where the gripper
/// would run into another tube on the slide. Precondition: as MakeMotions.
MotionSet MakeTilts(const TubeScene& scene, const PerceivedTube& tube, const Bin& bin,
                    const PlannerConfig& config);

/// Where a tube rests beyond a crossing at which it lies over another: the farthest place, on
/// either side of arc length `at_m` (`side` +1 or -1), where it lies over a tube other than
/// `not_id` or on the floor; the end on that side where nothing carries it. On its axis, frame N.
Vector3 FarContact(const TubeScene& scene, const PerceivedTube& tube, double at_m, int side,
                   int not_id);

}  // namespace tubetwin
