#include "hw_bridge/codecs/robotiq_registers.h"

#include <cmath>
#include <limits>

#include "models/base/random.h"
#include "tests/codecs/rtu_line.h"
#include "tests/support/catch.h"
#include "tests/support/paper_scale.h"

namespace tubetwin {
namespace {

GripperAction GoTo(std::uint8_t position, std::uint8_t speed, std::uint8_t force) {
  GripperAction action;
  action.activate = action.go_to = true;
  action.position = position;
  action.speed = speed;
  action.force = force;
  return action;
}

GripperStatus Read(const char* frame) {
  const std::vector<std::uint16_t> words = RtuLine().Read(frame, 3);
  const auto status = DecodeGripperStatus({words.at(0), words.at(1), words.at(2)});
  REQUIRE(std::holds_alternative<GripperStatus>(status));
  return std::get<GripperStatus>(status);
}

TEST_CASE("Requests to the gripper are the frames of its manual", "[unit]") {
  GripperAction set, release;
  set.activate = true;
  release.activate = release.automatic_release = true;
  const auto [name, action, frame] = GENERATE_COPY(table<const char*, GripperAction, const char*>({
      {"clear rACT", GripperAction(), "09 10 03 E8 00 03 06 00 00 00 00 00 00 73 30"},
      {"set rACT", set, "09 10 03 E8 00 03 06 01 00 00 00 00 00 72 E1"},
      {"close", GoTo(255, 255, 255), "09 10 03 E8 00 03 06 09 00 00 FF FF FF 42 29"},
      {"open", GoTo(0, 255, 255), "09 10 03 E8 00 03 06 09 00 00 00 FF FF 72 19"},
      {"half", GoTo(0x80, 0x80, 0x40), "09 10 03 E8 00 03 06 09 00 00 80 80 40 12 71"},
      {"automatic release", release, "09 10 03 E8 00 03 06 11 00 00 00 00 00 70 71"},
  }));
  CAPTURE(name);
  RtuLine line;
  CHECK(line.Written(EncodeGripperAction(action), "09 10 03 E8 00 03 01 30") == frame);
  const GripperRegisters registers = EncodeGripperAction(action);
  CHECK(DecodeGripperAction(registers) == action);
}

TEST_CASE("Questions to the gripper are the frames of its manual", "[unit]") {
  RtuLine line;
  CHECK(line.Asked(0x03, 1) == "09 03 07 D0 00 01 85 CF");
  CHECK(line.Asked(0x04, 1) == "09 04 07 D0 00 01 30 0F");
  CHECK(line.Asked(0x03, 3) == "09 03 07 D0 00 03 04 0E");
  CHECK(line.Asked(0x04, 3) == "09 04 07 D0 00 03 B1 CE");
}

TEST_CASE("The manual's short answers tell how far the activation is", "[unit]") {
  const auto [frame, activation] = GENERATE(table<const char*, GripperActivation>({
      {"09 03 02 11 00 55 D5", GripperActivation::kRunning},
      {"09 04 02 11 00 54 A1", GripperActivation::kRunning},
      {"09 03 02 31 00 4C 15", GripperActivation::kDone},
      {"09 04 02 31 00 4D 61", GripperActivation::kDone},
  }));
  CAPTURE(frame);
  const std::vector<std::uint16_t> words = RtuLine().Read(frame, 1);
  const auto status = std::get<GripperStatus>(DecodeGripperStatus({words.at(0), 0, 0}));
  CHECK(status.activate);
  CHECK_FALSE(status.go_to);
  CHECK(status.activation == activation);
  CHECK(EncodeGripperStatus(status)[0] == words[0]);
}

TEST_CASE("The manual's answers are read as the manual says", "[unit]") {
  struct Example {
    const char* frame;
    GripperMotion motion;
    int request, position, current;
  };
  const Example example = GENERATE(values<Example>({
      {"09 03 06 39 00 00 FF 0E 0A F7 8B", GripperMotion::kMoving, 255, 0x0e, 10},
      {"09 03 06 B9 00 00 FF BD 00 1D 7C", GripperMotion::kStoppedClosing, 255, 0xbd, 0},
      {"09 04 06 B9 00 00 FF BD 00 5C 9A", GripperMotion::kStoppedClosing, 255, 0xbd, 0},
      {"09 04 06 39 00 00 00 BB 10 71 06", GripperMotion::kMoving, 0, 0xbb, 16},
      {"09 03 06 F9 00 00 00 0D 00 56 4C", GripperMotion::kArrived, 0, 0x0d, 0},
      {"09 04 06 F9 00 00 00 0D 00 17 AA", GripperMotion::kArrived, 0, 0x0d, 0},
  }));
  CAPTURE(example.frame);
  const GripperStatus status = Read(example.frame);
  CHECK(status.activate);
  CHECK(status.go_to);
  CHECK(status.activation == GripperActivation::kDone);
  CHECK(status.motion == example.motion);
  CHECK(status.fault == 0);
  CHECK(status.position_request == example.request);
  CHECK(status.position == example.position);
  CHECK(status.current == example.current);
  CHECK(RtuLine().Answer(EncodeGripperStatus(status), example.frame) == example.frame);
}

TEST_CASE("The manual's refusals are illegal addresses", "[unit]") {
  CHECK(RtuLine().Refusal("09 90 02 4C 03", GripperRegisters{}) == EMBXILADD);
  CHECK(RtuLine().Refusal("09 83 02 41 33", std::nullopt) == EMBXILADD);
}

TEST_CASE("Every action and every status comes back from its registers", "[unit]") {
  for (int round = 0; round < 5000; ++round) {
    RandomStream stream(1, static_cast<std::uint64_t>(round), "gripper registers");
    const auto byte = [&stream] { return static_cast<std::uint8_t>(stream.Index(256)); };
    const auto flag = [&stream] { return stream.Index(2) == 1; };
    GripperAction action = GoTo(byte(), byte(), byte());
    action.activate = flag();
    action.go_to = flag();
    action.automatic_release = flag();
    action.release_opens = flag();
    REQUIRE(DecodeGripperAction(EncodeGripperAction(action)) == action);
    GripperStatus status;
    status.activate = flag();
    status.go_to = flag();
    const GripperActivation states[] = {GripperActivation::kReset, GripperActivation::kRunning,
                                        GripperActivation::kDone};
    status.activation = states[stream.Index(3)];
    status.motion = static_cast<GripperMotion>(stream.Index(4));
    status.fault = static_cast<std::uint8_t>(stream.Index(16));
    status.controller_fault = static_cast<std::uint8_t>(stream.Index(16));
    status.position_request = byte();
    status.position = byte();
    status.current = byte();
    const auto back = DecodeGripperStatus(EncodeGripperStatus(status));
    REQUIRE(std::holds_alternative<GripperStatus>(back));
    REQUIRE(std::get<GripperStatus>(back) == status);
  }
}

TEST_CASE("Bits that mean nothing are not looked at", "[unit]") {
  for (int round = 0; round < 5000; ++round) {
    RandomStream stream(2, static_cast<std::uint64_t>(round), "gripper registers");
    GripperRegisters words;
    for (auto& word : words) word = static_cast<std::uint16_t>(stream.Index(65536));
    const GripperRegisters meant = {static_cast<std::uint16_t>(words[0] & 0x3900),
                                    static_cast<std::uint16_t>(words[1] & 0x00ff), words[2]};
    REQUIRE(EncodeGripperAction(DecodeGripperAction(words)) == meant);
    const auto status = DecodeGripperStatus(words);
    if ((words[0] >> 12 & 3) == 2) {
      REQUIRE(std::get<DecodeError>(status).reason ==
              "activation state (gSTA) is 2; allowed: 0, 1, 3");
    } else {
      const GripperRegisters told = {static_cast<std::uint16_t>(words[0] & 0xf900), words[1],
                                     words[2]};
      REQUIRE(EncodeGripperStatus(std::get<GripperStatus>(status)) == told);
    }
  }
}

TEST_CASE("Openings, speeds and forces become bytes and back", "[unit]") {
  const GripperScale scale = PaperScale();
  CHECK(scale.PositionOf(0.085) == 3);
  CHECK(scale.PositionOf(0.0) == 230);
  CHECK(scale.OpeningOf(3) == 0.085);
  CHECK(scale.OpeningOf(230) == 0.0);
  CHECK(scale.OpeningOf(0) == 0.085);
  CHECK(scale.OpeningOf(255) == 0.0);
  CHECK(scale.PositionOf(1.0) == 3);
  CHECK(scale.PositionOf(-1.0) == 230);
  CHECK(scale.PositionOf(std::numeric_limits<double>::quiet_NaN()) == 3);
  constexpr double kHalfCount = 0.085 / 227 / 2 + 1e-12;
  for (double opening = 0; opening <= 0.085; opening += 0.0001) {
    REQUIRE(std::abs(scale.OpeningOf(scale.PositionOf(opening)) - opening) <= kHalfCount);
  }
  for (int count = 3; count <= 230; ++count) {
    REQUIRE(scale.PositionOf(scale.OpeningOf(static_cast<std::uint8_t>(count))) == count);
  }
  CHECK(scale.SpeedOf(0.020) == 0);
  CHECK(scale.SpeedOf(0.150) == 255);
  CHECK(scale.SpeedOf(9.0) == 255);
  CHECK(scale.ForceOf(20.0) == 0);
  CHECK(scale.ForceOf(235.0) == 255);
  CHECK(scale.ForceOf(0.0) == 0);
  CHECK(scale.ForceOf(std::numeric_limits<double>::quiet_NaN()) == 0);
  for (int byte = 0; byte <= 255; ++byte) {
    const auto b = static_cast<std::uint8_t>(byte);
    REQUIRE(scale.SpeedOf(scale.SpeedFrom(b)) == byte);
    REQUIRE(scale.ForceOf(scale.ForceFrom(b)) == byte);
  }
}

TEST_CASE("Every fault code of the manual has a text", "[unit]") {
  CHECK(GripperFaultText(0).empty());
  CHECK(GripperFaultText(kGripperFaultSilence) == "no communication for 1 s");
  for (const int code : {5, 7, 8, 9, 10, 11, 12, 13, 14, 15}) {
    CHECK(GripperFaultText(code).find("unknown") == std::string::npos);
    CHECK_FALSE(GripperFaultText(code).empty());
  }
  CHECK(GripperFaultText(3) == "unknown fault 3");
}

}  // namespace
}  // namespace tubetwin
