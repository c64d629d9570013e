#pragma once

#include "hw_bridge/cell/cell.h"
#include "hw_bridge/cell/servo_arm.h"
#include "twin/live/live_clock.h"

namespace tubetwin {

// A twin's devices in a cell of mixed devices: whoever asks them, or tells them anything, finds
// them at the clock's time, however long the program has computed since it last let time pass.

class KeptArm : public Arm {
 public:
  KeptArm(Arm& twin, LiveClock& clock) : twin_(twin), clock_(clock) {}
  ArmState State() const override { return Now().State(); }
  CommandResult Start(const CheckedTrajectory& trajectory) override {
    return Now().Start(trajectory);
  }
  CommandResult Append(const CheckedTrajectory& more) override { return Now().Append(more); }
  void Stop(StopKind kind) override { Now().Stop(kind); }
  void SetPayload(double mass_kg, const Vector3& p_FC) override { Now().SetPayload(mass_kg, p_FC); }
  CommandResult Recover() override { return Now().Recover(); }

 private:
  Arm& Now() const {
    clock_.CatchUp();
    return twin_;
  }
  Arm& twin_;
  LiveClock& clock_;
};

class KeptGripper : public Gripper {
 public:
  KeptGripper(Gripper& twin, LiveClock& clock) : twin_(twin), clock_(clock) {}
  void Command(const GripperCommand& command) override { Now().Command(command); }
  GripperState State() const override { return Now().State(); }

 private:
  Gripper& Now() const {
    clock_.CatchUp();
    return twin_;
  }
  Gripper& twin_;
  LiveClock& clock_;
};

class KeptWrist : public ForceTorqueSensor {
 public:
  KeptWrist(ForceTorqueSensor& twin, LiveClock& clock) : twin_(twin), clock_(clock) {}
  WrenchSample Read() const override {
    clock_.CatchUp();
    return twin_.Read();
  }

 private:
  ForceTorqueSensor& twin_;
  LiveClock& clock_;
};

class KeptScanner : public Scanner {
 public:
  KeptScanner(Scanner& twin, LiveClock& clock) : twin_(twin), clock_(clock) {}
  CommandResult Trigger() override { return Now().Trigger(); }
  ScanStatus Status() const override { return Now().Status(); }
  OrganizedCloud Take() override { return Now().Take(); }
  std::function<OrganizedCloud()> TakeLater() override { return Now().TakeLater(); }
  std::string FailureReason() const override { return Now().FailureReason(); }

 private:
  Scanner& Now() const {
    clock_.CatchUp();
    return twin_;
  }
  Scanner& twin_;
  LiveClock& clock_;
};

/// Makes the twin's arm go where a real one is, so that the twin's other devices are on it. The
/// reference bends towards the joints that the real arm tells, smoothly, as its states come seldom
/// and it may stand elsewhere at first.
class ShadowArm {
 public:
  /// Both must outlive it.
  ShadowArm(const Arm& real, ServoArm& twin);
  /// Once per control period.
  void Follow();
  /// Of the joint that is furthest off.
  double Off_rad() const;

 private:
  const Arm& real_;
  ServoArm& twin_;
  ServoReference reference_;
};

}  // namespace tubetwin
