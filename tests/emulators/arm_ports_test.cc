// The emulated controller's state, I/O and supervision ports, and what can befall its links.

#include <atomic>
#include <thread>

#include "models/base/error.h"
#include "models/base/random.h"
#include "tests/codecs/hex.h"
#include "tests/emulators/arm_rig.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

namespace sm = simple_message;

constexpr std::size_t kFeedback = 148, kStatus = 44, kState = kFeedback + kStatus;

std::vector<sm::Message> Messages(const std::string& bytes) {
  sm::StreamReader reader;
  reader.Append(bytes);
  std::vector<sm::Message> out;
  while (auto next = reader.Next()) {
    REQUIRE(std::holds_alternative<sm::Message>(*next));
    out.push_back(std::get<sm::Message>(*next));
  }
  return out;
}

void Ready(ArmRig& rig) {
  ArmRig::Socket motion = rig.Motion();
  REQUIRE(Command(motion, sm::Command::kStartTrajectoryMode).result == sm::Result::kSuccess);
}

}  // namespace

TEST_CASE("the state port pushes position and status every 25 ms to four clients", "[unit]") {
  ArmRig rig;
  Ready(rig);
  JointVector q;
  q << 0.1, -0.2, 1.5, 0, 0.25, 0;
  rig.arm.Place(q);
  ArmRig::Socket first = rig.State();
  ArmRig::Socket b = rig.State(), c = rig.State(), d = rig.State();
  // A fifth one gets the first one's place.
  ArmRig::Socket a = rig.State();
  CHECK(first.closed());
  CHECK(rig.emulator.state_clients() == 4);
  for (ArmRig::Socket* socket : {&b, &c, &d}) CHECK(socket->Receive(kState).size() == kState);
  a.Collect(30);
  const std::string bytes = a.Collect(1000);
  CHECK(bytes.size() == 40 * kState);
  CHECK(ToHex(bytes.substr(0, kFeedback)) ==
        ToHex(FromHex("90000000 0f000000 01000000 00000000 00000000 06000000 00000000 cdcccc3d "
                      "cdcc4cbe 0000c03f 00000000 0000803e 00*100")));
  CHECK(ToHex(bytes.substr(kFeedback, kStatus)) ==
        ToHex(FromHex("28000000 0d000000 01000000 00000000 01000000 00000000 00000000 00000000 "
                      "00000000 02000000 01000000")));
  rig.emulator.Alarm(4315);
  const auto messages = Messages(a.Collect(50));
  const auto status = std::get<sm::RobotStatus>(messages.back().body);
  CHECK(status == sm::RobotStatus{0, 0, 4315, 1, 0, sm::RobotStatus::kPlay, 0});
}

