#include "hw_bridge/codecs/rdt.h"

#include <limits>

#include "models/base/random.h"
#include "tests/codecs/hex.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using test::FromHex;
using test::ToSpacedHex;

using Catch::Matchers::Contains;

RdtRecord SomeRecord(RandomStream& stream) {
  const auto word = [&stream] { return stream.Index(65536) << 16 | stream.Index(65536); };
  RdtRecord record;
  record.rdt_sequence = word();
  record.ft_sequence = word();
  record.status = word();
  for (auto& count : record.counts) count = static_cast<std::int32_t>(word());
  return record;
}

TEST_CASE("Requests of raw data transfer are the bytes of the protocol", "[unit]") {
  const auto [command, count, bytes] = GENERATE(table<RdtCommand, std::uint32_t, const char*>({
      {RdtCommand::kStartRealTime, 0, "12 34 00 02 00 00 00 00"},
      {RdtCommand::kStartRealTime, 1, "12 34 00 02 00 00 00 01"},
      {RdtCommand::kStop, 0, "12 34 00 00 00 00 00 00"},
      {RdtCommand::kSetBias, 0, "12 34 00 42 00 00 00 00"},
      {RdtCommand::kResetThreshold, 0, "12 34 00 41 00 00 00 00"},
      {RdtCommand::kStartBuffered, 0x01020304, "12 34 00 03 01 02 03 04"},
      {RdtCommand::kStartMultiUnit, 0, "12 34 00 04 00 00 00 00"},
  }));
  const RdtRequest request{command, count};
  CHECK(ToSpacedHex(EncodeRdtRequest(request)) == bytes);
  const auto decoded = DecodeRdtRequest(FromHex(bytes));
  REQUIRE(std::holds_alternative<RdtRequest>(decoded));
  CHECK(std::get<RdtRequest>(decoded) == request);
}

TEST_CASE("A record of raw data transfer is the bytes of the protocol", "[unit]") {
  const std::string bytes =
      FromHex("00000001 000003e8 00000000 0016e360 ffd9da60 00989680 000186a0 fffcf2c0 0000c350");
  const auto decoded = DecodeRdtRecords(bytes);
  REQUIRE(std::holds_alternative<std::vector<RdtRecord>>(decoded));
  const auto& records = std::get<std::vector<RdtRecord>>(decoded);
  REQUIRE(records.size() == 1);
  CHECK(records[0].rdt_sequence == 1);
  CHECK(records[0].ft_sequence == 1000);
  CHECK(records[0].status == 0);
  const RdtScale scale;
  const Wrench wrench = scale.WrenchOf(records[0].counts);
  CHECK(wrench.force_N == Vector3(1.5, -2.5, 10.0));
  CHECK(wrench.torque_Nm == Vector3(0.1, -0.2, 0.05));
  CHECK(scale.CountsOf(wrench) == records[0].counts);
  std::string again;
  EncodeRdtRecord(records[0], again);
  CHECK(ToSpacedHex(again) == ToSpacedHex(bytes));
}

TEST_CASE("Every request and every record comes back from its bytes", "[unit]") {
  const RdtCommand commands[] = {RdtCommand::kStop,           RdtCommand::kStartRealTime,
                                 RdtCommand::kStartBuffered,  RdtCommand::kStartMultiUnit,
                                 RdtCommand::kResetThreshold, RdtCommand::kSetBias};
  for (int round = 0; round < 2000; ++round) {
    RandomStream stream(1, static_cast<std::uint64_t>(round), "rdt");
    const RdtRequest request{commands[stream.Index(6)], SomeRecord(stream).status};
    REQUIRE(std::get<RdtRequest>(DecodeRdtRequest(EncodeRdtRequest(request))) == request);
    std::vector<RdtRecord> records(1 + stream.Index(kMaxRdtRecords));
    std::string bytes;
    for (RdtRecord& record : records) {
      record = SomeRecord(stream);
      EncodeRdtRecord(record, bytes);
    }
    REQUIRE(std::get<std::vector<RdtRecord>>(DecodeRdtRecords(bytes)) == records);
  }
}

TEST_CASE("What is no request or no record says why", "[unit]") {
  const auto request = [](const char* hex) {
    return std::get<DecodeError>(DecodeRdtRequest(FromHex(hex))).reason;
  };
  CHECK_THAT(request("12 34 00 02 00 00 00"), Contains("7 bytes; allowed: 8"));
  CHECK_THAT(request("12 34 00 02 00 00 00 00 00"), Contains("9 bytes"));
  CHECK_THAT(request("34 12 00 02 00 00 00 00"), Contains("0x3412; allowed: 0x1234"));
  CHECK_THAT(request("12 34 00 43 00 00 00 00"), Contains("command 0x0043"));
  for (const std::size_t size : {0u, 1u, 35u, 37u, 71u, 36u * 41u}) {
    const auto records = DecodeRdtRecords(std::string(size, '\x7f'));
    REQUIRE(std::holds_alternative<DecodeError>(records));
    CHECK_THAT(std::get<DecodeError>(records).reason, Contains("allowed: 1 to 40 times 36"));
  }
  // Other lengths are errors, all others are records: no check sum.
  for (int round = 0; round < 5000; ++round) {
    RandomStream stream(3, static_cast<std::uint64_t>(round), "rdt");
    std::string bytes(stream.Index(1600), '\0');
    for (char& byte : bytes) byte = static_cast<char>(stream.Index(256));
    const bool whole = !bytes.empty() && bytes.size() % 36 == 0 && bytes.size() <= 36 * 40;
    REQUIRE(std::holds_alternative<DecodeError>(DecodeRdtRecords(bytes)) == !whole);
  }
}

TEST_CASE("Counts are rounded and clamped to what a record holds", "[unit]") {
  const RdtScale scale{1e6, 2e6};
  Wrench wrench;
  wrench.force_N = {1e9, -1e9, 0.0000006};
  wrench.torque_Nm = {std::numeric_limits<double>::quiet_NaN(), 1.0, -1.0};
  const std::array<std::int32_t, 6> counts = {2147483647, -2147483647 - 1, 1, 0, 2000000, -2000000};
  CHECK(scale.CountsOf(wrench) == counts);
}

TEST_CASE("The status word is told in words", "[unit]") {
  CHECK(RdtStatusText(0).empty());
  CHECK(RdtStatusText(0x80020000) == "saturation or A/D error (status 0x80020000)");
  CHECK(RdtStatusText(0x80010000) == "threshold latched (status 0x80010000)");
  CHECK(RdtStatusText(0x80400020) == "network error, supply low (status 0x80400020)");
  CHECK_THAT(RdtStatusText(0x80000000), Contains("error"));
  CHECK(RdtFaultBits(0x80030000) == 0);
  CHECK(RdtFaultBits(0x80400020) == 0x00400020);
  for (int bit = 0; bit < 31; ++bit) {
    CHECK_THAT(RdtStatusText(1u << bit), !Contains("without a cause"));
  }
}

}  // namespace
}  // namespace tubetwin
