#pragma once

#include "hw_bridge/codecs/simple_message.h"
#include "models/arm/arm.h"

namespace tubetwin {

/// Denavit and Hartenberg's numbers of an arm as group 0: theta (at the joints' zero), d, a, alpha
/// of link after link, metres and radians. From a frame on joint 1's axis, at its point nearest to
/// the flange in the zero pose, x as near to the base's as can be, to the flange's origin; each
/// joint adds its angle to theta. The other groups' numbers are 0.
simple_message::DhParameters DhParametersOf(const ArmModel& arm);

}  // namespace tubetwin
