#pragma once

#include "hw_bridge/cell/cell.h"

namespace tubetwin::test {

/// A force/torque sensor under test with all that must run for it to work: the tool hangs straight
/// down, nothing moves, the sensor has no noise.
class WristContractRig {
 public:
  virtual ~WristContractRig() = default;
  /// Of it, only clock and wrist are used.
  virtual Cell& cell() = 0;
  virtual double tool_weight_N() = 0;
  /// From here on this force, in axes of K, pulls on the tool besides its weight. Returns the load
  /// on the sensor that it is.
  virtual Wrench Pull(const Vector3& force_K) = 0;
};

// What any ForceTorqueSensor owes the pick cycle.

/// Newest samples: their times go on, lie in the past, and are young.
void CheckWristTimes(WristContractRig& rig);
/// Load on the sensor in axes of K, not tared, in the data sheet's counts.
void CheckWristReads(WristContractRig& rig);
/// Beyond the range: the range's end, and a flag as long as that lasts.
void CheckWristSaturates(WristContractRig& rig);

}  // namespace tubetwin::test
