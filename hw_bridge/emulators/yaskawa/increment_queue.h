#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "hw_bridge/cell/servo_arm.h"

namespace tubetwin {

/// How a YRC1000 with MotoROS 1 turns streamed points into motion: the cubic through position and
/// velocity of two points is cut into increments of 4 ms, at most 200 of them wait. A point that
/// does not fit whole stays in process, and no other is taken.
class IncrementQueue {
 public:
  static constexpr int kCapacity = 200;
  static constexpr int kIncrement_ms = 4;

  struct Point {
    std::int64_t time_ms = 0;
    JointVector q = JointVector::Zero(), qd = JointVector::Zero();
  };

  /// The first point of a trajectory: no motion yet. Precondition: empty().
  void Begin(const Point& first);
  /// False: Add needs a first point.
  bool begun() const { return last_.has_value(); }
  std::int64_t last_time_ms() const { return last_->time_ms; }
  /// The next point. Precondition: begun, later than the last one, not in_process().
  void Add(const Point& next);
  /// A point is not cut to its end yet.
  bool in_process() const { return in_process_.has_value(); }
  /// Cuts what fits. Once each control period.
  void Cut();

  /// Drops everything; the next point must be a first one.
  void Clear();
  int size() const { return static_cast<int>(increments_.size()); }
  bool empty() const { return increments_.empty() && !in_process_; }

  /// The reference of the coming millisecond; nothing when no motion is left.
  std::optional<ServoReference> Next();

 private:
  /// A cubic in time and the part of it that an increment covers.
  struct Cubic {
    JointVector q0, v0, a1, a2;
    ServoReference At(double t_s) const;
  };
  struct Increment {
    Cubic cubic;
    std::int64_t from_ms = 0, to_ms = 0;  ///< In the cubic's time.
  };
  static Cubic Through(const Point& from, const Point& to);

  std::optional<Point> last_;
  std::optional<Increment> in_process_;  ///< What is left of it.
  std::deque<Increment> increments_;
  std::int64_t passed_ms_ = 0;  ///< Of the first increment.
  std::optional<ServoReference> end_;
};

}  // namespace tubetwin
