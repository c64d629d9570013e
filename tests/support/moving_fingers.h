#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "hw_bridge/cell/devices.h"

namespace tubetwin {

/// A gripper in which fingers move at the set speed until they stand at the request or at an object
/// between them. Time passes in Advance().
class MovingFingers : public Gripper {
 public:
  double object_m = -1.0;  ///< Width of what lies between the fingers; below 0: nothing does.
  std::vector<GripperCommand> commands;

  void Command(const GripperCommand& command) override {
    commands.push_back(command);
    requested_m_ = std::clamp(command.opening_m, 0.0, kStroke_m);
    speed_m_s_ = std::clamp(command.speed_m_s, 0.02, 0.15);
    still_ = TimeNs(0);
  }
  GripperState State() const override {
    GripperState state;
    state.time = now_;
    state.opening_m = opening_m_;
    state.requested_m = requested_m_;
    if (still_ < kSettled) {
      state.object = GripperObject::kMoving;
    } else if (std::abs(opening_m_ - requested_m_) < 1e-9) {
      state.object = GripperObject::kAtPosition;
    } else {
      state.object = GripperObject::kContactClosing;
    }
    return state;
  }
  void Advance(TimeNs period) {
    now_ += period;
    double to_m = requested_m_;
    if (object_m >= 0.0 && opening_m_ >= object_m) to_m = std::max(to_m, object_m);
    const double step_m = speed_m_s_ * Seconds(period);
    const double by_m = std::clamp(to_m - opening_m_, -step_m, step_m);
    opening_m_ += by_m;
    still_ = by_m == 0.0 ? still_ + period : TimeNs(0);
  }
  double opening_m() const { return opening_m_; }

 private:
  static constexpr double kStroke_m = 0.085;
  static constexpr TimeNs kSettled = std::chrono::milliseconds(5);
  TimeNs now_{0}, still_{kSettled};
  double opening_m_ = kStroke_m, requested_m_ = kStroke_m, speed_m_s_ = 0.1;
};

}  // namespace tubetwin
