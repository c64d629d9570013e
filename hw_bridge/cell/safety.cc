#include "hw_bridge/cell/safety.h"

#include <algorithm>

namespace tubetwin {

void SafetyLimits::Visit(ConfigVisitor& v) {
  v.Field("arm_silence_s", "a moving arm whose state is older than this is stopped: link lost",
          arm_silence_s, {0.02, 5});
  v.Field("wrist_silence_s",
          "a guarded motion or weighing ends when the newest wrench is older than this",
          wrist_silence_s, {0.005, 5});
  v.Field("gripper_silence_s", "the arm stops when the gripper's state is older than this",
          gripper_silence_s, {0.02, 5});
  v.Field("deviation_deg", "the arm stops when a joint is further than this from the path",
          deviation_deg, {0.1, 10});
  v.Field("hold_s", "how long a controller may hold the arm back before the motion is given up",
          hold_s, {1, 3600});
  v.NumbersOrNone(
      "empty_load_N",
      "what the wrist tells along gravity with empty fingers pointing down, one number; "
      "a round begins only where it tells no tube more; empty: the weight of the cell "
      "model's tool",
      empty_load_N, 1);
  v.Field("max_speed_m_s", "trajectories are stretched until the fingers move no faster; 0: never",
          max_speed_m_s, {0, 2});
}

SafetyLimits SafetyLimits::AtRate(double rate) const {
  SafetyLimits limits = *this;
  const double factor = std::max(1.0, rate);
  limits.arm_silence_s *= factor;
  limits.wrist_silence_s *= factor;
  limits.gripper_silence_s *= factor;
  limits.hold_s *= factor;
  return limits;
}

}  // namespace tubetwin