TEST_CASE("bits, groups and registers are read and written by the controller's addresses",
          "[unit]") {
  ArmRig rig;
  ArmRig::Socket io = rig.Io();
  io.Send(FromHex("14000000 d5070000 02000000 00000000 1a270000 01000000"));
  CHECK(ToHex(io.Receive(20)) == ToHex(FromHex("10000000 d6070000 03000000 01000000 00000000")));
  const auto ask = [&](const sm::Body& body) { return io.Ask(sm::Request(body)).body; };
  CHECK(ask(sm::ReadBit{10010}) == sm::Body(sm::ReadBitReply{1, 0}));
  CHECK(ask(sm::ReadGroup{1001}) == sm::Body(sm::ReadGroupReply{1, 0}));
  CHECK(ask(sm::WriteGroup{1001, 0x82}) == sm::Body(sm::WriteGroupReply{0}));
  CHECK(ask(sm::ReadBit{10010}) == sm::Body(sm::ReadBitReply{0, 0}));
  CHECK(ask(sm::ReadBit{10011}) == sm::Body(sm::ReadBitReply{1, 0}));
  CHECK(ask(sm::ReadBit{10017}) == sm::Body(sm::ReadBitReply{1, 0}));
  CHECK(ask(sm::ReadBit{10018}) == sm::Body(sm::ReadBitReply{0, sm::kIoReadAddress}));
  CHECK(ask(sm::ReadBit{5130}) == sm::Body(sm::ReadBitReply{0, sm::kIoReadAddress}));
  CHECK(ask(sm::ReadBit{-10}) == sm::Body(sm::ReadBitReply{0, sm::kIoReadAddress}));
  CHECK(ask(sm::WriteBit{20010, 1}) == sm::Body(sm::WriteBitReply{sm::kIoWriteAddress}));
  CHECK(ask(sm::WriteBit{10010, 2}) == sm::Body(sm::WriteBitReply{sm::kIoWriteValue}));
  CHECK(ask(sm::WriteGroup{1001, 256}) == sm::Body(sm::WriteGroupReply{sm::kIoWriteValue}));
  CHECK(ask(sm::WriteRegister{1000007, 65535}) == sm::Body(sm::WriteRegisterReply{0}));
  CHECK(ask(sm::ReadRegister{1000007}) == sm::Body(sm::ReadRegisterReply{65535, 0}));
  CHECK(ask(sm::WriteRegister{1000560, 1}) ==
        sm::Body(sm::WriteRegisterReply{sm::kIoWriteAddress}));
  CHECK(ask(sm::ReadRegister{1001000}) == sm::Body(sm::ReadRegisterReply{0, sm::kIoReadAddress}));
  // OUT#893 tells that a motion client is there, OUT#895 that this one is.
  constexpr int kOut893 = 11124, kOut895 = 11126;
  CHECK(ask(sm::ReadBit{kOut895}) == sm::Body(sm::ReadBitReply{1, 0}));
  CHECK(ask(sm::ReadBit{kOut893}) == sm::Body(sm::ReadBitReply{0, 0}));
  const ArmRig::Socket motion = rig.Motion();
  CHECK(ask(sm::ReadBit{kOut893}) == sm::Body(sm::ReadBitReply{1, 0}));
}

TEST_CASE("errors of the I/O port come in a motion reply's first two words", "[unit]") {
  ArmRig rig;
  ArmRig::Socket io = rig.Io();
  io.Send(std::string(10, 'x'));
  CHECK(ToHex(io.Receive(76)) ==
        ToHex(FromHex("48000000 d2070000 03000000 01000000 03000000 b90b0000 00*52")));
  CHECK(std::get<sm::MotionReply>(io.Ask(sm::Request(sm::Ping{})).body).sequence ==
        static_cast<std::int32_t>(sm::Invalid::kMessageType));
  ArmRig::Socket newcomer = rig.Io();
  CHECK(io.closed());
  CHECK(newcomer.Ask(sm::Request(sm::ReadBit{10010})).body == sm::Body(sm::ReadBitReply{0, 0}));
}

TEST_CASE("the supervision port answers the documented bytes", "[unit]") {
  ArmRig rig;
  const auto ask = [&](const std::string& hex) { return ToHex(rig.AskHses(FromHex(hex))); };
  const auto hex = [](const std::string& text) { return ToHex(FromHex(text)); };
  const std::string head = "59455243 2000 ", tail = " 00000000 3939393939393939 ",
                    answered = " 00000080 3939393939393939 ";
  CHECK(ask(head + "0000 03 01 00 01" + tail + "7200 0100 00 01 0000") ==
        hex(head + "0800 03 01 01 01" + answered + "81 00 00 00 0000 0000 c4000000 40000000"));
  CHECK(ask(head + "0400 03 01 00 04" + tail + "8300 0200 01 10 0000 01000000") ==
        hex(head + "0000 03 01 01 04" + answered + "90 00 00 00 0000 0000"));
  rig.emulator.SetRemote(false);
  CHECK(ask(head + "0400 03 01 00 05" + tail + "8300 0200 01 10 0000 01000000") ==
        hex(head + "0000 03 01 01 05" + answered + "90 1f 01 00 0021 0000"));
  rig.emulator.SetRemote(true);
  CHECK(rig.AskHses("no datagram of this protocol").empty());
}

