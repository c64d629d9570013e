#pragma once

#include <chrono>

namespace tubetwin {

/// Wall clock in seconds, from any origin: for reports only, no decision may read it.
inline double WallClock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Wall time of the steps; never part of a result.
class StepTimer {
 public:
  /// Milliseconds since the last call.
  double Lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace tubetwin
