#pragma once

#include <functional>
#include <optional>
#include <string>

#include "hw_bridge/cell/checked_trajectory.h"
#include "models/base/cloud/cloud.h"
#include "models/base/joint.h"
#include "models/base/time.h"
#include "models/base/wrench.h"

namespace tubetwin {

// Devices never block: commands start something and return, State() and Read() sample. Only
// CellClock::AdvanceTo lets time pass. All of them belong to one thread, that of the pick cycle.

/// The one thing that lets time pass: the twin steps its physics, a real cell sleeps, a replay
/// reads on.
class CellClock {
 public:
  virtual ~CellClock() = default;
  virtual TimeNs Now() const = 0;
  /// Returns when Now() >= t. A time in the past does nothing.
  virtual void AdvanceTo(TimeNs t) = 0;
};

enum class ArmMode {
  kDisconnected,
  kIdle,
  kReady,
  kMoving,
  kHolding,
  kProtectiveStop,
  kEmergencyStop,
  kFault
};
const char* ToString(ArmMode mode);

struct ArmState {
  TimeNs time{0};
  ArmMode mode = ArmMode::kReady;
  JointVector q = JointVector::Zero();  ///< Measured, rad.
  JointVector qd = JointVector::Zero();
  double progress_s = 0.0;  ///< Time along the running (or last) trajectory.
  double planned_s = 0.0;   ///< Duration of that trajectory with what was appended.
  bool done = true;         ///< The last trajectory was run to its end.
  std::string fault;        ///< Text when mode is a stop or fault.
};

/// Answer to a command. Rejected guarantees that nothing moves.
struct CommandResult {
  enum class Status { kAccepted, kRejected } status = Status::kAccepted;
  std::string reason;  ///< Why rejected, with where.
  bool accepted() const { return status == Status::kAccepted; }
};

enum class StopKind { kOnPath, kFast };

class Arm {
 public:
  virtual ~Arm() = default;
  virtual ArmState State() const = 0;
  /// Starts a trajectory. Rejected when not ready, still moving, or when the arm is further than
  /// 0.2 degrees from its first point.
  [[nodiscard]] virtual CommandResult Start(const CheckedTrajectory& trajectory) = 0;
  /// Streamed points after the running ones; the continuation's time starts where the running
  /// trajectory ends, and its first point is that end. Rejected when nothing runs, a stop is under
  /// way, or the first point is elsewhere.
  [[nodiscard]] virtual CommandResult Append(const CheckedTrajectory& continuation) = 0;
  /// Ends the motion: on the path with a ramp, or as fast as the limits allow.
  virtual void Stop(StopKind kind) = 0;
  /// What the fingers carry besides the empty tool: for feed-forward. p_FC: centre of mass.
  virtual void SetPayload(double mass_kg, const Vector3& p_FC) = 0;
  /// Makes an arm ready again that stands in a stop or fault whose cause is gone. Only when a
  /// person has said so, and never by the device itself. Moves nothing; State() tells when it is
  /// ready.
  [[nodiscard]] virtual CommandResult Recover() {
    return {CommandResult::Status::kRejected, "this arm cannot be made ready from here"};
  }
};

struct GripperCommand {
  double opening_m = 0.0;  ///< Target between the pads.
  double speed_m_s = 0.10;
  double force_N = 60.0;  ///< Per pad.
};

enum class GripperObject { kMoving, kContactOpening, kContactClosing, kAtPosition };
struct GripperState {
  TimeNs time{0};
  bool activated = true;
  GripperObject object = GripperObject::kAtPosition;
  double opening_m = 0.0;  ///< Quantised like the real register.
  double requested_m = 0.0;
  int fault = 0;  ///< Register gFLT.
  std::string
      problem;  ///< Why its driver does not trust it, as "another client ..."; empty: it does.
};

class Gripper {
 public:
  virtual ~Gripper() = default;
  /// Values outside the gripper's range are clamped to it. From here on State() says kMoving until
  /// the fingers stand still again.
  virtual void Command(const GripperCommand& command) = 0;
  virtual GripperState State() const = 0;
};

struct WrenchSample {
  TimeNs time{0};
  Wrench wrench_K;  ///< Load on the sensor, see Wrench. Not tared.
  bool saturated = false;
  std::string problem;  ///< Why this is no measurement, whatever the numbers say; empty: it is one.
};

class ForceTorqueSensor {
 public:
  virtual ~ForceTorqueSensor() = default;
  virtual WrenchSample Read() const = 0;  ///< Newest sample, 1 kHz.
};

enum class ScanStatus { kIdle, kBusy, kReady, kFailed };
class Scanner {
 public:
  virtual ~Scanner() = default;
  /// Starts a scan from where the scanner is now. Rejected while busy.
  [[nodiscard]] virtual CommandResult Trigger() = 0;
  virtual ScanStatus Status() const = 0;
  /// The finished scan, once; its X_NS is the pose the pipeline believes. Precondition: kReady.
  virtual OrganizedCloud Take() = 0;
  /// Like Take(), but what is left to compute (a simulated scanner casts its rays) is done by the
  /// function returned: any thread may call it, once, while the cell goes on and after it is gone.
  virtual std::function<OrganizedCloud()> TakeLater();
  virtual std::string FailureReason() const { return {}; }
};

}  // namespace tubetwin
