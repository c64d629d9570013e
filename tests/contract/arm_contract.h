#pragma once

#include <functional>

#include "hw_bridge/cell/cell.h"

namespace tubetwin::test {

/// An arm under test with all that must run for it to work. It stands still, ready, with room of
/// 0.2 rad for each joint.
class ArmContractRig {
 public:
  virtual ~ArmContractRig() = default;
  /// Of it, only clock and arm are used.
  virtual Cell& cell() = 0;
  /// Something in the way of the first joint, until the drives give up; and it goes away again.
  virtual void Block(bool blocked) = 0;
};

// What any Arm owes the pick cycle beyond CheckArmContract (device_contract.h), which belongs to
// the suite. Each leaves the arm ready.

/// Starts within 0.2 degrees, no others; one motion at a time.
void CheckArmStarts(ArmContractRig& rig);
/// Many points, appended pieces: one motion, on the path, reported as it is.
void CheckArmFollows(ArmContractRig& rig);
/// A second stop may shorten the first; none begins anything.
void CheckArmStops(ArmContractRig& rig);
/// A protective stop ends the motion for good, and only a person's word makes the arm ready.
void CheckArmProtectiveStop(ArmContractRig& rig);

}  // namespace tubetwin::test
