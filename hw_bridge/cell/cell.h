#pragma once

#include "hw_bridge/cell/devices.h"
#include "models/bin.h"
#include "models/gripper_spec.h"
#include "models/layout.h"

namespace tubetwin {

/// A robotic cell as the pipeline sees it: devices, and where they are believed to stand. It does
/// not say whether they are simulated. References stay valid while the cell's owner lives.
struct Cell {
  CellClock& clock;
  Arm& arm;
  Gripper& gripper;
  ForceTorqueSensor& wrist;
  Scanner& scanner;
  const ArmModel& arm_model;
  CellLayout layout;
  Bin bin;
};

// Waiting, guarding and weighing: the same code on every cell, loops over clock and states.

struct WaitOutcome {
  enum class Status { kDone, kContact, kStopped, kTimedOut, kFault } status = Status::kDone;
  std::string reason;
  double progress_s = 0.0;
};

/// Lets time pass until the arm's trajectory is done. Times out at 1.5 x planned + 2 s.
WaitOutcome WaitForArm(Cell& cell);

/// Runs `trajectory` and waits. A rejected start is kFault with its reason.
WaitOutcome RunTrajectory(Cell& cell, const CheckedTrajectory& trajectory);

/// Same, but stops on the path as soon as |force along the motion of E| (5 ms mean, less the mean
/// of the 5 ms before the start) exceeds `force_limit_N` for three samples. The tool's weight is in
/// that bias, so the motion must keep the tool's orientation. kContact: progress_s tells how far
/// along the path the arm came to rest.
WaitOutcome RunGuarded(Cell& cell, const CheckedTrajectory& trajectory, double force_limit_N);

/// Commands the gripper and waits until it is at its position or has met something (5 s at most).
GripperState MoveGripper(Cell& cell, const GripperCommand& command);

/// Lets `duration_s` pass and returns the mean wrench over it.
Wrench AverageWrench(Cell& cell, double duration_s);

/// Lets `duration_s` pass.
void Wait(Cell& cell, double duration_s);

/// Triggers and waits for the cloud. Throws Error(kDevice) when the scanner refuses, fails or needs
/// over 30 s.
OrganizedCloud Scan(Cell& cell);

}  // namespace tubetwin
