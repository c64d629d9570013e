#pragma once

#include "hw_bridge/cell/cell.h"

namespace tubetwin::test {

/// A gripper under test with all that must run for it to work. The fingers are open, a tube lies
/// between them, and they have been told nothing yet.
class GripperContractRig {
 public:
  virtual ~GripperContractRig() = default;
  /// Of it, only clock and gripper are used.
  virtual Cell& cell() = 0;
  virtual double tube_diameter_m() = 0;
  /// The tube is gone for good.
  virtual void TakeTubeAway() = 0;
  // What somebody sees who stands by.
  virtual double TrueOpening_m() = 0;
  virtual double PadForce_N() = 0;    ///< Of one pad.
  virtual double DeviceTime_s() = 0;  ///< By which the fingers move.
};

// What any Gripper owes the pick cycle.

/// Moving from the command on, until the fingers stand; the newest command counts.
void CheckGripperMoves(GripperContractRig& rig);
/// Openings, speeds and forces beyond the range are the range's end.
void CheckGripperClamps(GripperContractRig& rig);
/// What it says is in counts of its register and of now.
void CheckGripperState(GripperContractRig& rig);
/// A tube that stops the fingers is told, pressed as asked, and its loss is told.
void CheckGripperHolds(GripperContractRig& rig);

}  // namespace tubetwin::test
