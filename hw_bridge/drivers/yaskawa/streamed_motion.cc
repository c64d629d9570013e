#include "hw_bridge/drivers/yaskawa/streamed_motion.h"

#include <algorithm>

namespace tubetwin {
namespace {

namespace sm = simple_message;

/// Controllers are streamed to every 20 to 40 ms; the fewer points, the slower a link may be.
constexpr int kSpacing_ms = 40;
constexpr double kRetry_s = 0.005;
/// The controller's interpolation period: what CHECK_QUEUE_CNT counts.
constexpr double kIncrement_s = 0.004;
constexpr double kCountEvery_s = 0.1, kCountAtEnd_s = 0.012;
/// A point that was accepted is counted by then.
constexpr double kCutBy_s = 0.010;
/// Joint speed that needs no ramp: the arm stands within a tenth of a degree.
constexpr double kSlow_rad_s = 0.1;
constexpr double kStanding_rad_s = 1e-3;
/// Of the path's own time, over so many counts: what is slower is held back, or its speed limited.
constexpr double kSlowShare = 0.75;
constexpr std::size_t kSlowCounts = 5;

sm::Body Control(sm::Command command) { return sm::MotionControl{0, 0, command, {}}; }

}  // namespace

StreamedMotion::StreamedMotion(const JointTrajectory& trajectory, const JointVector& q_start,
                               const ArmModel& arm, double ahead_s)
    : stream_(trajectory, q_start, kSpacing_ms), arm_(arm), ahead_s_(ahead_s) {
  accepted_.q = q_start;
}

void StreamedMotion::Stop(StopKind kind, const JointVector& qd) {
  const bool slow = qd.cwiseAbs().maxCoeff() <= kSlow_rad_s;
  constexpr int kFirstThatMoves = 1;
  if (kind == StopKind::kFast || slow || sequence_ <= kFirstThatMoves) {
    stopping_ = true;
  } else if (!stopping_) {
    stream_.RampDown(arm_);
  }
}

double StreamedMotion::Executed_s(double now_s) const {
  if (sequence_ < 2) return 0.0;
  return std::clamp(anchor_s_ + (now_s - anchor_at_s_), 0.0, given_s());
}

bool StreamedMotion::CountDue(double now_s) const {
  if (sequence_ < 2) return false;
  if (now_s - counted_at_s_ >= kCountEvery_s) return true;
  const bool run = Executed_s(now_s) >= given_s() && stream_.finished() && !unaccepted_;
  return run && !empty_ && now_s - counted_at_s_ >= kCountAtEnd_s;
}

std::optional<sm::Body> StreamedMotion::Next(double now_s) {
  if (stopping_) {
    if (stop_sent_) return std::nullopt;
    stop_sent_ = true;
    return Control(sm::Command::kStopMotion);
  }
  if (over()) return std::nullopt;
  if (CountDue(now_s)) {
    // No point may come between: a link that is too slow shows by an empty queue.
    if (now_s - accepted_at_s_ < kCutBy_s) return std::nullopt;
    counted_at_s_ = now_s;
    return Control(sm::Command::kCheckQueueCount);
  }
  if (unaccepted_) {
    if (now_s < retry_s_) return std::nullopt;
    return PointMessage();
  }
  if (sequence_ >= 2 && given_s() - Executed_s(now_s) >= ahead_s_) return std::nullopt;
  unaccepted_ = stream_.Next();
  if (!unaccepted_) return std::nullopt;
  return PointMessage();
}

sm::Body StreamedMotion::PointMessage() const {
  sm::JointPoint point;
  point.sequence = sequence_;
  // The controller cuts to whole milliseconds, in single precision: half of one more is kept.
  point.time_s = static_cast<float>(1e-3 * (static_cast<double>(unaccepted_->time_ms) + 0.5));
  point.q_rad = sm::ToSlots(unaccepted_->q);
  point.qd_rad_s = sm::ToSlots(unaccepted_->qd);
  return point;
}

std::optional<StreamedMotion::Problem> StreamedMotion::Take(const sm::Body& request,
                                                            const sm::MotionReply& reply,
                                                            double now_s) {
  if (std::holds_alternative<sm::JointPoint>(request)) return TakePoint(reply, now_s);
  const auto* control = std::get_if<sm::MotionControl>(&request);
  if (control == nullptr) return std::nullopt;
  if (control->command == sm::Command::kStopMotion) {
    if (reply.result == sm::Result::kSuccess) {
      stopped_ = true;
      return std::nullopt;
    }
    return Problem{"the controller does not stop: " + sm::ToString(reply.result) + ", " +
                       sm::SubcodeText(reply.subcode),
                   0};
  }
  if (control->command != sm::Command::kCheckQueueCount || stopping_) return std::nullopt;
  if (reply.result != sm::Result::kSuccess) {
    return Problem{"the controller does not tell its queue: " + sm::ToString(reply.result), 0};
  }
  return TakeCount(reply.subcode, now_s);
}

std::optional<StreamedMotion::Problem> StreamedMotion::TakePoint(const sm::MotionReply& reply,
                                                                 double now_s) {
  if (!unaccepted_ || stopping_) return std::nullopt;
  if (reply.result == sm::Result::kBusy) {
    retry_s_ = now_s + kRetry_s;
    return std::nullopt;
  }
  if (reply.result != sm::Result::kSuccess) {
    return Problem{"the controller refused point " + std::to_string(reply.sequence) + " (" +
                       sm::ToString(reply.result) + "): " + sm::SubcodeText(reply.subcode),
                   reply.result == sm::Result::kNotReady ? reply.subcode : 0};
  }
  // An arm that had run all it was given goes on from now.
  anchor_s_ = Executed_s(now_s);
  anchor_at_s_ = now_s;
  if (sequence_ == 1) counted_at_s_ = now_s;
  accepted_ = *unaccepted_;
  accepted_at_s_ = now_s;
  unaccepted_.reset();
  empty_ = false;
  ++sequence_;
  return std::nullopt;
}

std::optional<StreamedMotion::Problem> StreamedMotion::TakeCount(int count, double now_s) {
  const double executed_s = std::clamp(given_s() - kIncrement_s * count, 0.0, given_s());
  empty_ = count <= 0;
  counts_.push_back({now_s, executed_s});
  if (empty_) counts_.clear();
  if (counts_.size() > kSlowCounts) counts_.pop_front();
  held_back_ = counts_.size() == kSlowCounts && executed_s - counts_.front().executed_s <
                                                    kSlowShare * (now_s - counts_.front().at_s);
  anchor_s_ = executed_s;
  anchor_at_s_ = now_s;
  if (!empty_ || accepted_.qd.cwiseAbs().maxCoeff() < kStanding_rad_s) return std::nullopt;
  return Problem{"the controller ran out of points after point " + std::to_string(sequence_ - 1),
                 0};
}

}  // namespace tubetwin
