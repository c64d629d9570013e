#pragma once

#include <deque>
#include <string>
#include <vector>

#include "hw_bridge/codecs/simple_message.h"
#include "hw_bridge/drivers/yaskawa/tcp_client.h"

namespace tubetwin {

/// The motion port: requests, each with one answer, in their order. I/O thread only.
class MotionLink {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `loop` must outlive it.
  MotionLink(NetLoop& loop, const std::string& host, int port);

  /// As TcpClient::Connect.
  void Connect(Time deadline);
  bool open() const { return client_.open(); }

  /// An answer that is not there at `due` ends the link. `request`: JointPoint, MotionControl (its
  /// sequence is set here) or Ping.
  void Send(simple_message::Body request, Time due);
  /// Requests without an answer.
  bool waiting() const { return !unanswered_.empty(); }
  /// Moves all deadlines by the time in which this process was not running and could not listen.
  void Forgive(std::chrono::nanoseconds slept) {
    for (Unanswered& one : unanswered_) one.due += slept;
  }

  struct Answer {
    simple_message::Body request;
    simple_message::MotionReply reply;  ///< A success, for a Ping.
  };
  /// The answers that have arrived. One that does not answer the oldest open request is dropped:
  /// links may repeat messages.
  std::vector<Answer> Take();

  /// Why there are no more answers; empty: there may be.
  const std::string& problem() const { return client_.problem(); }
  const std::string& name() const { return client_.name(); }

 private:
  struct Unanswered {
    simple_message::Body request;
    Time due;
  };
  TcpClient client_;
  simple_message::StreamReader reader_;
  std::deque<Unanswered> unanswered_;
  std::int32_t sequence_ = 0;
};

/// "START_TRAJ_MODE", "point 12", for messages.
std::string NameOf(const simple_message::Body& request);

}  // namespace tubetwin
