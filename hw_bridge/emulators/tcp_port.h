#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "models/base/time.h"

namespace asio {
class io_context;
}

namespace tubetwin {

/// A listening TCP port that is polled once per control period and never blocks. It holds 8
/// connections; for one more, the one that has gone longest without a whole message (at least 1 s,
/// whatever trickles in) is closed, or else the new one. A client that sends too many bytes without
/// a whole message, or does not read what is sent to it, is disconnected.
class TcpPort {
 public:
  /// `port` 0: any free one. Throws Error(kDevice) naming `who` (device), address and reason when
  /// the port cannot be had.
  TcpPort(asio::io_context& io, const std::string& who, const std::string& listen, int port);
  ~TcpPort();

  int port() const;
  int clients() const;

  enum class Verdict { kKeep, kClose };
  /// Removes the messages that it understands from the begin of `received`; kClose for what can be
  /// none.
  using Take = std::function<Verdict(std::uint64_t client, std::string& received)>;
  /// Accepts connections, reads, sends what is left to send.
  void Poll(TimeNs now, const Take& take);
  /// Nothing happens when that client is gone.
  void Send(std::uint64_t client, std::string_view bytes);
  /// Closes once all is sent.
  void Finish(std::uint64_t client);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
