#pragma once

namespace tubetwin {

/// Bounds of a path parameter's speed, acceleration and jerk, per second, second squared, cubed.
struct PathLimits {
  double speed = 1.0, acceleration = 1.0, jerk = 1.0;
  /// The same law run `k` times slower.
  PathLimits Slowed(double k) const {
    return {speed / k, acceleration / (k * k), jerk / (k * k * k)};
  }
};

/// The fastest motion of a path parameter from rest at 0 to rest at `length` within the limits:
/// seven phases of constant jerk (double S), some of them empty on short paths.
class SCurve {
 public:
  /// Precondition: length >= 0, all limits > 0.
  SCurve(double length, const PathLimits& limits);

  double duration_s() const { return duration_s_; }

  struct State {
    double s = 0, v = 0, a = 0;  ///< Parameter, its speed and acceleration.
  };
  /// At `time_s`, clamped to the motion's ends.
  State At(double time_s) const;

 private:
  State FirstHalf(double time_s) const;

  double length_, jerk_;
  double jerk_time_s_, ramp_time_s_, duration_s_;  // one jerk phase, one ramp, all
};

}  // namespace tubetwin
