#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <string>

#include "hw_bridge/emulators/emulator.h"
#include "hw_bridge/emulators/tcp_server.h"
#include "hw_bridge/emulators/udp_server.h"
#include "hw_bridge/emulators/yaskawa/arm_controller.h"
#include "hw_bridge/emulators/yaskawa/hses_responder.h"

namespace tubetwin {

/// Where the emulated controller listens. Port 0: any free one.
struct ArmEmulatorConfig {
  std::string listen = "127.0.0.1";
  int motion_port = 50240;
  int state_port = 50241;
  int io_port = 50242;
  int hses_port = 10040;  ///< Files are refused on the next one.
  double pulses_per_degree = 1000;
  double state_period_s = 0.025;
  double servo_on_s = 0.2;
  bool servo_on = false;  ///< Drives are powered at the start.
  ArmServer server = ArmServer::kMotoRos1;
};

/// A YRC1000 with MotoROS 1 and High-Speed Ethernet Server over the drives of a cell's arm: one
/// motion client, four state clients, one I/O client; what it accepts and refuses is that of the
/// controller. Where all places are taken, a newcomer gets the first one, unless a motion waits.
/// Files are refused. One thread, that of the io_context.
class ArmEmulator : public Emulator {
 public:
  /// Listens at once. `io`, `arm` and `model` must outlive it. Throws Error(kDevice) when a port is
  /// taken.
  ArmEmulator(asio::io_context& io, ServoArm& arm, const ArmModel& model,
              const ArmEmulatorConfig& config);

  void Tick(TimeNs now) override;

  int motion_port() const { return motion_.port(); }
  int state_port() const { return state_.port(); }
  int io_port() const { return io_.port(); }
  int hses_port() const { return hses_.port(); }
  int hses_file_port() const { return hses_files_.port(); }

  // What fault scripts do.
  void ProtectiveStop() { controller_.ProtectiveStop(); }
  void EmergencyStop() { controller_.EmergencyStop(); }
  void ReleaseEmergencyStop() { controller_.ReleaseEmergencyStop(); }
  /// `lasting`: cannot be reset until ClearAlarmCause().
  void Alarm(std::int32_t code, bool lasting = false) { controller_.RaiseAlarm(code, lasting); }
  void ClearAlarmCause() { controller_.ClearAlarmCause(); }
  void Hold(bool on) { controller_.SetHold(on); }
  void SetRemote(bool remote) { controller_.SetRemote(remote); }
  void SetPlay(bool play) { controller_.SetPlay(play); }
  void SwitchServo(bool on) { controller_.SwitchServo(on); }
  /// The next `count` points are refused with that subcode (3011, 5007...).
  void Refuse(std::int32_t subcode, int count);
  LinkFaults& motion_link() { return motion_.faults(); }
  LinkFaults& state_link() { return state_.faults(); }
  LinkFaults& io_link() { return io_.faults(); }
  LinkFaults& hses_link() { return hses_.faults(); }
  /// Cuts the clients' connections.
  void CloseMotion() { motion_.CloseAll(); }
  void CloseState() { state_.CloseAll(); }

  ArmController& controller() { return controller_; }
  /// Bytes that came on the motion port so far.
  std::uint64_t motion_bytes() const { return motion_bytes_; }
  int motion_clients() const { return motion_.clients(); }
  int state_clients() const { return state_.clients(); }

 private:
  using Client = TcpServer::Client;
  TcpServer::Admission AdmitMotion(int clients);
  void JoinMotion(Client client);
  void LeaveMotion(Client client);
  TcpServer::Admission AdmitState();
  void JoinState(Client client);
  void LeaveState(Client client);
  /// `to_reply`: what is answered came as an answer itself, and gets none.
  void AnswerMotion(const std::string& answer, bool to_reply);
  void ReceiveMotion(Client client, std::string_view bytes);
  void HandleMotion();
  void ReceiveIo(Client client, std::string_view bytes);
  std::optional<std::string> AnswerHses(std::string_view datagram);
  static std::optional<std::string> RefuseFile(std::string_view datagram);

  ArmEmulatorConfig config_;
  ArmController controller_;
  HsesResponder responder_;
  std::string unhandled_;  ///< Of the motion client: what came behind a request that takes time.
  std::string last_motion_answer_;
  Client motion_client_ = 0;
  std::array<Client, 4> state_slots_{};  ///< 0: free.
  bool late_to_reply_ = false;
  bool replacing_ = false;  ///< Who leaves now makes room for somebody else.
  std::uint64_t motion_bytes_ = 0;
  TimeNs next_state_{0};
  TcpServer motion_, state_, io_;
  UdpServer hses_, hses_files_;
};

}  // namespace tubetwin