// Long function: one request and its answer for each row of the protocol's table.
TEST_CASE("supervision reads alarms, positions and variables, and switches servo, hold and job",
          "[unit]") {
  ArmRig rig;
  std::uint8_t id = 0;
  const auto ask = [&](std::uint16_t command, std::uint16_t instance, std::uint8_t attribute,
                       std::uint8_t service, const std::string& data = {}) {
    const std::string bytes = rig.AskHses(hses::Encode(hses::Request{
        hses::Division::kRobot, 0, ++id, 0, command, instance, attribute, service, data}));
    const auto decoded = hses::DecodeAnswer(bytes);
    REQUIRE(std::holds_alternative<hses::Answer>(decoded));
    const hses::Answer answer = std::get<hses::Answer>(decoded);
    CHECK(answer.id == id);
    CHECK(answer.service == service);
    return answer;
  };
  const auto status = [&] {
    return std::get<hses::Status>(hses::DecodeStatus(ask(hses::kStatus, 1, 0, hses::kGetAll).data));
  };
  JointVector q;
  q << Radians(10.0), Radians(20.0), Radians(100.0), Radians(30.0), Radians(-40.0), Radians(50.0);
  rig.arm.Place(q);
  const auto pulses = std::get<hses::Position>(
      hses::DecodePosition(ask(hses::kPosition, hses::kPulses, 0, hses::kGetAll).data));
  CHECK(pulses.axes == std::array<std::int32_t, 8>{10000, 20000, 100000, 30000, -40000, 50000});
  // The vendor's table: p less the shoulder's 0.275 m, R = Rz Ry Rx.
  const auto place = std::get<hses::Position>(
      hses::DecodePosition(ask(hses::kPosition, hses::kCartesian, 0, hses::kGetAll).data));
  CHECK(std::abs(place.axes[0] - 773949) <= 1);
  CHECK(std::abs(place.axes[1] - 236503) <= 1);
  CHECK(std::abs(place.axes[2] - (677631 - 275000)) <= 1);
  const Matrix3 R = RotZ(Radians(1e-4 * place.axes[5])) * RotY(Radians(1e-4 * place.axes[4])) *
                    RotX(Radians(1e-4 * place.axes[3]));
  CHECK((R - FlangePose(PaperCell().arm, q).linear()).cwiseAbs().maxCoeff() < 1e-5);

  CHECK(ask(hses::kStartJob, 1, 1, hses::kSetOne, hses::Word(1)).status == hses::kOk);
  CHECK((status().data1 & hses::Status::kRunning) != 0);
  CHECK(ask(hses::kPower, hses::kHold, 1, hses::kSetOne, hses::Word(hses::kOn)).status ==
        hses::kOk);
  CHECK((status().data2 & hses::Status::kCommandHold) != 0);
  CHECK(ask(hses::kStartJob, 1, 1, hses::kSetOne, hses::Word(1)).added_status ==
        hses::kHeldByCommand);
  ask(hses::kPower, hses::kHold, 1, hses::kSetOne, hses::Word(hses::kOff));
  rig.emulator.Alarm(4315);
  const auto alarm =
      std::get<hses::Alarm>(hses::DecodeAlarm(ask(hses::kAlarm, 1, 0, hses::kGetAll).data));
  CHECK(alarm.code == 4315);
  CHECK((status().data2 & hses::Status::kAlarm) != 0);
  CHECK(ask(hses::kPower, hses::kServo, 1, hses::kSetOne, hses::Word(hses::kOn)).added_status ==
        hses::kServoFails);
  CHECK(ask(hses::kReset, 1, 1, hses::kSetOne, hses::Word(1)).status == hses::kOk);
  CHECK(ask(hses::kPower, hses::kServo, 1, hses::kSetOne, hses::Word(hses::kOn)).status ==
        hses::kOk);
  rig.Run(250);
  CHECK(status().data2 == hses::Status::kServoOn);

  CHECK(ask(hses::kVariableB, 0, 1, hses::kSetOne, std::string(1, 5)).status == hses::kOk);
  CHECK(ask(hses::kVariableB, 0, 1, hses::kGetOne).data == std::string(1, 5));
  CHECK(ask(hses::kVariableR, 3, 1, hses::kGetOne).data == std::string(4, '\0'));
  CHECK(ask(hses::kVariableD, 1, 1, hses::kSetOne, "abc").added_status == hses::kDataSize);
  CHECK(ask(hses::kVariableD, 100, 1, hses::kGetOne).added_status == hses::kNoInstance);
  CHECK(ask(hses::kSelectJob, 1, 0, hses::kSetAll, hses::JobSelection("NO_JOB", 0)).added_status ==
        hses::kNoSuchJob);
  CHECK(ask(hses::kMovePulse, 1, 1, hses::kSetAll, std::string(88, 0)).status ==
        hses::kCommandUndefined);
}

