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

/// What the subcode of a controller that is not ready says: kIdle where it only lacks somebody who
/// starts it.
ArmTrouble TroubleOf(std::int32_t subcode);

/// Servo power and the waiting job are all that is missing: START_TRAJ_MODE may be asked for
/// without a person's word.
bool OnlyNotStarted(std::int32_t subcode);

/// `a` is not to be hidden by `b`.
bool Outweighs(const ArmTrouble& a, const ArmTrouble& b);

}  // namespace tubetwin
