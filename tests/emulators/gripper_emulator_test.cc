#include "hw_bridge/emulators/robotiq/gripper_emulator.h"

#include <fcntl.h>
#include <unistd.h>

#include <asio.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "models/base/error.h"
#include "models/base/random.h"
#include "tests/codecs/hex.h"
#include "tests/support/catch.h"
#include "tests/support/moving_fingers.h"
#include "tests/support/paper_scale.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

using test::FromHex;
using test::ToSpacedHex;

using Catch::Matchers::Contains;

GripperEmulatorConfig GripperOnAnyPort() {
  GripperEmulatorConfig config;
  config.scale = PaperScale();
  config.port = 0;
  return config;
}

/// The emulator and its cell, in which the test decides when a period passes.
struct GripperBench {
  explicit GripperBench(const GripperEmulatorConfig& config = GripperOnAnyPort())
      : emulator(io, fingers, config) {}
  void Step() {
    now += kControlPeriod;
    fingers.Advance(kControlPeriod);
    emulator.Tick(now);
  }
  asio::io_context io;
  MovingFingers fingers;
  TimeNs now{0};
  GripperEmulator emulator;
};

/// A client that only knows bytes.
struct TcpClient {
  explicit TcpClient(GripperBench& served) : bench(served), socket(bench.io) {
    socket.connect(
        {asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(bench.emulator.port())});
    socket.non_blocking(true);
  }
  void Send(const std::string& bytes) { asio::write(socket, asio::buffer(bytes)); }
  /// What comes within some periods of the cell, as hex; "closed" when the connection is.
  std::string Receive(std::size_t enough = 1, int periods = 400) {
    std::string all;
    for (int i = 0; i < periods && all.size() < enough; ++i) {
      bench.Step();
      char bytes[512];
      asio::error_code error;
      const std::size_t size = socket.read_some(asio::buffer(bytes), error);
      if (error && error != asio::error::would_block) return "closed";
      all.append(bytes, size);
      if (size == 0) std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    return ToSpacedHex(all);
  }
  std::string Ask(const std::string& hex) {
    Send(FromHex(hex));
    return Receive();
  }
  GripperBench& bench;
  asio::ip::tcp::socket socket;
};

TEST_CASE("Modbus TCP requests are answered with the registers", "[unit]") {
  GripperBench bench;
  TcpClient client(bench);
  CHECK(client.Ask("0001 0000 0006 09 03 07D0 0003") ==
        ToSpacedHex(FromHex("0001 0000 0009 09 03 06 0000 0000 0300")));
  CHECK(client.Ask("0002 0000 000D 09 10 03E8 0003 06 0100 0000 0000") ==
        ToSpacedHex(FromHex("0002 0000 0006 09 10 03E8 0003")));
  CHECK(client.Ask("0003 0000 0006 FF 04 07D0 0001") ==
        ToSpacedHex(FromHex("0003 0000 0005 FF 04 02 1100")));
  for (int i = 0; i < 2000; ++i) bench.Step();
  CHECK(client.Ask("0004 0000 0006 00 03 07D0 0001") ==
        ToSpacedHex(FromHex("0004 0000 0005 00 03 02 3100")));
  // Write and read in one.
  CHECK(client.Ask("0005 0000 0011 09 17 07D0 0002 03E8 0003 06 0900 00FF FFFF") ==
        ToSpacedHex(FromHex("0005 0000 0007 09 17 04 3900 00FF")));
  CHECK(bench.fingers.commands.back().opening_m == 0.0);
  // What the ROS 2 driver reads: six registers.
  CHECK(client.Ask("0006 0000 0006 09 03 07D0 0006") ==
        ToSpacedHex(FromHex("0006 0000 000F 09 03 0C 3900 00FF 0319 0000 0000 0000")));
  CHECK(bench.emulator.requests() == 6);
}

TEST_CASE("Modbus TCP requests that are none of the gripper's are refused", "[unit]") {
  GripperBench bench;
  TcpClient client(bench);
  const auto [why, request, code] = GENERATE(table<const char*, const char*, const char*>({
      {"address", "0001 0000 0006 09 03 07D0 0011", "83 02"},
      {"address", "0001 0000 0006 09 04 0000 0001", "84 02"},
      {"address", "0001 0000 0009 09 10 07D0 0001 02 0000", "90 02"},
      {"count", "0001 0000 0006 09 03 07D0 0000", "83 03"},
      {"count", "0001 0000 0006 09 03 07D0 00FF", "83 03"},
      {"bytes", "0001 0000 0009 09 10 03E8 0002 02 0000", "90 03"},
      {"function", "0001 0000 0006 09 01 07D0 0001", "81 01"},
      {"function", "0001 0000 0006 09 06 03E8 0100", "86 01"},
      {"function", "0001 0000 0002 09 2B", "AB 01"},
      {"unit", "0001 0000 0006 08 03 07D0 0001", "83 0B"},
  }));
  CAPTURE(why, request);
  CHECK_THAT(client.Ask(request), Catch::Matchers::EndsWith(code));
  CHECK(bench.fingers.commands.empty());
  CHECK_THAT(client.Ask("0002 0000 0006 09 03 07D0 0001"), Contains("00 02"));
}

TEST_CASE("Clients that trickle bytes into every place do not keep an honest one out", "[unit]") {
  GripperBench bench;
  std::vector<std::unique_ptr<TcpClient>> slow;
  for (int i = 0; i < 8; ++i) slow.push_back(std::make_unique<TcpClient>(bench));
  const std::string head = FromHex("0001 0000 00");
  for (const char byte : head) {
    for (const auto& client : slow) client->Send(std::string(1, byte));
    for (int i = 0; i < 300; ++i) bench.Step();
  }
  TcpClient honest(bench);
  CHECK(honest.Ask("0001 0000 0006 09 03 07D0 0001") ==
        ToSpacedHex(FromHex("0001 0000 0005 09 03 02 0000")));
  // Whoever asks in time keeps the place.
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 300; ++k) bench.Step();
    CHECK(honest.Ask("0001 0000 0006 09 03 07D0 0001") != "closed");
    slow.push_back(std::make_unique<TcpClient>(bench));
  }
}

