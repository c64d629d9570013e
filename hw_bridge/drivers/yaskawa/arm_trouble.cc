#include "hw_bridge/drivers/yaskawa/arm_trouble.h"

namespace tubetwin {
namespace {

namespace sm = simple_message;

int Weight(ArmMode mode) {
  switch (mode) {
    case ArmMode::kEmergencyStop:
      return 3;
    case ArmMode::kProtectiveStop:
      return 2;
    case ArmMode::kFault:
      return 1;
    default:
      return 0;
  }
}

}  // namespace

std::optional<ArmTrouble> TroubleOf(const sm::RobotStatus& status) {
  // -1 is unknown.
  if (status.e_stopped == 1) return ArmTrouble{ArmMode::kEmergencyStop, "emergency stop"};
  if (status.in_error == 1 || status.error_code > 0) {
    return ArmTrouble{ArmMode::kFault, status.error_code > 0
                                           ? "alarm " + std::to_string(status.error_code)
                                           : "the controller is in error"};
  }
  return std::nullopt;
}

ArmTrouble TroubleOf(std::int32_t subcode) {
  const std::string text = "the controller is not ready: " + sm::SubcodeText(subcode);
  switch (static_cast<sm::NotReady>(subcode)) {
    case sm::NotReady::kEmergencyStop:
      return {ArmMode::kEmergencyStop, text};
    case sm::NotReady::kContactStop:
      return {ArmMode::kProtectiveStop, text};
    case sm::NotReady::kNotPlay:
    case sm::NotReady::kNotRemote:
    case sm::NotReady::kServoOff:
    case sm::NotReady::kHold:
    case sm::NotReady::kNotStarted:
    case sm::NotReady::kWaiting:
    case sm::NotReady::kSkillSend:
      return {ArmMode::kIdle, text};
    default:
      return {ArmMode::kFault, text};
  }
}

bool OnlyNotStarted(std::int32_t subcode) {
  switch (static_cast<sm::NotReady>(subcode)) {
    case sm::NotReady::kServoOff:
    case sm::NotReady::kNotStarted:
    case sm::NotReady::kWaiting:
      return true;
    default:
      return false;
  }
}

std::string UncommandedMotion(bool moves) {
  if (moves) {
    return "the arm moves though nobody commands it from here; allowed is an arm at rest: stop "
           "whoever moves it (another client, a job, the pendant) and start again";
  }
  return "the controller is in motion though the arm stands and nobody commands it from here: an "
         "earlier connection has left motion that the next one runs; allowed is an empty queue: "
         "press HOLD or switch the drives off at the pendant, which empties it, and start again";
}

bool Outweighs(const ArmTrouble& a, const ArmTrouble& b) { return Weight(a.mode) > Weight(b.mode); }

}  // namespace tubetwin
