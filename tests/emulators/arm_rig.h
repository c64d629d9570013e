#pragma once

#include <asio.hpp>
#include <string>

#include "hw_bridge/emulators/yaskawa/arm_emulator.h"
#include "tests/emulators/fake_servo_arm.h"

namespace tubetwin::test {

/// An emulated controller over drives without inertia and raw sockets of a client, all on one
/// thread: nothing here depends on the wall's time.
class ArmRig {
 public:
  explicit ArmRig(ArmEmulatorConfig config = Loopback());
  /// Free ports on loopback, drives powered.
  static ArmEmulatorConfig Loopback();

  asio::io_context io;
  FakeServoArm arm;
  ArmEmulator emulator;
  TimeNs now{0};

  /// Control periods of the cell, with the network's events before each.
  void Run(int periods);

  class Socket {
   public:
    Socket(ArmRig& rig, int port);
    void Send(const std::string& bytes);
    /// Bytes that came, once `size` of them are there or after 2000 periods, which is enough for
    /// all that the controller waits for.
    std::string Receive(std::size_t size, int periods = 2000);
    /// All that comes within so many periods.
    std::string Collect(int periods);
    bool closed();
    void Close() { socket_.close(); }

    /// Sends, and receives one message of the reply's size.
    simple_message::Message Ask(const simple_message::Message& request);

   private:
    void Pull();
    ArmRig& rig_;
    asio::ip::tcp::socket socket_;
    std::string received_;
    bool closed_ = false;
  };
  Socket Motion() { return Socket(*this, emulator.motion_port()); }
  Socket State() { return Socket(*this, emulator.state_port()); }
  Socket Io() { return Socket(*this, emulator.io_port()); }

  /// One datagram to the supervision port, and the answer; empty when none comes.
  std::string AskHses(const std::string& datagram);
};

/// A motion request and its reply, whole.
simple_message::MotionReply Command(ArmRig::Socket& motion, simple_message::Command command);
simple_message::MotionReply SendPoint(ArmRig::Socket& motion, std::int32_t sequence, double time_s,
                                      const JointVector& q,
                                      const JointVector& qd = JointVector::Zero());

/// As a reply's subcode says it.
inline std::int32_t Code(simple_message::Invalid why) { return static_cast<std::int32_t>(why); }
inline std::int32_t Code(simple_message::NotReady why) { return static_cast<std::int32_t>(why); }

/// Starts the job that waits for motion; it must.
void Ready(ArmRig::Socket& motion);
/// Sends a point again as long as the controller is busy, as clients do.
simple_message::MotionReply Stream(ArmRig::Socket& motion, std::int32_t sequence, double time_s,
                                   const JointVector& q,
                                   const JointVector& qd = JointVector::Zero());

inline const JointVector kOnes = JointVector::Ones();

}  // namespace tubetwin::test
