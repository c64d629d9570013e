#include "hw_bridge/emulators/ati/wrist_emulator.h"

#include <asio.hpp>
#include <chrono>
#include <thread>

#include "models/base/error.h"
#include "models/base/random.h"
#include "tests/codecs/hex.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using test::FromHex;
using test::ToSpacedHex;

using asio::ip::tcp;
using asio::ip::udp;
using Catch::Matchers::Contains;

struct SetWrist : ForceTorqueSensor {
  WrenchSample Read() const override { return sample; }
  WrenchSample sample;
};

WristEmulatorConfig WristOnAnyPort(double rate_Hz = 1000) {
  WristEmulatorConfig config;
  config.port = config.http_port = 0;
  config.rate_Hz = rate_Hz;
  return config;
}

struct WristBench {
  explicit WristBench(const WristEmulatorConfig& config = WristOnAnyPort())
      : emulator(io, sensor, config), socket(io) {
    sensor.sample.wrench_K.force_N = {1.5, -2.5, 10.0};
    sensor.sample.wrench_K.torque_Nm = {0.1, -0.2, 0.05};
    socket.open(udp::v4());
    socket.connect(
        {asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(emulator.port())});
    socket.non_blocking(true);
  }
  void Step(int periods = 1) {
    for (int i = 0; i < periods; ++i) {
      now += kControlPeriod;
      emulator.Tick(now);
    }
  }
  void Ask(RdtCommand command, std::uint32_t count = 0) {
    socket.send(asio::buffer(EncodeRdtRequest({command, count})));
  }
  /// Datagrams that have come, in order. Over loopback they are there when they are sent.
  std::vector<std::string> Datagrams() {
    std::vector<std::string> all;
    while (true) {
      std::array<char, 2048> bytes;
      asio::error_code error;
      const std::size_t size = socket.receive(asio::buffer(bytes), 0, error);
      if (error) return all;
      all.emplace_back(bytes.data(), size);
    }
  }
  std::vector<RdtRecord> Records() {
    std::vector<RdtRecord> all;
    for (const std::string& datagram : Datagrams()) {
      const auto records = DecodeRdtRecords(datagram);
      REQUIRE(std::holds_alternative<std::vector<RdtRecord>>(records));
      for (const RdtRecord& r : std::get<std::vector<RdtRecord>>(records)) all.push_back(r);
    }
    return all;
  }
  RdtRecord One() {
    Ask(RdtCommand::kStartRealTime, 1);
    Step();
    const auto records = Records();
    REQUIRE(records.size() == 1);
    return records[0];
  }
  /// What the page's server says to `request`.
  std::string Http(const std::string& request) {
    tcp::socket client(io);
    client.connect(
        {asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(emulator.http_port())});
    asio::write(client, asio::buffer(request));
    client.non_blocking(true);
    std::string all;
    for (int i = 0; i < 2000; ++i) {
      Step();
      std::array<char, 4096> bytes;
      asio::error_code error;
      const std::size_t size = client.read_some(asio::buffer(bytes), error);
      all.append(bytes.data(), size);
      if (error && error != asio::error::would_block) return all;
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    return all + " (never closed)";
  }

  asio::io_context io;
  SetWrist sensor;
  TimeNs now = std::chrono::seconds(1);
  WristEmulator emulator;
  udp::socket socket;
};

TEST_CASE("One sample is the record of the protocol's example", "[unit]") {
  WristBench bench;
  bench.now = FromSeconds(1.0 / 7.0) - kControlPeriod;  // Sample 1000 of the box.
  bench.Ask(RdtCommand::kStartRealTime, 1);
  bench.Step(50);
  const auto datagrams = bench.Datagrams();
  REQUIRE(datagrams.size() == 1);
  CHECK(ToSpacedHex(datagrams[0]) ==
        ToSpacedHex(FromHex("00000001 000003e8 00000000 0016e360 ffd9da60 "
                            "00989680 000186a0 fffcf2c0 0000c350")));
}

TEST_CASE("A stream has the set rate in cell time and no gap", "[unit]") {
  const double rate_Hz = GENERATE(1.0, 333.0, 1000.0, 7000.0);
  CAPTURE(rate_Hz);
  WristBench bench(WristOnAnyPort(rate_Hz));
  bench.Ask(RdtCommand::kStartRealTime);
  std::vector<RdtRecord> records;
  for (int i = 0; i < 2001; ++i) {  // The first of them starts the stream.
    bench.Step();
    for (const RdtRecord& record : bench.Records()) records.push_back(record);
  }
  CHECK(records.size() == static_cast<std::size_t>(1 + 2 * rate_Hz));
  for (std::size_t i = 0; i < records.size(); ++i) {
    REQUIRE(records[i].rdt_sequence == i + 1);
    const double samples = 7000.0 / rate_Hz;
    REQUIRE(records[i].ft_sequence - records[0].ft_sequence ==
            Approx(samples * static_cast<double>(i)).margin(1));
  }
  bench.Ask(RdtCommand::kStop);
  bench.Step();
  (void)bench.Datagrams();
  bench.Step(1000);
  CHECK(bench.Datagrams().empty());
}

TEST_CASE("A buffered stream has many records in a datagram", "[unit]") {
  WristBench bench(WristOnAnyPort(7000));
  bench.Ask(RdtCommand::kStartBuffered, 100);
  bench.Step(100);
  const auto datagrams = bench.Datagrams();
  REQUIRE(datagrams.size() == 3);
  CHECK(datagrams[0].size() == 40 * kRdtRecordSize);
  CHECK(datagrams[2].size() == 20 * kRdtRecordSize);
}

TEST_CASE("Bias is subtracted from what comes after it", "[unit]") {
  WristBench bench;
  bench.Ask(RdtCommand::kSetBias);
  bench.Step();
  CHECK(bench.One().counts == std::array<std::int32_t, 6>{});
  bench.sensor.sample.wrench_K.force_N.z() = 11.0;
  CHECK(bench.One().counts == std::array<std::int32_t, 6>{0, 0, 1000000, 0, 0, 0});
}

TEST_CASE("Saturation is told while it lasts, the threshold until it is reset", "[unit]") {
  WristEmulatorConfig config = WristOnAnyPort();
  config.threshold_N = 50;
  WristBench bench(config);
  CHECK(bench.One().status == 0);
  bench.sensor.sample.saturated = true;
  CHECK(bench.One().status == 0x80020000);
  bench.sensor.sample.saturated = false;
  CHECK(bench.One().status == 0);
  bench.sensor.sample.wrench_K.force_N.x() = 51;
  CHECK(bench.One().status == 0x80010000);
  bench.sensor.sample.wrench_K.force_N.x() = 0;
  CHECK(bench.One().status == 0x80010000);
  bench.Ask(RdtCommand::kResetThreshold);
  bench.Step();
  CHECK(bench.One().status == 0);
}

TEST_CASE("Fault scripts change status, sequence and link", "[unit]") {
  WristBench bench;
  bench.Ask(RdtCommand::kStartRealTime);
  bench.Step(10);
  CHECK(bench.Records().size() == 10);
  SECTION("status") {
    bench.emulator.InjectStatus(0x00400000);
    bench.Step();
    CHECK(bench.Records().back().status == 0x80400000);
    bench.emulator.InjectStatus(0);
    bench.emulator.Saturate(true);
    bench.Step();
    CHECK(bench.Records().back().status == 0x80020000);
    bench.emulator.Saturate(false);
    bench.emulator.LatchThreshold();
    bench.Step();
    CHECK(bench.Records().back().status == 0x80010000);
  }
  SECTION("sequence") {
    bench.emulator.SkipSequence(100);
    bench.Step();
    CHECK(bench.Records().back().rdt_sequence == 111);
  }
  SECTION("drop") {
    bench.emulator.link().drop = true;
    bench.Step(5);
    CHECK(bench.Records().empty());
    bench.emulator.link().drop = false;
    bench.Step();
    CHECK(bench.Records().back().rdt_sequence == 16);
  }
  SECTION("freeze") {
    bench.emulator.link().freeze = true;
    bench.Step(5);
    CHECK(bench.Records().empty());
  }
  SECTION("delay") {
    bench.emulator.link().delay = FromSeconds(0.02);
    bench.Step(20);
    CHECK(bench.Records().empty());
    bench.Step();
    CHECK(bench.Records().front().rdt_sequence == 11);
  }
  SECTION("duplicate") {
    bench.emulator.link().duplicate = true;
    bench.Step();
    const auto records = bench.Records();
    REQUIRE(records.size() == 2);
    CHECK(records[0] == records[1]);
  }
  SECTION("corrupt") {
    bench.emulator.link().corrupt = true;
    bench.Step();
    const auto datagrams = bench.Datagrams();
    REQUIRE(datagrams.size() == 1);
    CHECK(datagrams[0].size() == 35);
  }
}

TEST_CASE("The stream belongs to whom asked last", "[unit]") {
  WristBench bench;
  bench.Ask(RdtCommand::kStartRealTime);
  bench.Step(2);
  udp::socket other(bench.io, udp::v4());
  const udp::endpoint box(asio::ip::make_address("127.0.0.1"),
                          static_cast<std::uint16_t>(bench.emulator.port()));
  other.send_to(asio::buffer(EncodeRdtRequest({RdtCommand::kStop, 0})), box);
  bench.Step();
  CHECK(bench.Records().size() == 3);  // Only its own client stops it.
  other.send_to(asio::buffer(EncodeRdtRequest({RdtCommand::kStartRealTime, 0})), box);
  bench.Step(5);
  CHECK(bench.Records().empty());
  CHECK(other.available() > 0);
}

TEST_CASE("Garbage on the wire is ignored", "[unit]") {
  WristBench bench;
  bench.Ask(RdtCommand::kStartRealTime);
  bench.Step();
  std::uint32_t newest = 0;
  for (int round = 0; round < 500; ++round) {
    RandomStream stream(1, static_cast<std::uint64_t>(round), "rdt garbage");
    std::string bytes(stream.Index(200), '\0');
    for (char& byte : bytes) byte = static_cast<char>(stream.Index(256));
    if (bytes.size() >= 2 && round % 3 == 0) bytes.replace(0, 2, "\x12\x34");
    bench.socket.send(asio::buffer(bytes));
    bench.Step();
    for (const RdtRecord& record : bench.Records()) newest = record.rdt_sequence;
  }
  CHECK(newest == 501);
}

TEST_CASE("Public clients' datagrams start, restart, bias and stop the stream", "[unit]") {
  WristBench bench;
  const auto ask = [&bench](const std::string& hex) {
    bench.socket.send(asio::buffer(FromHex(hex)));
  };
  // netft_utils: a stream without end, its sequence from 1 on; it starts again when nothing comes.
  ask("1234 0002 00000000");
  bench.Step(20);
  std::vector<RdtRecord> records = bench.Records();
  REQUIRE(records.size() >= 19);
  CHECK(records.front().rdt_sequence == 1);
  CHECK(records.back().rdt_sequence == records.size());
  CHECK(std::abs(records.back().counts[2] - 10'000'000) < 20'000);  // Its counts per newton: 1e6.
  // netft-cpp and pynetft: bias, and the stream anew.
  ask("1234 0042 00000000");
  ask("1234 0002 00000000");
  bench.Step(20);
  records = bench.Records();
  REQUIRE(records.size() >= 19);
  CHECK(std::abs(records.back().counts[2]) < 20'000);
  ask("1234 0000 00000000");
  bench.Step(5);
  bench.Datagrams();
  bench.Step(20);
  CHECK(bench.Datagrams().empty());
  // What netft-cpp wants to find in the page, asked for as libcurl asks.
  const std::string page =
      bench.Http("GET /netftapi2.xml HTTP/1.1\r\nHost: 127.0.0.1:8049\r\nAccept: */*\r\n\r\n");
  for (const char* tag :
       {"<prodname>", "<cfgcpf>1000000<", "<cfgcpt>1000000<", "<scfgfu>N<", "<scfgtu>"}) {
    CHECK_THAT(page, Contains(tag));
  }
}

TEST_CASE("The configuration page is served over HTTP, and nothing else", "[unit]") {
  WristEmulatorConfig config = WristOnAnyPort(500);
  config.counts_per_N = 250000;
  WristBench bench(config);
  const std::string answer = bench.Http("GET /netftapi2.xml HTTP/1.1\r\nHost: box\r\n\r\n");
  CHECK_THAT(answer, Catch::Matchers::StartsWith("HTTP/1.0 200 OK\r\n"));
  const auto page = DecodeNetftPage(answer.substr(answer.find("\r\n\r\n") + 4));
  REQUIRE(std::holds_alternative<NetftPage>(page));
  CHECK(std::get<NetftPage>(page).counts_per_force == 250000);
  CHECK(std::get<NetftPage>(page).counts_per_torque == 1e6);
  CHECK(std::get<NetftPage>(page).rate_Hz == 500);
  for (const char* target :
       {"/netftapi2.xml?index=0", "/netftapi2.xml?index=15", "/netftcalapi.xml?index=0"}) {
    CHECK_THAT(bench.Http(std::string("GET ") + target + " HTTP/1.0\r\n\r\n"),
               Contains("200 OK") && Contains("cpf>250000</c"));
  }
  for (const char* target : {"/", "/netftapi2.xml?index=16", "/netftapi2.xml?x=0", "/netftapi2.xm",
                             "/../netftapi2.xml", "?index=0"}) {
    CHECK_THAT(bench.Http(std::string("GET ") + target + " HTTP/1.0\r\n\r\n"),
               Contains("404 Not Found"));
  }
  CHECK_THAT(bench.Http("POST /netftapi2.xml HTTP/1.0\r\n\r\n"), Contains("405"));
  CHECK(bench.Http(std::string(20000, 'x')).empty());
  CHECK_THAT(bench.Http("GET /netftapi2.xml HTTP/1.0\r\n\r\n"), Contains("200 OK"));
}

TEST_CASE("A UDP port in use is a device that cannot be had", "[unit]") {
  WristBench bench;
  WristEmulatorConfig config = WristOnAnyPort();
  config.port = bench.emulator.port();
  try {
    const WristBench second(config);
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kDevice);
    CHECK_THAT(error.what(), Contains("cannot listen on UDP 127.0.0.1:"));
  }
}

}  // namespace
}  // namespace tubetwin
