#include "tests/emulators/arm_rig.h"

#include <array>

#include "hw_bridge/codecs/little_endian.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {

namespace sm = simple_message;

ArmEmulatorConfig ArmRig::Loopback() {
  ArmEmulatorConfig config;
  config.motion_port = config.state_port = config.io_port = config.hses_port = 0;
  config.servo_on = true;
  return config;
}

ArmRig::ArmRig(ArmEmulatorConfig config) : emulator(io, arm, PaperCell().arm, config) {
  JointVector q;
  q << 0.1, 0.4, 1.5, 0.0, 0.25, 0.0;
  arm.Place(q);
}

void ArmRig::Run(int periods) {
  for (int i = 0; i < periods; ++i) {
    io.poll();
    arm.Advance();
    now += kControlPeriod;
    emulator.Tick(now);
  }
  io.poll();
}

ArmRig::Socket::Socket(ArmRig& rig, int port) : rig_(rig), socket_(rig.io) {
  socket_.connect({asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(port)});
  socket_.set_option(asio::ip::tcp::no_delay(true));
  socket_.non_blocking(true);
  rig_.Run(2);
}

void ArmRig::Socket::Send(const std::string& bytes) {
  asio::error_code ignored;  // A controller may have closed.
  asio::write(socket_, asio::buffer(bytes), ignored);
}

void ArmRig::Socket::Pull() {
  std::array<char, 4096> buffer{};
  for (;;) {
    asio::error_code error;
    const std::size_t n = socket_.read_some(asio::buffer(buffer), error);
    received_.append(buffer.data(), n);
    if (error && error != asio::error::would_block) closed_ = true;
    if (error) return;
  }
}

std::string ArmRig::Socket::Receive(std::size_t size, int periods) {
  for (int i = 0; i < periods && received_.size() < size && !closed_; ++i) {
    rig_.Run(1);
    Pull();
  }
  const std::string out = received_.substr(0, size);
  received_.erase(0, size);
  return out;
}

std::string ArmRig::Socket::Collect(int periods) {
  for (int i = 0; i < periods; ++i) {
    rig_.Run(1);
    Pull();
  }
  return std::exchange(received_, {});
}

bool ArmRig::Socket::closed() {
  for (int i = 0; i < 50 && !closed_; ++i) {
    rig_.Run(1);
    Pull();
  }
  return closed_;
}

sm::Message ArmRig::Socket::Ask(const sm::Message& request) {
  Send(sm::Encode(request));
  std::string reply = Receive(sm::kHeadSize);
  REQUIRE(reply.size() == sm::kHeadSize);
  reply += Receive(4 + Le32At(reply, 0) - sm::kHeadSize);
  const auto decoded = sm::DecodeFront(reply, true);
  REQUIRE(std::holds_alternative<sm::Message>(decoded));
  return std::get<sm::Message>(decoded);
}

std::string ArmRig::AskHses(const std::string& datagram) {
  asio::ip::udp::socket socket(io, {asio::ip::make_address("127.0.0.1"), 0});
  socket.non_blocking(true);
  socket.send_to(asio::buffer(datagram), {asio::ip::make_address("127.0.0.1"),
                                          static_cast<std::uint16_t>(emulator.hses_port())});
  std::array<char, 2048> buffer{};
  for (int i = 0; i < 50; ++i) {
    Run(1);
    asio::error_code error;
    asio::ip::udp::endpoint from;
    const std::size_t n = socket.receive_from(asio::buffer(buffer), from, 0, error);
    if (!error) return std::string(buffer.data(), n);
  }
  return {};
}

sm::MotionReply Command(ArmRig::Socket& motion, sm::Command command) {
  const sm::Message reply = motion.Ask(sm::Request(sm::MotionControl{0, 0, command, {}}));
  CHECK(reply.comm == sm::Comm::kReply);
  CHECK(reply.reply == sm::ReplyCode::kSuccess);
  return std::get<sm::MotionReply>(reply.body);
}

sm::MotionReply SendPoint(ArmRig::Socket& motion, std::int32_t sequence, double time_s,
                          const JointVector& q, const JointVector& qd) {
  sm::JointPoint point;
  point.sequence = sequence;
  point.time_s = static_cast<float>(time_s);
  point.q_rad = sm::ToSlots(q);
  point.qd_rad_s = sm::ToSlots(qd);
  return std::get<sm::MotionReply>(motion.Ask(sm::Request(point)).body);
}

void Ready(ArmRig::Socket& motion) {
  REQUIRE(Command(motion, sm::Command::kStartTrajectoryMode).result == sm::Result::kSuccess);
}

sm::MotionReply Stream(ArmRig::Socket& motion, std::int32_t sequence, double time_s,
                       const JointVector& q, const JointVector& qd) {
  sm::MotionReply reply;
  do {
    reply = SendPoint(motion, sequence, time_s, q, qd);
  } while (reply.result == sm::Result::kBusy);
  return reply;
}

}  // namespace tubetwin::test
