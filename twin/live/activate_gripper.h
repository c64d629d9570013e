#pragma once

#include <functional>
#include <string>

#include "hw_bridge/cell/devices.h"
#include "twin/round/scenario.h"

namespace tubetwin {

/// What the gripper said before and after.
struct ActivatedGripper {
  GripperState before, after;
};

/// Activates the gripper of the scenario's cell: its fingers open and close once. One that is
/// activated is left alone. `ask` gets the address before anything moves and throws where nobody
/// says yes; `confirm` is asked where fingers that are neither closed nor open may hold something.
/// Throws Error(kConfig) unless the gripper is a device, Error(kDevice) when fingers or wrist hold
/// something, `confirm` says no or a device does not answer, Error(kInterrupted) as DeviceLock.
ActivatedGripper ActivateGripper(const Scenario& scenario,
                                 const std::function<void(const std::string& address)>& ask,
                                 const std::function<bool(const std::string& what)>& confirm);

}  // namespace tubetwin
