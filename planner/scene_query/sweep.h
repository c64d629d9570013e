#pragma once

#include <optional>

#include "models/gripper_spec.h"
#include "perception/scene/tube_scene.h"
#include "planner/scene_query/object_path.h"

namespace tubetwin {

/// The first tube, in the scene's order, that a motion would touch: whether its surface comes
/// within `margin_m` of the moving one's, or nearer still when they are that near at the start. A
/// tube that only supports a lifted one is left without being touched; one that lies against a tube
/// that begins with a slide is dragged, and one that overlaps by more than 3 mm is pushed. The
/// moving tube is rigid here; legs are looked at every 5 mm. Nothing: the motion disturbs no
/// perceived tube. Precondition: the motion's tube is in the scene.
std::optional<int> FirstTouched(const TubeScene& scene, const TubePath& motion,
                                double margin_m = 0.003);

/// How many tubes it touches.
int CountTouched(const TubeScene& scene, const TubePath& motion, double margin_m = 0.003);

/// The same for the closed fingers that hold the tube at p_N, as an upright cylinder around them. A
/// motion that only rises takes them out as they came in: nothing.
std::optional<int> FirstTouchedByFingers(const TubeScene& scene, const TubePath& motion,
                                         const Vector3& p_N, const GripperSpec& gripper,
                                         double margin_m = 0.003);

}  // namespace tubetwin