TEST_CASE("links freeze, drop, delay, double and corrupt what they carry", "[unit]") {
  ArmRig rig;
  ArmRig::Socket state = rig.State(), motion = rig.Motion();
  const std::string ping = sm::Encode(sm::Request(sm::Ping{}));
  state.Collect(50);
  LinkFaults& link = rig.emulator.state_link();
  SECTION("freeze") {
    link.freeze = true;
    CHECK(state.Collect(200).empty());
    CHECK_FALSE(state.closed());
    link.freeze = false;
    CHECK(state.Collect(100).size() >= 3 * kState);
    rig.emulator.motion_link().freeze = true;
    motion.Send(ping);
    CHECK(motion.Receive(16, 100).empty());
    rig.emulator.motion_link().freeze = false;
    CHECK(motion.Receive(16, 10).size() == 16);
  }
  SECTION("drop") {
    link.drop = true;
    CHECK(state.Collect(200).empty());
    rig.emulator.motion_link().drop = true;
    motion.Send(ping);
    CHECK(motion.Receive(16, 50).empty());
    rig.emulator.motion_link().drop = false;
    CHECK(motion.Receive(16, 50).empty());
    motion.Send(ping);
    CHECK(motion.Receive(16, 50).size() == 16);
  }
  SECTION("delay") {
    rig.emulator.motion_link().delay = std::chrono::milliseconds(80);
    const TimeNs before = rig.now;
    motion.Send(ping);
    CHECK(motion.Receive(16).size() == 16);
    CHECK(rig.now - before >= std::chrono::milliseconds(80));
    CHECK(rig.now - before < std::chrono::milliseconds(90));
  }
  SECTION("duplicate") {
    rig.emulator.motion_link().duplicate = true;
    motion.Send(ping);
    CHECK(motion.Receive(32, 50).size() == 32);
  }
  SECTION("corrupt") {
    rig.emulator.motion_link().corrupt = true;
    motion.Send(ping);
    const std::string reply = motion.Receive(16, 50);
    CHECK(reply.size() == 16);
    CHECK(ToHex(reply) != ToHex(sm::Encode(sm::Reply(sm::Ping{}))));
  }
  SECTION("cut") {
    rig.emulator.CloseState();
    CHECK(state.closed());
    rig.emulator.CloseMotion();
    CHECK(motion.closed());
  }
}

TEST_CASE("garbage and floods of connections never stop the controller", "[unit]") {
  ArmRig rig;
  RandomStream stream(3, 0, "garbage for the arm emulator");
  for (int i = 0; i < 300; ++i) {
    std::string bytes;
    const std::uint32_t size = 1 + stream.Index(300);
    for (std::uint32_t k = 0; k < size; ++k) bytes.push_back(static_cast<char>(stream.Index(256)));
    ArmRig::Socket motion = rig.Motion(), io = rig.Io(), state = rig.State();
    motion.Send(bytes);
    io.Send(bytes);
    state.Send(bytes);
    rig.AskHses(i % 10 == 0 ? bytes : hses::Encode(hses::Request{}));
    rig.Run(2);
  }
  Ready(rig);
  rig.Run(5);
  ArmRig::Socket state = rig.State();
  CHECK(state.Receive(kState).size() == kState);
}

