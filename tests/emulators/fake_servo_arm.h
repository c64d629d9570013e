#pragma once

#include "hw_bridge/cell/servo_arm.h"
#include "models/arm/arm.h"

namespace tubetwin::test {

/// Drives without inertia: the arm is where its newest reference says. Advance() once each control
/// period.
class FakeServoArm : public ServoArm {
 public:
  ServoState Servo() const override { return state_; }
  void Follow(const ServoReference& reference) override {
    if (!state_.fault.empty()) return;
    followed_ = true;
    state_.q = state_.q_commanded = reference.q;
    state_.qd = reference.qd;
    ++references;
  }
  void ClearServoFault() override { state_.fault.clear(); }

  void Advance() {
    state_.time += kControlPeriod;
    state_.moving = followed_;
    if (!followed_) state_.qd.setZero();
    followed_ = false;
  }
  void Place(const JointVector& q) { state_.q = state_.q_commanded = q; }
  void Fail(const std::string& why) { state_.fault = why; }

  int references = 0;

 private:
  ServoState state_;
  bool followed_ = false;
};

}  // namespace tubetwin::test
