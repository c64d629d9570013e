#include "hw_bridge/codecs/hses.h"

#include <cstring>

#include "models/base/error.h"
#include "models/base/random.h"
#include "tests/codecs/hex.h"
#include "tests/support/catch.h"

namespace tubetwin::hses {
namespace {

using test::FromHex;
using test::ToHex;

Request Ask(std::uint8_t id, std::uint16_t command, std::uint16_t instance, std::uint8_t attribute,
            std::uint8_t service, std::string data = {}) {
  return {Division::kRobot, 0, id, 0, command, instance, attribute, service, std::move(data)};
}

CartesianMove Line() {
  CartesianMove move;
  move.speed_class = 1;
  move.speed = 500;
  move.pose = {600000, -100000, 250000, 1800000, 0, 0, 0};
  return move;
}

PulseMove Pulses() {
  PulseMove move;
  move.speed = 1000;
  move.pulses = {1000, -2000, 3000, 0, 0, 0, 0};
  return move;
}

TEST_CASE("HSES requests have the documented bytes both ways", "[unit]") {
  const std::string reserved = "00000000 3939393939393939 ";
  const auto [bytes, request] = GENERATE_COPY(table<std::string, Request>({
      {"59455243 2000 0000 03 01 00 01 " + reserved + "7200 0100 00 01 0000",
       Ask(1, kStatus, 1, 0, kGetAll)},
      {"59455243 2000 0000 03 01 00 02 " + reserved + "7500 0100 00 01 0000",
       Ask(2, kPosition, kPulses, 0, kGetAll)},
      {"59455243 2000 0000 03 01 00 03 " + reserved + "7500 6500 00 01 0000",
       Ask(3, kPosition, kCartesian, 0, kGetAll)},
      {"59455243 2000 0400 03 01 00 04 " + reserved + "8300 0200 01 10 0000 01000000",
       Ask(4, kPower, kServo, 1, kSetOne, Word(kOn))},
      {"59455243 2000 0400 03 01 00 05 " + reserved + "8300 0100 01 10 0000 01000000",
       Ask(5, kPower, kHold, 1, kSetOne, Word(kOn))},
      {"59455243 2000 0400 03 01 00 06 " + reserved + "8200 0100 01 10 0000 01000000",
       Ask(6, kReset, kResetAlarm, 1, kSetOne, Word(1))},
      {"59455243 2000 0400 03 01 00 08 " + reserved + "8600 0100 01 10 0000 01000000",
       Ask(8, kStartJob, 1, 1, kSetOne, Word(1))},
      {"59455243 2000 6800 03 01 00 09 " + reserved +
           "8a00 0200 01 02 0000 01000000 00000000 01000000 f4010000 11000000 c0270900 6079feff "
           "90d00300 40771b00 00*68",
       Ask(9, kMoveCartesian, kStraightAbsolute, 1, kSetAll, Encode(Line()))},
      {"59455243 2000 5800 03 01 00 0a " + reserved +
           "8b00 0100 01 02 0000 01000000 00000000 00000000 e8030000 e8030000 30f8ffff b80b0000 "
           "00*60",
       Ask(10, kMovePulse, kJointAbsolute, 1, kSetAll, Encode(Pulses()))},
      {"59455243 2000 0000 03 01 00 0b " + reserved + "7a00 0000 01 0e 0000",
       Ask(11, kVariableB, 0, 1, kGetOne)},
      {"59455243 2000 0100 03 01 00 0c " + reserved + "7a00 0000 01 10 0000 05",
       Ask(12, kVariableB, 0, 1, kSetOne, Encode(Value(std::uint8_t{5})))},
  }));
  CAPTURE(bytes);
  CHECK(ToHex(Encode(request)) == ToHex(FromHex(bytes)));
  const auto decoded = DecodeRequest(FromHex(bytes));
  REQUIRE(std::holds_alternative<Request>(decoded));
  CHECK(std::get<Request>(decoded) == request);
  CHECK(std::holds_alternative<DecodeError>(DecodeAnswer(FromHex(bytes))));
}

TEST_CASE("HSES answers have the documented bytes both ways", "[unit]") {
  Answer status{.id = 1, .data = Encode(Status{0xc4, 0x40})};
  Answer accepted{.id = 4, .service = kSetOne, .data = {}};
  Answer refused{.id = 4,
                 .service = kSetOne,
                 .status = kRefused,
                 .added_words = 1,
                 .added_status = kWrongMode,
                 .data = {}};
  const auto [bytes, answer] = GENERATE_COPY(table<std::string, Answer>({
      {"59455243 2000 0800 03 01 01 01 00000080 3939393939393939 81 00 00 00 0000 0000 c4000000 "
       "40000000",
       status},
      {"59455243 2000 0000 03 01 01 04 00000080 3939393939393939 90 00 00 00 0000 0000", accepted},
      {"59455243 2000 0000 03 01 01 04 00000080 3939393939393939 90 1f 01 00 8020 0000", refused},
  }));
  CAPTURE(bytes);
  CHECK(ToHex(Encode(answer)) == ToHex(FromHex(bytes)));
  const auto decoded = DecodeAnswer(FromHex(bytes));
  REQUIRE(std::holds_alternative<Answer>(decoded));
  CHECK(std::get<Answer>(decoded) == answer);
  CHECK(StatusText(refused) == "wrong mode (0x1f, 0x2080)");
  CHECK(StatusText(accepted) == "normal");
}

TEST_CASE("The example's status bits say continuous, play, remote and servo on", "[unit]") {
  const auto status = std::get<Status>(DecodeStatus(FromHex("c4000000 40000000")));
  CHECK(status.data1 == (Status::kContinuous | Status::kPlay | Status::kCommandRemote));
  CHECK(status.data2 == Status::kServoOn);
}

std::string RandomBytes(RandomStream& stream, std::size_t size) {
  std::string out;
  while (out.size() < size) out.push_back(static_cast<char>(stream.Index(256)));
  return out;
}

TEST_CASE("HSES data come back as they went in", "[unit]") {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    RandomStream stream(9, i, "hses data");
    CAPTURE(i);
    const std::string move = RandomBytes(stream, 104), pulses = RandomBytes(stream, 88),
                      position = RandomBytes(stream, 52);
    REQUIRE((Encode(std::get<CartesianMove>(DecodeCartesianMove(move))) == move));
    REQUIRE((Encode(std::get<PulseMove>(DecodePulseMove(pulses))) == pulses));
    REQUIRE((Encode(std::get<Position>(DecodePosition(position))) == position));
    const Alarm alarm{stream.NextBits(), stream.NextBits(), stream.NextBits(), "2026/01/31 12:00",
                      std::string(stream.Index(33), 'a')};
    REQUIRE(std::get<Alarm>(DecodeAlarm(Encode(alarm))) == alarm);
    const Job job{std::string(stream.Index(33), 'J'), stream.NextBits(), stream.NextBits(),
                  stream.NextBits()};
    REQUIRE(std::get<Job>(DecodeJob(Encode(job))) == job);
    for (const std::uint16_t command :
         {kVariableB, kVariableI, kVariableD, kVariableR, kRegister, kIoByte}) {
      const std::string bytes = RandomBytes(stream, 4);
      const std::string value = Encode(std::get<Value>(DecodeValue(command, bytes)));
      REQUIRE((bytes.substr(0, value.size()) == value));
    }
    const Value text(std::string(stream.Index(17), 's'));
    REQUIRE(std::get<Value>(DecodeValue(kVariableS, Encode(text))) == text);
  }
}

TEST_CASE("HSES data that are too short are refused with their size", "[unit]") {
  CHECK(std::get<DecodeError>(DecodeStatus("1234567")).reason == "7 bytes of data, 8 needed");
  CHECK(std::holds_alternative<DecodeError>(DecodeAlarm(std::string(59, 'x'))));
  CHECK(std::holds_alternative<DecodeError>(DecodeJob(std::string(43, 'x'))));
  CHECK(std::holds_alternative<DecodeError>(DecodePosition(std::string(47, 'x'))));
  CHECK(std::holds_alternative<DecodeError>(DecodeCartesianMove(std::string(103, 'x'))));
  CHECK(std::holds_alternative<DecodeError>(DecodePulseMove(std::string(87, 'x'))));
  CHECK(std::holds_alternative<DecodeError>(DecodeValue(kVariableD, "abc")));
  CHECK(std::holds_alternative<DecodeError>(DecodeValue(kStatus, "abcd")));
  CHECK(std::holds_alternative<DecodeError>(DecodeJobSelection(std::string(35, 'x'))));
}

TEST_CASE("Datagrams whose sizes disagree are refused", "[unit]") {
  const std::string good = Encode(Ask(4, kPower, kServo, 1, kSetOne, Word(kOn)));
  const auto reason = [](const std::string& bytes) {
    return std::get<DecodeError>(DecodeRequest(bytes)).reason;
  };
  CHECK(reason(good.substr(0, 31)) == "31 bytes, a header has 32");
  CHECK(reason(good + "x") == "data size 4 in a datagram of 37 bytes");
  CHECK(reason("X" + good.substr(1)) == "does not begin with YERC");
  std::string other = good;
  other[4] = 0x21;
  CHECK(reason(other) == "header size 33, 32 allowed");
  other = good;
  other[9] = 3;
  CHECK(reason(other) == "division 3, 1 or 2 allowed");
  REQUIRE_THROWS_AS(Encode(Ask(1, kStatus, 1, 0, kGetAll, std::string(480, 'x'))), LogicError);
}

}  // namespace
}  // namespace tubetwin::hses
