#pragma once

#include <chrono>

namespace tubetwin {

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
