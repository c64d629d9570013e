#pragma once

#include <asio.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "hw_bridge/drivers/yaskawa/yaskawa_arm.h"
#include "hw_bridge/emulators/yaskawa/arm_emulator.h"
#include "tests/contract/arm_contract.h"
#include "tests/drivers/served_arm.h"
#include "tests/support/paper_cell.h"
#include "tests/twin_cell/cell_fixture.h"

namespace tubetwin::test {

inline Pile TubeAside() { return OneTube("pvc_a", Vector3(0, 0.1, 0.0126)); }

/// A damper that no drive moves, in the first joint.
class BlockedJoint {
 public:
  explicit BlockedJoint(TwinCell& twin)
      : damping_(TwinCellProbe::Impl(twin).world.model().dof_damping[0]), usual_(damping_) {}
  void Block(bool blocked) { damping_ = blocked ? 1e6 : usual_; }

 private:
  mjtNum& damping_;
  mjtNum usual_;
};

/// The twin's arm itself.
class TwinArmRig : public ArmContractRig {
 public:
  TwinArmRig() : twin_(TubeAside(), NominalOptions(TubeAside())), joint_(twin_) {}
  Cell& cell() override { return twin_.cell(); }
  void Block(bool blocked) override { joint_.Block(blocked); }

 private:
  TwinCell twin_;
  BlockedJoint joint_;
};

/// The driver and, over loopback, the emulated controller on the twin's drives, in real time.
class DriverArmRig : public ArmContractRig {
 public:
  DriverArmRig()
      : twin_(TubeAside(), NominalOptions(TubeAside())),
        joint_(twin_),
        emulator_(io_, impl().arm, PaperCell().arm, OnAnyPort()),
        thread_(1.0, mutex_, [this](TimeNs) { Period(); }),
        driver_(Config(), PaperCell().arm, clock_),
        cell_{clock_,
              driver_,
              twin_.cell().gripper,
              twin_.cell().wrist,
              twin_.cell().scanner,
              twin_.cell().model,
              twin_.cell().bin,
              SafetyLimits()} {}
  Cell& cell() override { return cell_; }
  void Block(bool blocked) override {
    const std::lock_guard lock(mutex_);
    joint_.Block(blocked);
  }
  /// True joints after each period in which the drives moved, since the last call.
  std::vector<JointVector> TakeTrack() {
    const std::lock_guard lock(mutex_);
    return std::exchange(track_, {});
  }
  int busy_answers() {
    const std::lock_guard lock(mutex_);
    return emulator_.controller().busy_answers();
  }

 private:
  TwinCell::Impl& impl() { return TwinCellProbe::Impl(twin_); }
  void Period() {
    io_.poll();
    twin_.cell().clock.AdvanceTo(twin_.cell().clock.Now() + kControlPeriod);
    if (impl().arm.Servo().moving) track_.push_back(impl().arm.TruePosition());
    emulator_.Tick(twin_.cell().clock.Now());
  }
  static ArmEmulatorConfig OnAnyPort() {
    ArmEmulatorConfig config;
    config.motion_port = config.state_port = config.io_port = config.hses_port = 0;
    return config;
  }
  YaskawaConfig Config() {
    YaskawaConfig config;
    config.host = "127.0.0.1";
    config.motion_port = emulator_.motion_port();
    config.state_port = emulator_.state_port();
    config.armed = true;
    return config;
  }

  TwinCell twin_;
  BlockedJoint joint_;
  asio::io_context io_;
  ArmEmulator emulator_;
  std::vector<JointVector> track_;
  std::mutex mutex_;
  WallClock clock_;
  PacedThread thread_;
  YaskawaArm driver_;
  Cell cell_;
};

}  // namespace tubetwin::test
