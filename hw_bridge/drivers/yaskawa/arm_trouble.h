#pragma once

#include <optional>
#include <string>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/codecs/simple_message.h"

namespace tubetwin {

/// What keeps an arm from moving, in the words of ArmState.
struct ArmTrouble {
  ArmMode mode = ArmMode::kFault;
  std::string text;
};

/// What a status says by itself: emergency stop, alarm.
std::optional<ArmTrouble> TroubleOf(const simple_message::RobotStatus& status);

/// What the subcode of a controller that is not ready means. kIdle: nothing is wrong, it was only
/// not started.
ArmTrouble TroubleOf(std::int32_t subcode);

/// Whether only servo power and the job are missing, so that START_TRAJ_MODE may be sent without a
/// person's consent.
bool OnlyNotStarted(std::int32_t subcode);

/// What a controller means that is in motion though nobody commands it from here. `moves`: its arm
/// was seen to; otherwise it stands, and increments wait.
std::string UncommandedMotion(bool moves);

/// Whether `a` is the more serious one and must not be replaced by `b`.
bool Outweighs(const ArmTrouble& a, const ArmTrouble& b);

}  // namespace tubetwin
