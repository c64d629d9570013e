#include "hw_bridge/cell/wall_clock.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "models/base/error.h"

namespace tubetwin {
namespace {

TimeNs Scaled(std::chrono::nanoseconds t, double factor) {
  return TimeNs(std::llround(static_cast<double>(t.count()) * factor));
}

}  // namespace

WallClock::WallClock(double rate) : rate_(rate), began_(std::chrono::steady_clock::now()) {
  TT_CHECK(rate > 0.0);
}

TimeNs WallClock::Now() const { return Scaled(std::chrono::steady_clock::now() - began_, rate_); }

void WallClock::AdvanceTo(TimeNs t) {
  // Rounding of the scaled time may leave a nanosecond: sleep until the clock says so.
  while (Now() < t) {
    const auto wake = began_ + Scaled(t, 1.0 / rate_) + std::chrono::nanoseconds(1);
    std::this_thread::sleep_until(wake);
  }
}

Pace::Pace(double rate, TimeNs max_lag)
    : rate_(rate), max_lag_(max_lag), began_(std::chrono::steady_clock::now()) {
  TT_CHECK(rate > 0.0);
}

TimeNs Pace::Elapsed() const { return Scaled(std::chrono::steady_clock::now() - began_, rate_); }

TimeNs Pace::Due(TimeNs reached) {
  const TimeNs lag = Elapsed() - given_in_ - reached;
  worst_lag_ = std::max(worst_lag_, lag);
  if (lag > max_lag_) {
    given_in_ += lag;
    ++overruns_;
  }
  return Elapsed() - given_in_;
}

std::chrono::nanoseconds Pace::Until(TimeNs t) const {
  const TimeNs ahead = t + given_in_ - Elapsed();
  return std::max(std::chrono::nanoseconds(0), Scaled(ahead, 1.0 / rate_));
}

}  // namespace tubetwin