TEST_CASE("while a motion waits no newcomer takes a state client's place", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  ArmRig::Socket a = rig.State(), b = rig.State(), c = rig.State(), d = rig.State();
  const JointVector q = rig.arm.Servo().q;
  Stream(motion, 0, 0.0, q);
  Stream(motion, 1, 1.0, q + 0.05 * kOnes);
  ArmRig::Socket newcomer = rig.State();
  CHECK(newcomer.closed());
  CHECK_FALSE(a.closed());
}

TEST_CASE("floods of bytes and of connections leave time for everybody else", "[unit]") {
  ArmRig rig;
  ArmRig::Socket flooding = rig.Motion(), honest = rig.State();
  std::atomic<bool> ends = false;
  std::thread flood([&] {
    asio::io_context io;
    const auto at = [](int port) {
      return asio::ip::tcp::endpoint(asio::ip::make_address("127.0.0.1"),
                                     static_cast<std::uint16_t>(port));
    };
    const std::string ping = sm::Encode(sm::Request(sm::MotionControl{}));
    asio::ip::udp::socket datagrams(io, {asio::ip::make_address("127.0.0.1"), 0});
    while (!ends) {
      asio::error_code ignored;
      asio::ip::tcp::socket newcomer(io);
      newcomer.connect(at(rig.emulator.io_port()), ignored);
      for (int i = 0; i < 20; ++i) newcomer.write_some(asio::buffer(ping), ignored);
      datagrams.send_to(asio::buffer(hses::Encode(hses::Request{})),
                        {asio::ip::make_address("127.0.0.1"),
                         static_cast<std::uint16_t>(rig.emulator.hses_port())},
                        0, ignored);
    }
  });
  for (int i = 0; i < 300; ++i) flooding.Send(std::string(200, 'x'));
  CHECK(honest.Collect(300).size() >= 10 * kState);
  ends = true;
  flood.join();
}

TEST_CASE("hundreds of connections that are held leave room for an honest client", "[unit]") {
  ArmRig rig;
  std::vector<asio::ip::tcp::socket> held;
  for (int i = 0; i < 900; ++i) {
    const int port = i % 3 == 0   ? rig.emulator.motion_port()
                     : i % 3 == 1 ? rig.emulator.state_port()
                                  : rig.emulator.io_port();
    held.emplace_back(rig.io);
    asio::error_code ignored;
    held.back().connect({asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(port)},
                        ignored);
    if (i % 10 == 9) rig.Run(1);
  }
  rig.Run(5);
  ArmRig::Socket motion = rig.Motion(), io = rig.Io(), state = rig.State();
  Ready(motion);
  CHECK(state.Receive(kState).size() == kState);
  CHECK(io.Ask(sm::Request(sm::ReadBit{10010})).body == sm::Body(sm::ReadBitReply{0, 0}));
}

TEST_CASE("a state client that does not read is closed and harms nobody", "[unit]") {
  ArmEmulatorConfig config = ArmRig::Loopback();
  config.state_period_s = 0.001;
  ArmRig rig(config);
  const ArmRig::Socket deaf = rig.State();
  ArmRig::Socket reader = rig.State();
  for (int i = 0; i < 200 && rig.emulator.state_clients() == 2; ++i) reader.Collect(500);
  CHECK(rig.emulator.state_clients() == 1);
  CHECK(reader.Collect(10).size() >= 9 * kState);
}

TEST_CASE("a taken port is an error that names it", "[unit]") {
  ArmRig rig;
  ArmEmulatorConfig config = ArmRig::Loopback();
  config.state_port = rig.emulator.state_port();
  FakeServoArm arm;
  REQUIRE_THROWS_WITH(ArmEmulator(rig.io, arm, PaperCell().arm, config),
                      "arm (state) cannot listen on 127.0.0.1:" +
                          std::to_string(config.state_port) + ": Address already in use");
}

}  // namespace tubetwin::test
