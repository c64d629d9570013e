#pragma once

#include <string>

#include "hw_bridge/cell/cell.h"

namespace tubetwin {

// What an earlier program may have left in the fingers. A tube that nobody knows of is carried
// through the cell as if it were not there, and falls where the fingers first open.

/// What a gripper says of something between its fingers; empty: nothing.
std::string LeftInFingers(const GripperState& state);

/// What the wrist says of something that hangs in the fingers while the arm stands at `q`; empty:
/// nothing, or the tool does not point down, so that nobody can tell. Half of `mass_kg` more than
/// the empty tool weighs (safety.empty_load_N, or what the cell model's tool weighs) is something.
std::string LeftOnWrist(const WrenchSample& sample, const JointVector& q, const CellModel& model,
                        const SafetyLimits& safety, double mass_kg);

}  // namespace tubetwin
