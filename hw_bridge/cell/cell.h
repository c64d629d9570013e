#pragma once

#include <functional>
#include <optional>
#include <string>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/cell/safety.h"
#include "models/bin.h"
#include "models/cell_model.h"

namespace tubetwin {

/// A robotic cell as the pipeline sees it: devices, and where they are believed to stand. It does
/// not say whether they are simulated. References stay valid while the cell's owner lives.
struct Cell {
  CellClock& clock;
  Arm& arm;
  Gripper& gripper;
  ForceTorqueSensor& wrist;
  Scanner& scanner;
  const CellModel& model;
  Bin bin;
  SafetyLimits safety;
  /// Set while a tube that was weighed is carried, to the fingers' opening on it: from here on
  /// losing it ends a motion, and so do fingers that open.
  std::optional<double> carried_opening_m = {};
  /// Set when the first tube was placed: the cell is set up right, and start_speed_m_s is over.
  bool proven = false;
  /// A person wants the arm to stand: true ends each motion on its path and lets nothing move any
  /// more. Empty: nobody asks.
  std::function<bool()> stop_at_once = {};
};

// Waiting, guarding and weighing: the same code on every cell, loops over clock and states. Limits
// are checked here before a device sees a command, and what the devices say is watched while they
// move. Whatever goes wrong ends the motion and is the outcome; nothing here starts again by itself
// or opens the gripper.

struct WaitOutcome {
  enum class Status {
    kDone,
    kContact,   ///< A guarded motion met something.
    kStopped,   ///< Somebody else ended the motion before its end; or the controller did.
    kTimedOut,  ///< Still moving long after the planned end.
    kRejected,  ///< Nothing moved.
    kDeviated,  ///< A joint left the path.
    kProtectiveStop,
    kEmergencyStop,
    kFault,         ///< The controller's own: alarm, not ready.
    kLinkLost,      ///< The arm no longer says where it is.
    kSensorFault,   ///< The wrist is silent, saturated or wrong where its wrench matters.
    kGripperFault,  ///< A fault code, silence, or what the gripper does is not what it was told.
    kInterrupted,   ///< Cell::stop_at_once; also of the gripper.
    kObjectLost,    ///< The fingers have closed on nothing while a tube was carried.
  } status = Status::kDone;
  std::string reason;
  double progress_s = 0.0;
};
const char* ToString(WaitOutcome::Status status);

/// Lets time pass until the arm's trajectory is done. Times out at 1.5 x planned + 2 s; the arm is
/// then stopped, as it is for every other outcome of a watch over the devices.
WaitOutcome WaitForArm(Cell& cell);

/// Runs `trajectory`, stretched to the cell's largest speed, and waits. A rejected start is
/// kRejected with its reason.
WaitOutcome RunTrajectory(Cell& cell, const CheckedTrajectory& trajectory);

/// Same, but stops on the path as soon as |force along the motion of E| (5 ms mean, less the mean
/// of the 5 ms before the start) exceeds `force_limit_N` for three samples. The tool's weight is in
/// that bias, so the motion must keep the tool's orientation. kContact: progress_s tells how far
/// along the path the arm came to rest.
WaitOutcome RunGuarded(Cell& cell, const CheckedTrajectory& trajectory, double force_limit_N);

/// What the gripper says after a command, and whether it may be believed.
struct GripperOutcome {
  GripperState state;
  WaitOutcome outcome;  ///< kDone, kTimedOut (still moving), kGripperFault, kInterrupted.
};
/// Commands the gripper and waits until it is at its position or has met something (5 s at most).
GripperOutcome MoveGripper(Cell& cell, const GripperCommand& command);

/// Mean of a wrench, and whether it may be believed.
struct WrenchOutcome {
  Wrench mean_K;
  WaitOutcome outcome;  ///< kDone or kSensorFault.
};
/// Lets `duration_s` pass and returns the mean wrench over it.
WrenchOutcome AverageWrench(Cell& cell, double duration_s);

/// Lets `duration_s` pass.
void Wait(Cell& cell, double duration_s);

/// Triggers and waits for the cloud. Throws Error(kDevice) when the scanner refuses, fails or needs
/// over 30 s.
OrganizedCloud Scan(Cell& cell);

/// After a person has said that the cause of a stop is gone: makes the arm ready, without motion.
/// 12 s at most.
WaitOutcome RecoverArm(Cell& cell);

}  // namespace tubetwin
