#pragma once

#include <chrono>
#include <memory>
#include <string>

namespace tubetwin {

/// The event loop of a driver's I/O thread.
class NetLoop {
 public:
  NetLoop();
  ~NetLoop();
  /// Returns when something came in, Wake() was called, or the time is over.
  void Wait(std::chrono::nanoseconds max_wait);
  void Wake();  ///< From any thread.

 private:
  friend class TcpClient;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One connection to a controller. I/O thread only.
class TcpClient {
 public:
  /// `loop` must outlive it. `who`: "arm (motion)", named in problems with host and port.
  TcpClient(NetLoop& loop, const std::string& who, const std::string& host, int port);
  ~TcpClient();

  /// Throws Error(kDevice) naming who, host:port and why when there is no connection by then.
  void Connect(std::chrono::steady_clock::time_point deadline);
  bool open() const;
  /// Why it is no longer open: "connection closed by the controller".
  const std::string& problem() const;
  /// In one piece; a failure closes the connection.
  void Send(const std::string& bytes);
  std::string TakeReceived();
  void Close(const std::string& why);
  const std::string& name() const;  ///< "arm (motion) at 127.0.0.1:50240".

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace tubetwin
