#pragma once

#include <functional>

#include "hw_bridge/cell/wall_clock.h"

namespace tubetwin {

/// Wall time, with a twin that is kept up to it: by AdvanceTo(), and by CatchUp() where the program
/// has computed meanwhile. Now() may be called from any thread.
class LiveClock : public CellClock {
 public:
  explicit LiveClock(double rate) : wall_(rate) {}
  /// From here on `twin` is kept up; `before_period` is called before each of its periods. `twin`
  /// must outlive this.
  void Keep(CellClock& twin, std::function<void()> before_period);

  TimeNs Now() const override { return wall_.Now(); }
  void AdvanceTo(TimeNs t) override;
  /// Steps the twin, if there is one, until it is at Now(); a twin that is slower than the wall
  /// stays behind it.
  void CatchUp();

 private:
  void Step(TimeNs to);

  WallClock wall_;
  CellClock* twin_ = nullptr;
  std::function<void()> before_period_;
};

}  // namespace tubetwin
