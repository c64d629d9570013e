#include "hw_bridge/emulators/yaskawa/increment_queue.h"

#include <algorithm>

#include "models/base/error.h"

namespace tubetwin {

static_assert(kControlPeriod == std::chrono::milliseconds(1));

ServoReference IncrementQueue::Cubic::At(double t) const {
  ServoReference reference;
  reference.q = q0 + t * (v0 + t * (a1 / 2 + t * a2 / 6));
  reference.qd = v0 + t * (a1 + t * a2 / 2);
  reference.qdd = a1 + t * a2;
  return reference;
}

IncrementQueue::Cubic IncrementQueue::Through(const Point& from, const Point& to) {
  const double T = 1e-3 * static_cast<double>(to.time_ms - from.time_ms);
  const JointVector d = to.q - from.q;
  return {from.q, from.qd, 6 * d / (T * T) - 2 * (to.qd + 2 * from.qd) / T,
          -12 * d / (T * T * T) + 6 * (to.qd + from.qd) / (T * T)};
}

void IncrementQueue::Begin(const Point& first) {
  last_ = first;
  begun_ = true;
  left_over_ms_ = 0;
}

void IncrementQueue::Add(const Point& next) {
  TT_CHECK(!in_process());
  const std::int64_t length_ms = next.time_ms - last_.time_ms;
  in_process_ = Increment{};
  in_process_end_ = length_ms > 0 ? next : last_;
  if (length_ms > 0) in_process_ = Increment{Through(last_, next), 0, length_ms};
}

void IncrementQueue::Cut() {
  while (in_process_ && in_process_->from_ms < in_process_->to_ms && size() < kCapacity) {
    const std::int64_t step_ms = left_over_ms_ > 0 ? left_over_ms_ : kIncrement_ms;
    Increment cut = *in_process_;
    const std::int64_t clock_ms = cut.from_ms + step_ms;
    cut.to_ms = std::min(clock_ms, in_process_->to_ms);
    // A point that ends within a period leaves the rest of that period to the next point. One that
    // ends with a period that was begun by another leaves as much again, as the controller does.
    if (clock_ms != in_process_->to_ms) {
      left_over_ms_ = static_cast<int>(clock_ms - cut.to_ms);
    }
    increments_.push_back(cut);
    in_process_->from_ms = cut.to_ms;
    const ServoReference there = cut.cubic.At(1e-3 * static_cast<double>(cut.to_ms));
    last_ = {last_.time_ms + cut.to_ms - cut.from_ms, there.q, there.qd};
  }
  if (in_process_ && in_process_->from_ms >= in_process_->to_ms) {
    last_ = in_process_end_;
    in_process_.reset();
  }
}

void IncrementQueue::Clear() {
  begun_ = false;
  in_process_.reset();
  increments_.clear();
  passed_ms_ = 0;
  end_.reset();
  offset_.reset();
}

void IncrementQueue::DropRest() { in_process_.reset(); }

void IncrementQueue::Halt() {
  halted_ = true;
  end_.reset();
}

ServoReference IncrementQueue::Reference(const Increment& increment, double passed_ms) const {
  ServoReference reference =
      increment.cubic.At(1e-3 * (static_cast<double>(increment.from_ms) + passed_ms));
  if (offset_) reference.q += *offset_;
  return reference;
}

JointVector IncrementQueue::Speed() const {
  return increments_.empty() ? JointVector::Zero() : Reference(increments_.front(), passed_ms_).qd;
}

std::optional<ServoReference> IncrementQueue::Next(const JointVector& commanded, double rate) {
  if (increments_.empty()) {
    // The end of the last increment, once: its first moment would have been the next one's.
    const std::optional<ServoReference> end = end_;
    end_.reset();
    offset_.reset();
    return end;
  }
  if (!offset_) {
    const JointVector off = commanded - Reference(increments_.front(), passed_ms_).q;
    offset_ = off;
  } else if (halted_) {
    *offset_ += commanded - given_;
  }
  halted_ = false;
  ServoReference now = Reference(increments_.front(), passed_ms_);
  given_ = now.q;
  now.qd *= rate;
  now.qdd *= rate * rate;
  passed_ms_ += rate;
  while (!increments_.empty()) {
    const Increment first = increments_.front();
    const auto length_ms = static_cast<double>(first.to_ms - first.from_ms);
    if (passed_ms_ < length_ms) break;
    const ServoReference end = Reference(first, length_ms);
    passed_ms_ -= length_ms;
    increments_.pop_front();
    if (increments_.empty()) {
      end_ = end;
      end_->qdd.setZero();
      passed_ms_ = 0;
    } else {
      // Nothing, unless another trajectory was begun while this one ran.
      *offset_ += end.q - Reference(increments_.front(), 0.0).q;
    }
  }
  return now;
}

}  // namespace tubetwin
