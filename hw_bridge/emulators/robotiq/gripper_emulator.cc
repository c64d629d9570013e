#include "hw_bridge/emulators/robotiq/gripper_emulator.h"

#include <utility>

#include "models/base/error.h"

namespace tubetwin {
namespace {

const char* const kWho = "emulated gripper";
constexpr int kMaxRequests = 16;  // Of a client, per control period.
/// A frame ends by silence, 3.5 characters on a wire; programs that share a machine pause longer.
constexpr TimeNs kEndOfFrame = std::chrono::milliseconds(50);

}  // namespace

GripperEmulator::GripperEmulator(asio::io_context& io, Gripper& gripper,
                                 const GripperEmulatorConfig& config)
    : controller_(gripper, config.scale, config.action_start, config.status_start),
      slave_(
          config.transport == "rtu" ? ModbusSlave::Transport::kRtu : ModbusSlave::Transport::kTcp,
          config.slave) {
  if (config.transport == "rtu") {
    rtu_ = std::make_unique<SerialPty>(kWho, config.device);
  } else {
    tcp_ = std::make_unique<TcpPort>(io, kWho, config.listen, config.port);
  }
}

GripperEmulator::~GripperEmulator() = default;

int GripperEmulator::port() const {
  TT_CHECK(tcp_ != nullptr);
  return tcp_->port();
}

std::string GripperEmulator::device() const {
  TT_CHECK(rtu_ != nullptr);
  return rtu_->path();
}

void GripperEmulator::Tick(TimeNs now) {
  if (link_.freeze) return;
  if (tcp_) ServeTcp(now);
  if (rtu_) ServeRtu(now);
  controller_.Tick(now);
}

void GripperEmulator::ServeTcp(TimeNs now) {
  tcp_->Poll(now, [&](std::uint64_t client, std::string& received) {
    return Answer(now, client, received) ? TcpPort::Verdict::kKeep : TcpPort::Verdict::kClose;
  });
  send_queue_.Deliver(
      now, [this](std::uint64_t client, const std::string& answer) { tcp_->Send(client, answer); });
}

void GripperEmulator::ServeRtu(TimeNs now) {
  const std::string bytes = rtu_->Read();
  if (!bytes.empty()) {
    rtu_received_ += bytes;
    rtu_heard_ = now;
    Answer(now, 0, rtu_received_);
  } else if (now - rtu_heard_ > kEndOfFrame) {
    rtu_received_.clear();
  }
  send_queue_.Deliver(now,
                      [this](std::uint64_t, const std::string& answer) { rtu_->Write(answer); });
}

bool GripperEmulator::Answer(TimeNs now, std::uint64_t client, std::string& received) {
  if (link_.drop) {
    received.clear();
    return true;
  }
  for (int i = 0; i < kMaxRequests && !received.empty(); ++i) {
    std::string answer;
    switch (slave_.Take(received, controller_, answer)) {
      case ModbusSlave::Found::kRequest:
        ++requests_;
        controller_.Heard(now);
        if (!answer.empty()) send_queue_.Put(link_, now, client, std::move(answer));
        break;
      case ModbusSlave::Found::kNothing:
      case ModbusSlave::Found::kIgnored:
        return true;
      case ModbusSlave::Found::kGarbage:
        return false;
    }
  }
  return true;
}

}  // namespace tubetwin
