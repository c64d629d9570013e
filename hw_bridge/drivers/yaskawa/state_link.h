#pragma once

#include <optional>
#include <string>

#include "hw_bridge/codecs/simple_message.h"
#include "hw_bridge/drivers/yaskawa/tcp_client.h"

namespace tubetwin {

/// The state port: joint feedback and robot status as the controller pushes them, every 25 ms or
/// so. I/O thread only.
class StateLink {
 public:
  /// `loop` must outlive it.
  StateLink(NetLoop& loop, const std::string& host, int port);

  /// As TcpClient::Connect.
  void Connect(std::chrono::steady_clock::time_point deadline);

  struct News {
    std::optional<simple_message::JointFeedback> feedback;  ///< The newest, with usable numbers.
    std::optional<simple_message::RobotStatus> status;      ///< The newest.
  };
  News Take();

  /// Why nothing more can come; empty: it can.
  const std::string& problem() const;
  /// Since the last feedback, or the connection.
  std::chrono::nanoseconds Silence() const { return std::chrono::steady_clock::now() - heard_; }
  /// Takes time off the silence in which this process was not running and could not listen.
  void Forgive(std::chrono::nanoseconds slept) { heard_ += slept; }
  const std::string& name() const { return client_.name(); }

 private:
  TcpClient client_;
  simple_message::StreamReader reader_;
  std::chrono::steady_clock::time_point heard_{};
};

}  // namespace tubetwin
