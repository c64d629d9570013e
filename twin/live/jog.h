#pragma once

#include <functional>
#include <string>

#include "hw_bridge/cell/devices.h"
#include "models/arm/arm.h"

namespace tubetwin {

/// A small turn of one joint: first contact with an arm.
struct JogOptions {
  int joint = 1;                         ///< From 1, the one next to the base.
  double degrees = 1.0;                  ///< kLeastJog_deg to kMaxJog_deg either way.
  std::function<bool()> stop_requested;  ///< Stops the arm on its way; may be empty.
};
inline constexpr double kMaxJog_deg = 1.0;
/// A smaller turn is none that an arm shows.
inline constexpr double kLeastJog_deg = 0.001;

/// Turns the joint at 1 degree/s or less, whatever is around the arm: no collision is looked for.
/// Returns once the arm is at rest; the joints' angles then. Throws Error(kUsage) for a joint or an
/// angle that is not allowed, Error(kDevice) when the arm may not start, does not end where it
/// should or was stopped.
JointVector Jog(Arm& arm, const ArmModel& model, CellClock& clock, const JogOptions& options);

}  // namespace tubetwin
