#pragma once

#include <string>
#include <variant>

#include "hw_bridge/cell/devices.h"

namespace tubetwin {

// What happens at the border of a cell: one struct for each call of a device, with its answer.
// Commands change the world or let time pass; reads do not. `at` is the cell's time at a command.

struct TimeRead {
  TimeNs now{0};
};
struct TimeAdvanced {  ///< A command.
  TimeNs to{0};
  TimeNs now{0};  ///< Afterwards.
};

struct ArmRead {
  ArmState state;
};
struct ArmStarted {  ///< Start, or Append with `appended`.
  TimeNs at{0};
  bool appended = false;
  JointTrajectory trajectory;
  CommandResult answer;
};
struct ArmStopped {
  TimeNs at{0};
  StopKind kind = StopKind::kOnPath;
};
struct ArmRecovered {
  TimeNs at{0};
  CommandResult answer;
};
struct PayloadSet {
  TimeNs at{0};
  double mass_kg = 0.0;
  Vector3 p_FC = Vector3::Zero();
};

struct GripperRead {
  GripperState state;
};
struct GripperCommanded {
  TimeNs at{0};
  GripperCommand command;
};

struct WristRead {
  WrenchSample sample;
};

struct ScanTriggered {
  TimeNs at{0};
  CommandResult answer;
};
struct ScanStatusRead {
  ScanStatus status = ScanStatus::kIdle;
};
struct ScanTaken {  ///< A command: the scan is gone afterwards.
  TimeNs at{0};
  OrganizedCloud cloud_S;
};
struct ScanFailureRead {
  std::string reason;
};

/// What the pipeline says, not a call: what it is about to do (a caption), or what something came
/// to (a result, which a replay compares like a command).
struct PipelineNote {
  enum class Kind { kCaption, kResult } kind = Kind::kCaption;
  TimeNs at{0};
  std::string text;
};

using CellEvent =
    std::variant<TimeRead, TimeAdvanced, ArmRead, ArmStarted, ArmStopped, PayloadSet, GripperRead,
                 GripperCommanded, WristRead, ScanTriggered, ScanStatusRead, ScanTaken,
                 ScanFailureRead, PipelineNote, ArmRecovered>;

/// Reads only sample; everything else a replay compares in order, captions excepted.
inline bool IsRead(const CellEvent& event) {
  return std::holds_alternative<TimeRead>(event) || std::holds_alternative<ArmRead>(event) ||
         std::holds_alternative<GripperRead>(event) || std::holds_alternative<WristRead>(event) ||
         std::holds_alternative<ScanStatusRead>(event) ||
         std::holds_alternative<ScanFailureRead>(event);
}

}  // namespace tubetwin
