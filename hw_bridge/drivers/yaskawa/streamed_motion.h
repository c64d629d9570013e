#pragma once

#include <deque>
#include <optional>
#include <string>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/codecs/simple_message.h"
#include "hw_bridge/drivers/yaskawa/path_stream.h"

namespace tubetwin {

/// The protocol of one motion: which request to send next, and what the controller's answers mean.
/// Knows nothing of sockets; all times are the cell's.
///
/// The controller queues the points that it gets and runs them whatever happens to the client. So
/// only `ahead_s` of the path is sent in advance. The length of the queue is asked for every 0.1 s
/// and estimated in between; while the controller holds the arm back, no more is sent.
class StreamedMotion {
 public:
  /// `arm` must outlive it.
  StreamedMotion(const JointTrajectory& trajectory, const JointVector& q_start, const ArmModel& arm,
                 double ahead_s);

  void Append(const JointTrajectory& continuation) { stream_.Append(continuation); }
  /// `qd`: the arm's present speed. On the path with a ramp behind what was given; an arm that
  /// moves slowly is stopped at once, for it stands before it has left the path.
  void Stop(StopKind kind, const JointVector& qd);

  /// What to send now, given that nothing is unanswered; nothing: wait.
  std::optional<simple_message::Body> Next(double now_s);
  /// STOP_MOTION is due, whatever is unanswered.
  bool StopDue() const { return stopping_ && !stop_sent_; }

  /// An answer that ends the motion with trouble.
  struct Problem {
    std::string text;          ///< "the controller refused point 7: speed (3013)".
    std::int32_t subcode = 0;  ///< Of a controller that is not ready; 0: it is something else.
  };
  std::optional<Problem> Take(const simple_message::Body& request,
                              const simple_message::MotionReply& reply, double now_s);

  /// The controller has no more of it: all was run, or it has stopped.
  bool over() const { return stopped_ || (empty_ && stream_.finished() && !unaccepted_); }
  /// Stop() was called and changes how it ends.
  bool stopped() const { return stopping_ || stream_.ramped(); }
  bool halted() const { return stopped_; }  ///< By STOP_MOTION.
  /// The controller makes the arm wait, or takes much longer than the path does.
  bool held_back() const { return held_back_; }
  const PathStream& stream() const { return stream_; }
  /// Time along the path where the controller is by now.
  double Progress_s(double now_s) const { return stream_.PathTime(Executed_s(now_s)); }
  /// Where it ends: the last point that was accepted.
  const JointVector& q_last() const { return accepted_.q; }

 private:
  simple_message::Body PointMessage() const;
  std::optional<Problem> TakePoint(const simple_message::MotionReply& reply, double now_s);
  std::optional<Problem> TakeCount(int count, double now_s);
  bool CountDue(double now_s) const;
  double given_s() const { return 1e-3 * static_cast<double>(accepted_.time_ms); }
  double Executed_s(double now_s) const;

  PathStream stream_;
  const ArmModel& arm_;
  double ahead_s_;
  std::optional<PathStream::Point> unaccepted_;  ///< Was sent, or waits to be sent again.
  double retry_s_ = 0;
  std::int32_t sequence_ = 0;  ///< Of the next point to be accepted.
  PathStream::Point accepted_;
  double accepted_at_s_ = 0, counted_at_s_ = 0;
  double anchor_s_ = 0, anchor_at_s_ = 0;  ///< The controller was there then.
  struct Count {
    double at_s = 0, executed_s = 0;
  };
  std::deque<Count> counts_;  ///< The newest.
  bool held_back_ = false;
  bool empty_ = false;  ///< The controller has run what it was given.
  bool stopping_ = false, stop_sent_ = false, stopped_ = false;
};

}  // namespace tubetwin
