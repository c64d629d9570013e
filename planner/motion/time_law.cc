#include "planner/motion/time_law.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"

namespace tubetwin {

SCurve::SCurve(double length, const PathLimits& limits) : length_(length), jerk_(limits.jerk) {
  TT_CHECK(length >= 0.0);
  TT_CHECK(limits.speed > 0.0 && limits.acceleration > 0.0 && limits.jerk > 0.0);
  const double v = limits.speed, a = limits.acceleration, j = limits.jerk;
  // Ramp to full speed, with a phase of constant acceleration when that limit is reached.
  const bool reaches_acceleration = v * j >= a * a;
  jerk_time_s_ = reaches_acceleration ? a / j : std::sqrt(v / j);
  ramp_time_s_ = reaches_acceleration ? a / j + v / a : 2 * jerk_time_s_;
  double cruise_s = length / v - ramp_time_s_;
  if (cruise_s < 0.0) {  // Too short for full speed: two ramps only.
    cruise_s = 0.0;
    if (length >= 2 * a * a * a / (j * j)) {
      jerk_time_s_ = a / j;
      const double half = 0.5 * jerk_time_s_;
      ramp_time_s_ = half + std::sqrt(half * half + length / a);
    } else {
      jerk_time_s_ = std::cbrt(0.5 * length / j);
      ramp_time_s_ = 2 * jerk_time_s_;
    }
  }
  duration_s_ = 2 * ramp_time_s_ + cruise_s;
}

SCurve::State SCurve::FirstHalf(double t) const {
  const double a = jerk_ * jerk_time_s_;
  const double v = a * (ramp_time_s_ - jerk_time_s_);
  if (t < jerk_time_s_) return {jerk_ * t * t * t / 6, jerk_ * t * t / 2, jerk_ * t};
  if (t < ramp_time_s_ - jerk_time_s_) {
    return {a / 6 * (3 * t * t - 3 * jerk_time_s_ * t + jerk_time_s_ * jerk_time_s_),
            a * (t - 0.5 * jerk_time_s_), a};
  }
  const double ramp_length = 0.5 * v * ramp_time_s_;
  if (t < ramp_time_s_) {
    const double left = ramp_time_s_ - t;
    return {ramp_length - v * left + jerk_ * left * left * left / 6, v - 0.5 * jerk_ * left * left,
            jerk_ * left};
  }
  return {ramp_length + v * (t - ramp_time_s_), v, 0.0};
}

SCurve::State SCurve::At(double time_s) const {
  if (time_s <= 0.0) return {0.0, 0.0, 0.0};
  if (time_s >= duration_s_) return {length_, 0.0, 0.0};
  if (time_s <= 0.5 * duration_s_) return FirstHalf(time_s);
  // The second half is the first run backwards.
  const State mirrored = FirstHalf(duration_s_ - time_s);
  return {length_ - mirrored.s, mirrored.v, -mirrored.a};
}

}  // namespace tubetwin
