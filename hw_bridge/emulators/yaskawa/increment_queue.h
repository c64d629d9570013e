#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "hw_bridge/cell/servo_arm.h"

namespace tubetwin {

/// How a YRC1000 with MotoROS 1 turns streamed points into motion: the cubic through position and
/// velocity of two points is cut into increments of 4 ms, at most 200 of them wait. A point that
/// does not fit whole stays in process, and no other is taken.
///
/// Increments say how far to go, not where to: whoever runs a queue that somebody else has left
/// moves from wherever the arm is by then.
class IncrementQueue {
 public:
  static constexpr int kCapacity = 200;
  static constexpr int kIncrement_ms = 4;

  struct Point {
    std::int64_t time_ms = 0;
    JointVector q = JointVector::Zero(), qd = JointVector::Zero();
  };

  /// The first point of a trajectory: no motion yet. What waits goes on.
  void Begin(const Point& first);
  /// A first point was given since the last Clear() or Forget().
  bool begun() const { return begun_; }
  std::int64_t last_time_ms() const { return last_.time_ms; }
  /// The next point, from wherever the last one led. One that is not later than that is dropped,
  /// after it was in process like any other. Precondition: not in_process().
  void Add(const Point& next);
  /// A point is not cut to its end yet.
  bool in_process() const { return in_process_.has_value(); }
  /// Cuts what fits. Once each control period.
  void Cut();

  /// Drops what waits and what is in process.
  void Clear();
  /// Drops what is in process: nobody cuts it any more.
  void DropRest();
  int size() const { return static_cast<int>(increments_.size()); }
  bool empty() const { return increments_.empty() && !in_process_; }

  /// The reference of the coming millisecond; nothing when no motion is left. `commanded`: where
  /// the arm is held, of importance after Halt(). `rate`: at most 1; a controller that limits the
  /// speed runs its increments slower.
  std::optional<ServoReference> Next(const JointVector& commanded, double rate = 1.0);
  /// Joint speeds of the coming millisecond at rate 1; zero when no motion is left.
  JointVector Speed() const;
  /// Nobody runs the queue for now: it goes on from where the arm will be.
  void Halt();

 private:
  /// A cubic in time and the part of it that an increment covers.
  struct Cubic {
    JointVector q0 = JointVector::Zero(), v0 = q0, a1 = q0, a2 = q0;
    ServoReference At(double t_s) const;
  };
  struct Increment {
    Cubic cubic;
    std::int64_t from_ms = 0, to_ms = 0;  ///< In the cubic's time.
  };
  static Cubic Through(const Point& from, const Point& to);
  ServoReference Reference(const Increment& increment, double passed_ms) const;

  Point last_;  ///< Where cutting has got to.
  bool begun_ = false;
  std::optional<Increment> in_process_;  ///< What is left of it.
  Point in_process_end_;
  int left_over_ms_ = 0;  ///< Of the period in which the last point ended.
  std::deque<Increment> increments_;
  double passed_ms_ = 0;  ///< Of the first increment.
  /// From the cubics' place to the arm's; nothing: to be found when the queue runs again.
  std::optional<JointVector> offset_;
  bool halted_ = false;
  JointVector given_ = JointVector::Zero();  ///< Of the last reference.
  std::optional<ServoReference> end_;
};

}  // namespace tubetwin
