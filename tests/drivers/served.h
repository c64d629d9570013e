#pragma once

#include <asio.hpp>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/emulators/ati/wrist_emulator.h"
#include "hw_bridge/emulators/robotiq/gripper_emulator.h"
#include "tests/support/moving_fingers.h"
#include "tests/support/paper_scale.h"

namespace tubetwin {

/// Cell time that runs `rate` times as fast as the wall's.
class RunningClock : public CellClock {
 public:
  explicit RunningClock(double rate) : rate_(rate), began_(std::chrono::steady_clock::now()) {}
  TimeNs Now() const override {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began_;
    return FromSeconds(rate_ * wall.count());
  }
  void AdvanceTo(TimeNs t) override {
    while (Now() < t) std::this_thread::sleep_for(std::chrono::microseconds(100));
  }

 private:
  double rate_;
  std::chrono::steady_clock::time_point began_;
};

/// Calls `period` on a thread of its own for each control period of cell time, as `emulate` does;
/// periods that are overdue follow at once.
class PeriodThread {
 public:
  PeriodThread(double rate, std::mutex& mutex, std::function<void(TimeNs now)> period)
      : thread_([rate, &mutex, period = std::move(period)](std::stop_token stop) {
          RunningClock clock(rate);
          for (TimeNs now{0}; !stop.stop_requested();) {
            clock.AdvanceTo(now + kControlPeriod);
            now += kControlPeriod;
            const std::lock_guard lock(mutex);
            period(now);
          }
        }) {}

 private:
  std::jthread thread_;
};

inline constexpr double kServedRate = 5.0;

/// An emulated gripper with moving fingers.
class ServedGripper {
 public:
  explicit ServedGripper(const std::string& device = "") : emulator_(io_, fingers_, At(device)) {}
  /// What a script does to the gripper, between two periods.
  template <typename Script>
  auto With(Script script) {
    const std::lock_guard lock(mutex_);
    return script(emulator_, fingers_);
  }
  int port() { return emulator_.port(); }

 private:
  static GripperEmulatorConfig At(const std::string& device) {
    GripperEmulatorConfig config;
    config.scale = PaperScale();
    config.port = 0;
    config.transport = device.empty() ? "tcp" : "rtu";
    config.device = device;
    return config;
  }
  asio::io_context io_;
  MovingFingers fingers_;
  GripperEmulator emulator_;
  std::mutex mutex_;
  PeriodThread thread_{kServedRate, mutex_, [this](TimeNs now) {
                         fingers_.Advance(kControlPeriod);
                         emulator_.Tick(now);
                       }};
};

/// A sensor that reads what a test sets.
struct SetWrist : ForceTorqueSensor {
  WrenchSample Read() const override { return sample; }
  WrenchSample sample;
};

/// An emulated force/torque sensor.
class ServedWrist {
 public:
  explicit ServedWrist(WristEmulatorConfig config = {}, double rate = kServedRate)
      : emulator_(io_, sensor_, OnAnyPort(config)),
        thread_(rate, mutex_, [this](TimeNs now) { emulator_.Tick(now); }) {}
  template <typename Script>
  auto With(Script script) {
    const std::lock_guard lock(mutex_);
    return script(emulator_, sensor_);
  }
  int port() { return emulator_.port(); }
  int http_port() { return emulator_.http_port(); }

 private:
  static WristEmulatorConfig OnAnyPort(WristEmulatorConfig config) {
    config.port = config.http_port = 0;
    return config;
  }
  asio::io_context io_;
  SetWrist sensor_;
  WristEmulator emulator_;
  std::mutex mutex_;
  PeriodThread thread_;
};

/// Waits until `holds` does; false when it never does (no result depends on how long it takes).
template <typename Condition>
bool Eventually(Condition holds) {
  for (int i = 0; i < 20000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

}  // namespace tubetwin