TEST_CASE("Requests may come in pieces and in heaps", "[unit]") {
  GripperBench bench;
  TcpClient client(bench);
  const std::string request = FromHex("0001 0000 0006 09 03 07D0 0001");
  for (const char byte : request) {
    client.Send(std::string(1, byte));
    bench.Step();
  }
  CHECK(client.Receive() == ToSpacedHex(FromHex("0001 0000 0005 09 03 02 0000")));
  std::string heap;
  for (int i = 0; i < 100; ++i) heap += request;
  client.Send(heap);
  CHECK(FromHex(client.Receive(100 * 11)).size() == 100 * 11);
}

TEST_CASE("Garbage ends its connection and no other", "[unit]") {
  GripperBench bench;
  TcpClient good(bench);
  for (int round = 0; round < 200; ++round) {
    RandomStream stream(1, static_cast<std::uint64_t>(round), "modbus garbage");
    TcpClient bad(bench);
    std::string bytes(1 + stream.Index(600), '\0');
    for (char& byte : bytes) byte = static_cast<char>(stream.Index(256));
    if (round % 2 == 0) bytes.replace(0, 7, FromHex("0001 0000 0006 09"));
    bad.Send(bytes);
    for (int i = 0; i < 3; ++i) bench.Step();
  }
  CHECK_THAT(good.Ask("0007 0000 0006 09 03 07D0 0001"), Contains("00 07"));
  TcpClient other(bench);
  CHECK(other.Ask("0001 0001 0006 09 03 07D0 0001") == "closed");
}

TEST_CASE("A flood of idle connections does not lock the gripper up", "[unit]") {
  GripperBench bench;
  std::vector<std::unique_ptr<TcpClient>> flood;
  for (int i = 0; i < 40; ++i) {
    flood.push_back(std::make_unique<TcpClient>(bench));
    bench.Step();
  }
  for (int i = 0; i < 1100; ++i) bench.Step();
  TcpClient client(bench);
  CHECK_THAT(client.Ask("0001 0000 0006 09 03 07D0 0001"), Contains("00 01"));
}

GripperEmulatorConfig OnLine(const TemporaryFolder& folder) {
  GripperEmulatorConfig config;
  config.scale = PaperScale();
  config.transport = "rtu";
  config.device = folder / "ttyGRIPPER";
  return config;
}

