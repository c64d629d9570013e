#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hw_bridge/emulators/emulator.h"
#include "hw_bridge/emulators/link_faults.h"
#include "hw_bridge/emulators/robotiq/gripper_controller.h"
#include "hw_bridge/emulators/robotiq/modbus_slave.h"
#include "hw_bridge/emulators/robotiq/serial_pty.h"
#include "hw_bridge/emulators/send_queue.h"
#include "hw_bridge/emulators/tcp_port.h"

namespace tubetwin {

struct GripperEmulatorConfig {
  std::string transport = "tcp";  ///< "tcp" or "rtu".
  std::string listen = "127.0.0.1";
  int port = 1502;     ///< tcp; 0: any free port.
  std::string device;  ///< rtu: link to the pseudo-terminal that is made; empty: no link.
  int slave = 9;
  int action_start = kGripperActionStart, status_start = kGripperStatusStart;
  GripperScale scale;  ///< What its registers mean.
};

/// A Robotiq 2F gripper on Modbus TCP, or on Modbus RTU over a pseudo-terminal, with the fingers of
/// any Gripper. Everything happens in Tick().
class GripperEmulator : public Emulator {
 public:
  /// `gripper` and `io` must outlive it. Throws Error(kDevice) when the port or the device's name
  /// cannot be had.
  GripperEmulator(asio::io_context& io, Gripper& gripper, const GripperEmulatorConfig& config);
  ~GripperEmulator() override;

  void Tick(TimeNs now) override;

  int port() const;                                     ///< tcp.
  std::string device() const;                           ///< rtu: what a client opens.
  std::uint64_t requests() const { return requests_; }  ///< Answered so far, exceptions included.

  // What fault scripts do.
  LinkFaults& link() { return link_; }
  GripperController& controller() { return controller_; }

 private:
  void ServeTcp(TimeNs now);
  void ServeRtu(TimeNs now);
  /// Answers what `received` begins with, 16 requests at most; false: no request can begin so.
  bool Answer(TimeNs now, std::uint64_t client, std::string& received);

  GripperController controller_;
  ModbusSlave slave_;
  LinkFaults link_;
  SendQueue send_queue_;
  std::unique_ptr<TcpPort> tcp_;
  std::unique_ptr<SerialPty> rtu_;
  std::string rtu_received_;
  TimeNs rtu_heard_{0};
  std::uint64_t requests_ = 0;
};

}  // namespace tubetwin
