#pragma once

#include <cstdint>
#include <functional>

#include "twin/cell/cell_world.h"
#include "twin/cell/twin_arm.h"
#include "twin/cell/twin_cell.h"
#include "twin/cell/twin_gripper.h"
#include "twin/cell/twin_scanner.h"
#include "twin/cell/twin_wrist.h"

namespace tubetwin {

/// Time of the twin: advancing it steps the world.
class TwinClock : public CellClock {
 public:
  explicit TwinClock(TwinCell::Impl& parts) : parts_(parts) {}
  TimeNs Now() const override;
  void AdvanceTo(TimeNs t) override;

 private:
  TwinCell::Impl& parts_;
};

/// World and devices of one twin cell. For the room's own files and tests only.
struct TwinCell::Impl {
  Impl(const Pile& pile, const TwinCellOptions& options);
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// One control period: torques and servo, physics, a sample of the wrist, a frame when due.
  void Step();

  CellModel model;
  CellWorld world;
  TwinArm arm;
  TwinGripper gripper;
  TwinWrist wrist;
  TwinScanner scanner;
  TwinClock clock;
  Cell cell;
  Pile start_pile;
  std::function<void()> observer;
  std::int64_t frames = 0;
};

}  // namespace tubetwin
