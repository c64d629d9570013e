#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "hw_bridge/emulators/link_faults.h"
#include "models/base/time.h"

namespace asio {
class io_context;
}

namespace tubetwin {

/// One listening TCP port of an emulated controller and its clients, with the link's faults.
/// Everything happens on the thread that runs the io_context. Buffers are bounded, and so is what
/// is accepted and received each period: no client can keep the others waiting. One that has not
/// read what was sent to it for 2 s is closed.
class TcpServer {
 public:
  using Client = std::uint64_t;
  enum class Admission { kAdd, kReplace, kRefuse };
  struct Callbacks {
    /// What to do with a newcomer, given how many are connected. kReplace closes the others.
    std::function<Admission(int clients)> admit;
    std::function<void(Client)> joined;
    /// What one receive gave, as the controller's own receive would.
    std::function<void(Client, std::string_view)> received;
    std::function<void(Client)> left;
  };
  /// Listens at once; port 0: any free one. `who` names the port in errors. Throws Error(kDevice)
  /// when the port is taken or the address is none of this machine.
  TcpServer(asio::io_context& io, const std::string& who, const std::string& listen, int port,
            Callbacks callbacks);
  /// Closes everything; no callback is called afterwards.
  ~TcpServer();

  int port() const;
  int clients() const;

  /// A whole message, with the link's faults.
  void Send(Client client, const std::string& message);
  void SendAll(const std::string& message);
  /// From here on nothing is received from the client, until it is resumed.
  void Pause(Client client, bool pause);
  /// After what was sent so far. `left` is called.
  void Close(Client client);
  /// At once. `left` is called.
  void Cut(Client client);
  void CloseAll();

  /// After every control period: what was delayed and is due goes out, what a freeze held back
  /// comes in.
  void Tick(TimeNs now);

  LinkFaults& faults();

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace tubetwin
