// The I/O port against the vendor's published server (MotoROS 1.9.12, IoServer.c), address by
// address, as its ranges for a YRC1000 document it.

#include "tests/codecs/hex.h"
#include "tests/emulators/arm_rig.h"
#include "tests/support/catch.h"

namespace tubetwin::test {
namespace {

namespace sm = simple_message;

/// Answered with success exactly when the result is 0.
template <typename Reply>
Reply Ask(ArmRig::Socket& port, const sm::Body& request) {
  const sm::Message message = port.Ask(sm::Request(request));
  const auto reply = std::get<Reply>(message.body);
  CHECK(message.comm == sm::Comm::kReply);
  CHECK(message.reply == (reply.result == 0 ? sm::ReplyCode::kSuccess : sm::ReplyCode::kFailure));
  return reply;
}

struct Address {
  std::int32_t address;
  bool readable, writable;
};

constexpr Address kBits[] = {
    {0, false, false},      {9, false, false},       {10, true, false},
    {17, true, false},      {18, false, false},      {19, false, false},
    {5127, true, false},    {5128, false, false},    {5130, false, false},
    {10007, false, false},  {10010, true, true},     {10018, false, false},
    {15127, true, true},    {15130, false, false},   {20007, false, false},
    {20010, true, false},   {25127, true, false},    {25130, false, false},
    {27007, false, false},  {27010, true, true},     {29567, true, true},
    {29570, false, false},  {30007, false, false},   {30010, true, false},
    {35127, true, false},   {35130, false, false},   {37007, false, false},
    {37010, true, false},   {39567, true, false},    {39570, false, false},
    {40010, true, false},   {42567, true, false},    {42570, false, false},
    {50007, false, false},  {50010, true, false},    {55127, true, false},
    {55130, false, false},  {60007, false, false},   {60010, true, true},
    {60647, true, true},    {60650, false, false},   {70010, true, false},
    {79997, true, false},   {80007, false, false},   {80010, true, false},
    {85127, true, false},   {85130, false, false},   {87010, true, false},
    {87207, true, false},   {87210, false, false},   {999997, false, false},
    {1000000, true, true},  {1000008, false, false}, {1000557, true, true},
    {1000560, true, false}, {1000997, true, false},  {1001000, false, false},
    {-1, false, false},     {-10, false, false},     {2147483647, false, false},
};

constexpr Address kGroups[] = {
    {0, false, false},      {1, true, false},     {512, true, false},    {513, false, false},
    {1000, false, false},   {1001, true, true},   {1512, true, true},    {1513, false, false},
    {2001, true, false},    {2512, true, false},  {2700, false, false},  {2701, true, true},
    {2956, true, true},     {2957, false, false}, {3001, true, false},   {3701, true, false},
    {4256, true, false},    {5001, true, false},  {5512, true, false},   {6001, true, true},
    {6064, true, true},     {6065, false, false}, {7001, true, false},   {7999, true, false},
    {8001, true, false},    {8512, true, false},  {8720, true, false},   {8721, false, false},
    {100000, true, true},   {100055, true, true}, {100056, true, false}, {100099, true, false},
    {100100, false, false}, {-1, false, false},
};

constexpr Address kRegisters[] = {
    {0, true, true},       {123, true, true},      {559, true, true},      {560, true, false},
    {999, true, false},    {1000, false, false},   {999999, false, false}, {1000000, true, true},
    {1000559, true, true}, {1000560, true, false}, {1000999, true, false}, {1001000, false, false},
    {-1, false, false},
};

}  // namespace

TEST_CASE("bits are read and written where the vendor's server does", "[unit]") {
  ArmRig rig;
  ArmRig::Socket io = rig.Io();
  for (const Address& one : kBits) {
    CAPTURE(one.address);
    CHECK(Ask<sm::WriteBitReply>(io, sm::WriteBit{one.address, 1}).result ==
          (one.writable ? 0 : sm::kIoWriteAddress));
    const auto read = Ask<sm::ReadBitReply>(io, sm::ReadBit{one.address});
    CHECK(read.result == (one.readable ? 0 : sm::kIoReadAddress));
    if (one.writable) CHECK(read.value == 1);
    // The address is looked at before the value.
    CHECK(Ask<sm::WriteBitReply>(io, sm::WriteBit{one.address, 2}).result ==
          (one.writable ? sm::kIoWriteValue : sm::kIoWriteAddress));
  }
}

TEST_CASE("groups are read and written where the vendor's server does", "[unit]") {
  ArmRig rig;
  ArmRig::Socket io = rig.Io();
  for (const Address& one : kGroups) {
    CAPTURE(one.address);
    CHECK(Ask<sm::WriteGroupReply>(io, sm::WriteGroup{one.address, 0xA5}).result ==
          (one.writable ? 0 : sm::kIoWriteAddress));
    const auto read = Ask<sm::ReadGroupReply>(io, sm::ReadGroup{one.address});
    CHECK(read.result == (one.readable ? 0 : sm::kIoReadAddress));
    if (one.writable) CHECK(read.value == 0xA5);
    CHECK(Ask<sm::WriteGroupReply>(io, sm::WriteGroup{one.address, 256}).result ==
          (one.writable ? sm::kIoWriteValue : sm::kIoWriteAddress));
  }
  // Ten times this passes 32 bits and is 10014: allowed, and no group to the controller itself.
  constexpr std::int32_t kWrapped = 429497731;
  CHECK(Ask<sm::ReadGroupReply>(io, sm::ReadGroup{kWrapped}).result == sm::kIoReadFailure);
  CHECK(Ask<sm::WriteGroupReply>(io, sm::WriteGroup{kWrapped, 1}).result == sm::kIoWriteFailure);
}

TEST_CASE("registers are numbers with and without their offset", "[unit]") {
  ArmRig rig;
  ArmRig::Socket io = rig.Io();
  for (const Address& one : kRegisters) {
    CAPTURE(one.address);
    CHECK(Ask<sm::WriteRegisterReply>(io, sm::WriteRegister{one.address, 65535}).result ==
          (one.writable ? 0 : sm::kIoWriteAddress));
    const auto read = Ask<sm::ReadRegisterReply>(io, sm::ReadRegister{one.address});
    CHECK(read.result == (one.readable ? 0 : sm::kIoReadAddress));
    if (one.writable) CHECK(read.value == 65535);
    CHECK(Ask<sm::WriteRegisterReply>(io, sm::WriteRegister{one.address, 65536}).result ==
          (one.writable ? sm::kIoWriteValue : sm::kIoWriteAddress));
  }
  // A register is read as a bit whole, and as part of a group shifted.
  Ask<sm::WriteRegisterReply>(io, sm::WriteRegister{7, 0});
  for (int i = 0; i < 8; ++i) Ask<sm::WriteRegisterReply>(io, sm::WriteRegister{i, 0});
  Ask<sm::WriteRegisterReply>(io, sm::WriteRegister{3, 0x101});
  CHECK(Ask<sm::ReadBitReply>(io, sm::ReadBit{1000003}).value == 0x101);
  CHECK(Ask<sm::ReadGroupReply>(io, sm::ReadGroup{100000}).value == 0x101 << 3);
}

TEST_CASE("the controller's status is live under its addresses", "[unit]") {
  using Emulator = ArmEmulator;
  const auto [address, off, change, on] = GENERATE(table<int, int, void (*)(Emulator&), int>({
      {50010, 0, [](Emulator& e) { e.Alarm(1325); }, 1},
      {50011, 0, [](Emulator& e) { e.Alarm(4315); }, 1},
      {50010, 0, [](Emulator& e) { e.Alarm(4315); }, 0},
      {50012, 0, [](Emulator& e) { e.Alarm(8004); }, 1},
      {50013, 0, [](Emulator& e) { e.Alarm(9001); }, 1},
      {50053, 0, [](Emulator& e) { e.SetPlay(false); }, 1},
      {50054, 1, [](Emulator& e) { e.SetPlay(false); }, 0},
      {50056, 1, [](Emulator& e) { e.SetRemote(false); }, 0},
      {80011, 1, [](Emulator& e) { e.SetRemote(false); }, 0},
      {50070, 1, [](Emulator& e) { e.SetRemote(false); }, 0},
      {50070, 1, [](Emulator& e) { e.Alarm(4315); }, 0},
      {50071, 0, [](Emulator& e) { e.Hold(true); }, 1},
      {50073, 1, [](Emulator& e) { e.SwitchServo(false); }, 0},
      {80026, 1, [](Emulator& e) { e.EmergencyStop(); }, 0},
      {80025, 1, [](Emulator& e) { e.EmergencyStop(); }, 1},
      {81702, 0, [](Emulator& e) { e.ProtectiveStop(); }, 1},
      // OUT#889 stays on whatever becomes of the job.
      {11120, 1, [](Emulator& e) { e.Alarm(4315); }, 1},
      {11122, 1, [](Emulator&) {}, 1},
      {11123, 1, [](Emulator&) {}, 1},
      {11124, 1, [](Emulator& e) { e.CloseMotion(); }, 0},
      {11125, 0, [](Emulator&) {}, 0},
      {11126, 1, [](Emulator&) {}, 1},
  }));
  CAPTURE(address);
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion(), io = rig.Io();
  Ready(motion);
  CHECK(Ask<sm::ReadBitReply>(io, sm::ReadBit{address}).value == off);
  change(rig.emulator);
  rig.Run(2);
  CHECK(Ask<sm::ReadBitReply>(io, sm::ReadBit{address}).value == on);
}

TEST_CASE("a job is ended, and kept from being believed, by its outputs", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion(), io = rig.Io();
  Ready(motion);
  CHECK(Ask<sm::WriteBitReply>(io, sm::WriteBit{11120, 0}).result == 0);
  CHECK(Command(motion, sm::Command::kCheckMotionReady).subcode ==
        static_cast<int>(sm::NotReady::kWaiting));
  Ask<sm::WriteBitReply>(io, sm::WriteBit{11120, 1});
  CHECK(Command(motion, sm::Command::kCheckMotionReady).result == sm::Result::kSuccess);
  Ask<sm::WriteBitReply>(io, sm::WriteBit{11121, 1});
  rig.Run(3);
  CHECK_FALSE(rig.emulator.controller().running());
  CHECK(Ask<sm::ReadBitReply>(io, sm::ReadBit{11121}).value == 0);
}

TEST_CASE("the I/O port reads requests by their id alone", "[unit]") {
  ArmRig rig;
  ArmRig::Socket io = rig.Io();
  const auto ask = [&](const std::string& hex, std::size_t size) {
    io.Send(FromHex(hex));
    return ToHex(io.Receive(size));
  };
  const auto hex = [](const char* text) { return ToHex(FromHex(text)); };
  // Length, comm type and reply code of a bit's request: whatever they are.
  const std::string on = hex("14000000 d4070000 03000000 01000000 00000000 00000000");
  CHECK(ask("10000000 d3070000 02000000 00000000 1a270000", 24) == on);
  CHECK(ask("ffffffff d3070000 00000000 07000000 1a270000", 24) == on);
  CHECK(ask("00000000 d3070000 03000000 01000000 1a270000", 24) == on);
  const std::string size = hex("48000000 d2070000 03000000 01000000 03000000 b90b0000 00*52");
  CHECK(ask("10000000 d3070000 02000000 00000000", 76) == size);
  CHECK(ask("10000000 d5070000 02000000 00000000 1a270000", 76) == size);
  const std::string type = hex("48000000 d2070000 03000000 01000000 03000000 bb0b0000 00*52");
  CHECK(ask("0c000000 01000000 02000000 00000000", 76) == type);
  CHECK(ask("10000000 d4070000 02000000 00000000 1a270000", 76) == type);
  CHECK(ask("10000000 e4070000 02000000 00000000", 76) == type);
  // Two at once.
  CHECK(ask("10000000 d3070000 02000000 00000000 1a270000 10000000 d3070000 02000000 00000000 "
            "1a270000",
            48) == on + " " + on);
}

TEST_CASE("an I/O newcomer takes the place only while no motion waits", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion(), first = rig.Io(), second = rig.Io();
  CHECK(first.closed());
  Ready(motion);
  const JointVector q = rig.arm.Servo().q;
  Stream(motion, 0, 0.0, q);
  Stream(motion, 1, 1.0, q + 0.05 * kOnes);
  ArmRig::Socket third = rig.Io();
  CHECK(third.closed());
  CHECK(Ask<sm::ReadBitReply>(second, sm::ReadBit{11126}).value == 1);
  second.Close();
  Command(motion, sm::Command::kStopMotion);
  rig.Run(3);
  ArmRig::Socket fourth = rig.Io();
  CHECK(Ask<sm::ReadBitReply>(fourth, sm::ReadBit{11126}).value == 1);
}

}  // namespace tubetwin::test
