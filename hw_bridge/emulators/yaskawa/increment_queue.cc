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
  TT_CHECK(empty());
  last_ = first;
}

void IncrementQueue::Add(const Point& next) {
  TT_CHECK(begun() && !in_process() && next.time_ms > last_->time_ms);
  in_process_ = Increment{Through(*last_, next), 0, next.time_ms - last_->time_ms};
  last_ = next;
}

void IncrementQueue::Cut() {
  while (in_process_ && size() < kCapacity) {
    Increment cut = *in_process_;
    cut.to_ms = std::min(cut.from_ms + kIncrement_ms, in_process_->to_ms);
    increments_.push_back(cut);
    in_process_->from_ms = cut.to_ms;
    if (in_process_->from_ms == in_process_->to_ms) in_process_.reset();
  }
}

void IncrementQueue::Clear() {
  last_.reset();
  in_process_.reset();
  increments_.clear();
  passed_ms_ = 0;
  end_.reset();
}

std::optional<ServoReference> IncrementQueue::Next() {
  if (increments_.empty()) {
    // The end of the last increment, once: its first moment would have been the next one's.
    const std::optional<ServoReference> end = end_;
    end_.reset();
    return end;
  }
  const Increment& first = increments_.front();
  const ServoReference now = first.cubic.At(1e-3 * static_cast<double>(first.from_ms + passed_ms_));
  if (first.from_ms + ++passed_ms_ == first.to_ms) {
    end_ = first.cubic.At(1e-3 * static_cast<double>(first.to_ms));
    end_->qdd.setZero();
    increments_.pop_front();
    passed_ms_ = 0;
  }
  return now;
}

}  // namespace tubetwin
