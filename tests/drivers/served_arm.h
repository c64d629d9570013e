#pragma once

#include <asio.hpp>
#include <functional>
#include <mutex>
#include <thread>

#include "hw_bridge/cell/wall_clock.h"
#include "hw_bridge/drivers/yaskawa/yaskawa_config.h"
#include "hw_bridge/emulators/yaskawa/arm_emulator.h"
#include "tests/emulators/fake_servo_arm.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {

/// Calls `period` on a thread of its own for each control period of cell time, as `emulate` does:
/// a host that is late makes the cell late.
class PacedThread {
 public:
  PacedThread(double rate, std::mutex& mutex, std::function<void(TimeNs now)> period)
      : thread_([rate, &mutex, period = std::move(period)](const std::stop_token& stop) {
          constexpr TimeNs kMaxLag = std::chrono::milliseconds(20);
          Pace pace(rate, kMaxLag);
          for (TimeNs now{0}; !stop.stop_requested();) {
            const TimeNs due = pace.Due(now);
            for (; now < due && !stop.stop_requested(); now += kControlPeriod) {
              const std::lock_guard lock(mutex);
              period(now + kControlPeriod);
            }
            std::this_thread::sleep_for(pace.Until(now + kControlPeriod));
          }
        }) {}

 private:
  std::jthread thread_;
};

/// An emulated arm controller over drives without inertia, in real time or faster.
class ServedArm {
 public:
  explicit ServedArm(double rate = 2.0, bool servo_on = true)
      : rate_(rate), emulator_(io_, arm_, PaperCell().arm, OnAnyPort(servo_on)) {
    JointVector q;
    q << 0.1, 0.4, 1.5, 0.0, 0.25, 0.0;
    arm_.Place(q);
    thread_.emplace(rate, mutex_, [this](TimeNs now) {
      io_.poll();
      arm_.Advance();
      emulator_.Tick(now);
      if (each_period) each_period(arm_);
    });
  }

  /// What a script does to controller or drives, between two periods.
  template <typename Script>
  auto With(Script script) {
    const std::lock_guard lock(mutex_);
    return script(emulator_, arm_);
  }

  YaskawaConfig Config(bool armed = true) {
    YaskawaConfig config;
    config.host = "127.0.0.1";
    config.motion_port = emulator_.motion_port();
    config.state_port = emulator_.state_port();
    config.io_port = emulator_.io_port();
    config.hses_port = emulator_.hses_port();
    config.armed = armed;
    config.rate = rate_;
    return config;
  }
  int hses_port() const { return emulator_.hses_port(); }

  /// Watches the drives; set it by With().
  std::function<void(const FakeServoArm&)> each_period;

 private:
  static ArmEmulatorConfig OnAnyPort(bool servo_on) {
    ArmEmulatorConfig config;
    config.motion_port = config.state_port = config.io_port = config.hses_port = 0;
    config.servo_on = servo_on;
    return config;
  }
  double rate_;
  asio::io_context io_;
  FakeServoArm arm_;
  ArmEmulator emulator_;
  std::mutex mutex_;
  std::optional<PacedThread> thread_;
};

}  // namespace tubetwin::test
