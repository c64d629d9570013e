#pragma once

#include <memory>

#include "hw_bridge/drivers/yaskawa/yaskawa_arm.h"
#include "tests/drivers/served.h"
#include "tests/drivers/served_arm.h"
#include "tests/support/arm_motions.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {

/// Driver and emulated controller.
struct ArmBench {
  explicit ArmBench(bool armed = true) {
    config = served.Config(armed);
    driver = std::make_unique<YaskawaArm>(config, PaperCell().arm, clock);
  }
  ArmState State() const { return driver->State(); }
  bool Await(ArmMode mode) {
    return Eventually([&] { return driver->State().mode == mode; });
  }
  /// Until it no longer moves.
  ArmState Rest() {
    CHECK(Eventually([&] {
      const ArmMode mode = driver->State().mode;
      return mode != ArmMode::kMoving && mode != ArmMode::kHolding;
    }));
    UNSCOPED_INFO(State().fault);
    return driver->State();
  }
  /// A long motion that is well under way.
  void MoveOn(double by_rad = 1.0, double duration_s = 4.0) {
    REQUIRE(driver->Start(Moved(State().q, by_rad, duration_s)).accepted());
    CHECK(Eventually([&] {
      const ArmState state = driver->State();
      return state.progress_s > 0.5 || state.mode != ArmMode::kMoving;
    }));
    INFO(State().fault);
    REQUIRE(State().mode == ArmMode::kMoving);
  }
  void Pass(double seconds) { clock.AdvanceTo(clock.Now() + FromSeconds(seconds)); }
  /// Nothing moves the drives while this much time passes.
  bool Stands(double seconds = 0.3) {
    const auto references = [](ArmEmulator&, FakeServoArm& arm) { return arm.references; };
    const int before = served.With(references);
    Pass(seconds);
    return served.With(references) == before;
  }
  JointVector Drives() {
    return served.With([](ArmEmulator&, FakeServoArm& arm) { return arm.Servo().q; });
  }

  ServedArm served;
  WallClock clock{2.0};
  YaskawaConfig config;
  std::unique_ptr<YaskawaArm> driver;
};

}  // namespace tubetwin::test
