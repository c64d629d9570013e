#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "hw_bridge/emulators/link_faults.h"
#include "models/base/time.h"

namespace asio {
class io_context;
}

namespace tubetwin {

/// One UDP port that answers datagrams, with the link's faults. Everything happens on the thread
/// that runs the io_context.
class UdpServer {
 public:
  /// The answer to one datagram; nothing: none is sent.
  using Answer = std::function<std::optional<std::string>(std::string_view datagram)>;
  /// Port 0: any free one. Throws Error(kDevice) when the port is taken or the address is none of
  /// this machine.
  UdpServer(asio::io_context& io, const std::string& who, const std::string& listen, int port,
            Answer answer);
  ~UdpServer();

  int port() const;
  /// After every control period: what was delayed and is due goes out.
  void Tick(TimeNs now);
  LinkFaults& faults();

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace tubetwin
