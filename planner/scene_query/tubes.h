#pragma once

#include <vector>

#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// The tube of that id. Throws LogicError when the scene has none.
const PerceivedTube& TubeOf(const TubeScene& scene, int id);

/// Crossings at which a tube lies under another, in the order of arc length along it.
std::vector<Crossing> CoversOf(const TubeScene& scene, int id);

/// Direction of the tube's end-to-end chord on the floor plane, in the sense of growing arc length;
/// x where the chord stands upright or is shorter than 1 mm. Unit vector, frame N.
Vector3 ChordDirection(const PerceivedTube& tube);

/// On the floor plane.
inline Vector3 Flat(const Vector3& p) { return {p.x(), p.y(), 0.0}; }

}  // namespace tubetwin
