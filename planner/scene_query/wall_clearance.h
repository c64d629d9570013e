#pragma once

#include "models/bin.h"
#include "perception/scene/tube_scene.h"

namespace tubetwin {

/// Largest slide along `direction` (unit, horizontal) at which the whole tube's bounding box stays
/// `safety_m` off the walls; a tube that is nearer already may come 2 mm nearer still.
double MaxSlideDistance(const PerceivedTube& tube, const Vector3& direction, const Bin& bin,
                        double safety_m);

}  // namespace tubetwin
