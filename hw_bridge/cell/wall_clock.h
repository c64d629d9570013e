#pragma once

#include <chrono>

#include "hw_bridge/cell/devices.h"

namespace tubetwin {

/// Time of a cell whose devices run by themselves: `rate` times the wall time since construction.
/// Now() may be called from any thread, AdvanceTo() sleeps.
class WallClock : public CellClock {
 public:
  /// Precondition: rate > 0.
  explicit WallClock(double rate = 1.0);

  TimeNs Now() const override;
  void AdvanceTo(TimeNs t) override;
  double rate() const { return rate_; }

 private:
  double rate_;
  std::chrono::steady_clock::time_point began_;
};

/// Wall time against which a paced loop measures how far it is behind: the clock of `emulate`,
/// whose world is stepped as fast as this allows. Once behind by more than `max_lag`, the pace
/// gives in: all that depends on it stretches together, and that overrun is counted.
class Pace {
 public:
  /// `max_lag`: cell time.
  Pace(double rate, TimeNs max_lag);

  /// Cell time that is due now. Gives in first when `reached`, the cell's own time, is too far
  /// behind.
  TimeNs Due(TimeNs reached);
  /// How long to sleep on the wall until the cell's time `t` is due; zero when it is.
  std::chrono::nanoseconds Until(TimeNs t) const;

  int overruns() const { return overruns_; }
  TimeNs worst_lag() const { return worst_lag_; }  ///< Cell time.
  TimeNs given_in() const { return given_in_; }    ///< Cell time by which the clocks stretched.

 private:
  TimeNs Elapsed() const;

  double rate_;
  TimeNs max_lag_;
  std::chrono::steady_clock::time_point began_;
  TimeNs given_in_{0}, worst_lag_{0};
  int overruns_ = 0;
};

}  // namespace tubetwin
