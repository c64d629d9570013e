#include "hw_bridge/cell/devices.h"

namespace tubetwin {

const char* ToString(ArmMode mode) {
  switch (mode) {
    case ArmMode::kDisconnected:
      return "disconnected";
    case ArmMode::kIdle:
      return "idle";
    case ArmMode::kReady:
      return "ready";
    case ArmMode::kMoving:
      return "moving";
    case ArmMode::kHolding:
      return "holding";
    case ArmMode::kProtectiveStop:
      return "protective stop";
    case ArmMode::kEmergencyStop:
      return "emergency stop";
    case ArmMode::kFault:
      return "fault";
  }
  return "unknown";
}

}  // namespace tubetwin
