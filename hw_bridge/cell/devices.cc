#include "hw_bridge/cell/devices.h"

#include <memory>
#include <utility>

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

std::function<OrganizedCloud()> Scanner::TakeLater() {
  // Shared because functions are copied; only one of the copies is called.
  const auto cloud = std::make_shared<OrganizedCloud>(Take());
  return [cloud] { return std::move(*cloud); };
}

}  // namespace tubetwin
