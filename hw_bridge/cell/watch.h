#pragma once

#include <optional>

#include "hw_bridge/cell/cell.h"

namespace tubetwin {

// What cell.cc watches; the cell room's own.

/// Why `trajectory` must not be sent to the arm as it is now, or nothing.
/// kInterrupted once somebody has asked for it.
std::optional<WaitOutcome> StopAtOnce(const Cell& cell, double progress_s);

std::optional<WaitOutcome> RefuseStart(const Cell& cell, const CheckedTrajectory& trajectory);

/// The trajectory, stretched until E moves no faster than the cell allows.
CheckedTrajectory WithinSpeed(const Cell& cell, const CheckedTrajectory& trajectory);

/// What a gripper's state says against going on, or nothing.
std::optional<WaitOutcome> GripperTrouble(const Cell& cell, const GripperState& state);

/// What the newest wrench says against trusting it, or nothing. `patience`: times the silence that
/// is allowed where the wrench guards a motion.
std::optional<WaitOutcome> WristTrouble(const Cell& cell, const WrenchSample& sample,
                                        double patience = 1.0);

/// What ends a motion of the arm that is in `state`: silence, deviation from `path` (may be null),
/// the gripper, a lost tube. Nothing: go on.
std::optional<WaitOutcome> MotionTrouble(const Cell& cell, const ArmState& state,
                                         const JointTrajectory* path);

}  // namespace tubetwin
