#include "hw_bridge/codecs/simple_message.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "models/base/random.h"
#include "tests/codecs/hex.h"
#include "tests/support/catch.h"

namespace tubetwin::simple_message {
namespace {

using test::FromHex;
using test::ToHex;

Message Control(Command command) { return Request(MotionControl{0, 0, command, {}}); }

Message Answer(std::int32_t sequence, std::int32_t command, Result result, std::int32_t subcode) {
  return Reply(MotionReply{0, sequence, command, result, subcode, {}});
}

JointVector ExampleJoints() {
  JointVector q;
  q << 0.1, -0.2, 1.5, 0, 0.25, 0;
  return q;
}

TEST_CASE("simple_message has the documented bytes both ways", "[unit]") {
  JointPoint first;
  first.q_rad = ToSlots(ExampleJoints());
  JointFeedback feedback;
  feedback.q_rad = ToSlots(ExampleJoints());
  const auto [bytes, message] = GENERATE_COPY(table<std::string, Message>({
      {"0c000000 01000000 02000000 00000000", Request(Ping{})},
      {"0c000000 01000000 03000000 01000000", Reply(Ping{})},
      {"40000000 d1070000 02000000 00000000 00000000 00000000 b90d0300 00*40",
       Control(Command::kStartTrajectoryMode)},
      {"48000000 d2070000 03000000 01000000 00000000 00000000 b90d0300 00000000 00000000 00*40",
       Answer(0, 200121, Result::kSuccess, 0)},
      {"40000000 d1070000 02000000 00000000 00000000 00000000 a50d0300 00*40",
       Control(Command::kCheckMotionReady)},
      {"48000000 d2070000 03000000 01000000 00000000 00000000 a50d0300 02000000 8d130000 00*40",
       Answer(0, 200101, Result::kFailure, static_cast<int>(NotReady::kNotRemote))},
      {"40000000 d1070000 02000000 00000000 00000000 00000000 af0d0300 00*40",
       Control(Command::kStopMotion)},
      {"94000000 0e000000 02000000 00000000 00000000 00000000 07000000 00000000 cdcccc3d cdcc4cbe "
       "0000c03f 00000000 0000803e 00*100",
       Request(first)},
      {"48000000 d2070000 03000000 01000000 00000000 00000000 0e000000 00000000 00000000 00*40",
       Answer(0, 14, Result::kSuccess, 0)},
      {"48000000 d2070000 03000000 01000000 00000000 01000000 0e000000 01000000 00000000 00*40",
       Answer(1, 14, Result::kBusy, 0)},
      {"28000000 0d000000 01000000 00000000 01000000 00000000 00000000 00000000 00000000 02000000 "
       "01000000",
       Topic(RobotStatus{1, 0, 0, 0, 0, RobotStatus::kPlay, 1})},
      {"90000000 0f000000 01000000 00000000 00000000 06000000 00000000 cdcccc3d cdcc4cbe 0000c03f "
       "00000000 0000803e 00*100",
       Topic(feedback)},
      {"14000000 d5070000 02000000 00000000 1a270000 01000000", Request(WriteBit{10010, 1})},
      {"10000000 d6070000 03000000 01000000 00000000", Reply(WriteBitReply{0})},
  }));
  CAPTURE(bytes);
  CHECK(ToHex(Encode(message)) == ToHex(FromHex(bytes)));
  const auto decoded = DecodeFront(FromHex(bytes), true);
  REQUIRE(std::holds_alternative<Message>(decoded));
  CHECK(std::get<Message>(decoded) == message);
}

TEST_CASE("simple_message sizes are the documented ones", "[unit]") {
  const auto [id, comm, size] = GENERATE(table<int, Comm, std::size_t>({
      {1, Comm::kRequest, 16},    {13, Comm::kTopic, 44},      {14, Comm::kRequest, 152},
      {15, Comm::kTopic, 148},    {2001, Comm::kRequest, 68},  {2002, Comm::kReply, 76},
      {2003, Comm::kRequest, 20}, {2004, Comm::kReply, 24},    {2005, Comm::kRequest, 24},
      {2006, Comm::kReply, 20},   {2007, Comm::kRequest, 20},  {2008, Comm::kReply, 24},
      {2009, Comm::kRequest, 24}, {2010, Comm::kReply, 20},    {2012, Comm::kRequest, 20},
      {2012, Comm::kReply, 24},   {2013, Comm::kRequest, 24},  {2013, Comm::kReply, 20},
      {2018, Comm::kRequest, 28}, {2016, Comm::kRequest, 552}, {2020, Comm::kRequest, 16},
      {2020, Comm::kReply, 528},
  }));
  CAPTURE(id);
  CHECK(MessageSize(id, comm) == size);
  CHECK(size <= kLargestMessage);
  CHECK_FALSE(MessageSize(id + 5000, comm).has_value());
}

/// Any bytes of a known size: every pattern of bits is a value.
std::string RandomMessage(RandomStream& stream) {
  static constexpr std::int32_t kIds[] = {1,    13,   14,   15,   2001, 2002, 2003,
                                          2004, 2005, 2006, 2007, 2008, 2009, 2010,
                                          2012, 2013, 2016, 2018, 2020};
  for (;;) {
    const std::int32_t id = kIds[stream.Index(std::size(kIds))];
    const auto comm = static_cast<std::int32_t>(1 + stream.Index(3));
    const auto size = MessageSize(id, static_cast<Comm>(comm));
    if (!size) continue;
    std::string out;
    const auto put = [&out](std::uint32_t word) {
      for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>(word >> (8 * i)));
    };
    put(static_cast<std::uint32_t>(*size - 4));
    put(static_cast<std::uint32_t>(id));
    put(static_cast<std::uint32_t>(comm));
    put(stream.Index(3));
    while (out.size() < *size) put(stream.NextBits());
    return out;
  }
}

TEST_CASE("Any simple_message comes back bit by bit", "[unit]") {
  for (std::uint64_t i = 0; i < 3000; ++i) {
    RandomStream stream(7, i, "simple_message round trip");
    const std::string bytes = RandomMessage(stream);
    CAPTURE(i, ToHex(bytes));
    const auto decoded = DecodeFront(bytes, true);
    REQUIRE(std::holds_alternative<Message>(decoded));
    REQUIRE(ToHex(Encode(std::get<Message>(decoded))) == ToHex(bytes));
  }
}

TEST_CASE("A stream cut anywhere gives the messages that went in", "[unit]") {
  for (std::uint64_t i = 0; i < 200; ++i) {
    RandomStream stream(8, i, "simple_message stream");
    std::string sent, received;
    for (int k = 0; k < 12; ++k) sent += RandomMessage(stream);
    StreamReader reader;
    for (std::size_t at = 0; at < sent.size();) {
      const std::size_t n = 1 + stream.Index(200);
      reader.Append(std::string_view(sent).substr(at, n));
      at += n;
      while (auto next = reader.Next()) {
        REQUIRE(std::holds_alternative<Message>(*next));
        received += Encode(std::get<Message>(*next));
      }
    }
    CAPTURE(i);
    REQUIRE((received == sent));
  }
}

TEST_CASE("What is no simple_message is told apart as the controller does", "[unit]") {
  const std::string good = Encode(Control(Command::kStopMotion));
  const auto kind = [](const std::string& bytes, bool use_length) {
    return std::get<NoMessage>(DecodeFront(bytes, use_length)).kind;
  };
  CHECK(kind("", true) == NoMessage::Kind::kIncomplete);
  CHECK(kind(good.substr(0, 15), true) == NoMessage::Kind::kIncomplete);
  CHECK(kind(good.substr(0, 67), false) == NoMessage::Kind::kIncomplete);

  std::string other = good;
  other[4] = 99;
  CHECK(kind(other, true) == NoMessage::Kind::kUnknownId);
  CHECK(std::get<NoMessage>(DecodeFront(other, true)).id == 0x0763);

  other = good;
  other[8] = 3;
  CHECK(kind(other, true) == NoMessage::Kind::kComm);

  // The controller takes the size from the id, whatever the length says; a client does not.
  other = good;
  other[0] = 0x20;
  CHECK(kind(other, true) == NoMessage::Kind::kLength);
  CHECK(std::holds_alternative<Message>(DecodeFront(other, false)));

  StreamReader reader;
  reader.Append(good + other + good);
  REQUIRE(std::holds_alternative<Message>(*reader.Next()));
  REQUIRE(std::get<DecodeError>(*reader.Next()).reason ==
          "length 32 of message id 2001, which has 64");
  CHECK_FALSE(reader.Next().has_value());
  reader.Append(good);
  CHECK_FALSE(reader.Next().has_value());
}

TEST_CASE("Results and subcodes have names", "[unit]") {
  CHECK(SubcodeText(3011) == "start position (3011)");
  CHECK(SubcodeText(5011) == "contact stop (5011)");
  CHECK(SubcodeText(42) == "42");
  CHECK(ToString(Result::kNotReady) == "not ready");
  CHECK(ToString(static_cast<Result>(17)) == "result 17");
}

}  // namespace
}  // namespace tubetwin::simple_message