/// A client on the gripper's line that only knows bytes.
class RtuClient {
 public:
  explicit RtuClient(GripperBench& served)
      : bench_(served),
        line_(::open(served.emulator.device().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    REQUIRE(line_ >= 0);
  }
  RtuClient(const RtuClient&) = delete;
  RtuClient& operator=(const RtuClient&) = delete;
  ~RtuClient() { ::close(line_); }

  std::string Ask(const std::string& hex) {
    const std::string request = FromHex(hex);
    REQUIRE(::write(line_, request.data(), request.size()) == static_cast<ssize_t>(request.size()));
    std::string all;
    for (int i = 0; i < 100; ++i) {
      bench_.Step();
      char bytes[512];
      const ssize_t size = ::read(line_, bytes, sizeof bytes);
      if (size > 0) all.append(bytes, static_cast<std::size_t>(size));
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    return ToSpacedHex(all);
  }

 private:
  GripperBench& bench_;
  int line_ = -1;
};

TEST_CASE("Modbus RTU on a pseudo-terminal gives the frames of the manual", "[unit]") {
  const TemporaryFolder folder;
  const GripperEmulatorConfig config = OnLine(folder);
  {
    GripperBench bench(config);
    CHECK(bench.emulator.device() == config.device);
    RtuClient client(bench);
    CHECK(client.Ask("09 10 03 E8 00 03 06 00 00 00 00 00 00 73 30") == "09 10 03 E8 00 03 01 30");
    CHECK(client.Ask("09 10 03 E8 00 03 06 01 00 00 00 00 00 72 E1") == "09 10 03 E8 00 03 01 30");
    CHECK(client.Ask("09 03 07 D0 00 01 85 CF") == "09 03 02 11 00 55 D5");
    CHECK(client.Ask("09 04 07 D0 00 01 30 0F") == "09 04 02 11 00 54 A1");
    for (int i = 0; i < 2000; ++i) bench.Step();
    CHECK(client.Ask("09 03 07 D0 00 01 85 CF") == "09 03 02 31 00 4C 15");
    // Illegal address, then noise, half a frame, another slave's: silence, and all goes on.
    CHECK(client.Ask("09 03 00 00 00 01 85 42") == "09 83 02 41 33");
    CHECK(client.Ask("55 AA 00 FF 13 37 09 09 09 09 09").empty());
    CHECK(client.Ask("09 03 07 D0").empty());
    CHECK(client.Ask("0A 03 07 D0 00 01 85 F9").empty());
    CHECK(client.Ask("09 04 07 D0 00 01 30 0F") == "09 04 02 31 00 4D 61");
  }
  CHECK_FALSE(std::filesystem::is_symlink(config.device));
}

TEST_CASE("Public drivers' frames are answered: six registers, one register, write and read",
          "[unit]") {
  using Catch::Matchers::StartsWith;
  const TemporaryFolder folder;
  GripperBench bench(OnLine(folder));
  RtuClient client(bench);
  // The ROS 2 driver (PickNikRobotics/ros2_robotiq_gripper) activates without clearing before.
  CHECK(client.Ask("09 10 03 E8 00 03 06 01 00 00 00 00 00 72 E1") == "09 10 03 E8 00 03 01 30");
  const std::string activating = client.Ask("09 03 07 D0 00 06 C4 0D");
  CHECK_THAT(activating, StartsWith("09 03 0C 11 00 00 00 "));
  CHECK(FromHex(activating).size() == 17);
  // It asks once a second, so the gripper complains of silence (9); the driver does not look there.
  for (int i = 0; i < 2000; ++i) bench.Step();
  CHECK(client.Ask("09 03 07 D0 00 06 C4 0D") ==
        "09 03 0C 31 00 09 00 03 00 00 00 00 00 00 00 B6 CF");
  CHECK(client.Ask("09 10 03 E8 00 03 06 09 00 00 80 80 80 12 21") == "09 10 03 E8 00 03 01 30");
  for (int i = 0; i < 2000; ++i) bench.Step();
  CHECK_THAT(client.Ask("09 03 07 D0 00 06 C4 0D"), StartsWith("09 03 0C F9 00 09 80 80 "));
  // pyRobotiqGripper: the action register alone, and all with an answer in the same exchange.
  CHECK(client.Ask("09 10 03 E8 00 01 02 01 00 E4 28") == "09 10 03 E8 00 01 80 F1");
  CHECK(client.Ask("09 03 07 D0 00 01 85 CF") == "09 03 02 31 00 4C 15");
  CHECK_THAT(client.Ask("09 17 07 D0 00 03 03 E8 00 01 02 09 00 F6 9A"),
             StartsWith("09 17 06 ") && Catch::Matchers::Contains(" 00 00 80 "));
  CHECK_THAT(client.Ask("09 17 07 D0 00 03 03 E8 00 03 06 09 00 00 80 FF FF D7 E6"),
             StartsWith("09 17 06 "));
}

TEST_CASE("Link faults do to answers what they say", "[unit]") {
  GripperBench bench;
  TcpClient client(bench);
  const std::string ask = "0001 0000 0006 09 03 07D0 0001";
  const std::string answer = ToSpacedHex(FromHex("0001 0000 0005 09 03 02 0000"));
  CHECK(client.Ask(ask) == answer);
  SECTION("drop") {
    bench.emulator.link().drop = true;
    CHECK(client.Ask(ask).empty());
    bench.emulator.link().drop = false;
    CHECK(client.Ask(ask) == answer);
  }
  SECTION("delay") {
    bench.emulator.link().delay = FromSeconds(0.1);
    const TimeNs before = bench.now;
    CHECK(client.Ask(ask) == answer);
    CHECK(bench.now - before >= FromSeconds(0.1));
  }
  SECTION("duplicate") {
    bench.emulator.link().duplicate = true;
    client.Send(FromHex(ask));
    CHECK(client.Receive(22) == answer + " " + answer);
  }
  SECTION("corrupt") {
    bench.emulator.link().corrupt = true;
    const std::string got = client.Ask(ask);
    CHECK(got.size() == answer.size());
    CHECK(got != answer);
  }
  SECTION("freeze") {
    bench.emulator.link().freeze = true;
    CHECK(client.Ask(ask).empty());
    bench.emulator.link().freeze = false;
    CHECK(client.Receive() == answer);
  }
}

TEST_CASE("A port in use is a device that cannot be had", "[unit]") {
  GripperBench bench;
  GripperEmulatorConfig config;
  config.scale = PaperScale();
  config.port = bench.emulator.port();
  try {
    const GripperBench second(config);
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kDevice);
    CHECK_THAT(error.what(), Contains("emulated gripper: cannot listen on 127.0.0.1:" +
                                      std::to_string(config.port)));
  }
}

}  // namespace
}  // namespace tubetwin
