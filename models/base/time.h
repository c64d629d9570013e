#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace tubetwin {

/// Simulated (or, on a real cell, monotonic) time: an integer count of nanoseconds from the start
/// of the round. Integer so that control periods never drift.
using TimeNs = std::chrono::nanoseconds;

inline double Seconds(TimeNs t) { return static_cast<double>(t.count()) * 1e-9; }
inline TimeNs FromSeconds(double t_s) {
  return TimeNs(static_cast<std::int64_t>(std::llround(t_s * 1e9)));
}

/// Control period of the whole cell: arm reference, sensor samples, guards.
inline constexpr TimeNs kControlPeriod = std::chrono::milliseconds(1);

}  // namespace tubetwin
