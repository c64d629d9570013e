// The High-Speed Ethernet Server, request by request, as the protocol's table documents it
// (reference: manuals 160766-1CD and 178942-1CD by way of public clients).

#include "hw_bridge/codecs/little_endian.h"
#include "tests/emulators/arm_rig.h"
#include "tests/support/catch.h"

namespace tubetwin::test {
namespace {

constexpr std::uint8_t kAll = hses::kGetAll, kOne = hses::kGetOne, kPutAll = hses::kSetAll,
                       kPutOne = hses::kSetOne, kMany = hses::kReadPlural,
                       kPutMany = hses::kWritePlural;

class Supervisor {
 public:
  hses::Answer Ask(std::uint16_t command, std::uint16_t instance, std::uint8_t attribute,
                   std::uint8_t service, const std::string& data = {}) {
    const std::string bytes = rig.AskHses(hses::Encode(hses::Request{
        hses::Division::kRobot, 0, ++id_, 0, command, instance, attribute, service, data}));
    const auto decoded = hses::DecodeAnswer(bytes);
    REQUIRE(std::holds_alternative<hses::Answer>(decoded));
    const auto answer = std::get<hses::Answer>(decoded);
    CHECK(answer.id == id_);
    CHECK(answer.service == service);
    CHECK(answer.block == 0x80000000);
    return answer;
  }

  ArmRig rig;

 private:
  std::uint8_t id_ = 0;
};

struct Reading {
  std::uint16_t command, instance;
  std::uint8_t attribute, service;
  std::size_t size;         ///< Of the data; 0: refused.
  std::uint16_t added = 0;  ///< Why.
};

const Reading kReadings[] = {
    {0x70, 1, 0, kAll, 60},
    {0x70, 4, 0, kAll, 60},
    {0x70, 5, 0, kAll, 0, 0xA001},
    {0x70, 0, 0, kAll, 0, 0xA001},
    {0x70, 1, 1, kOne, 4},
    {0x70, 1, 4, kOne, 16},
    {0x70, 1, 5, kOne, 32},
    {0x70, 1, 6, kOne, 0, 0xA002},
    {0x70, 1, 0, kOne, 0, 0xA002},
    {0x70, 1, 1, kAll, 0, 0xA002},
    {0x70, 1, 0, kPutAll, 0, 0xA002},
    {0x71, 1, 0, kAll, 60},
    {0x71, 100, 0, kAll, 60},
    {0x71, 101, 0, kAll, 0, 0xA001},
    {0x71, 1001, 2, kOne, 4},
    {0x71, 4100, 5, kOne, 32},
    {0x71, 5001, 0, kAll, 0, 0xA001},
    {0x72, 1, 0, kAll, 8},
    {0x72, 1, 1, kOne, 4},
    {0x72, 1, 2, kOne, 4},
    {0x72, 1, 3, kOne, 0, 0xA002},
    {0x72, 2, 0, kAll, 0, 0xA001},
    {0x73, 1, 0, kAll, 44},
    {0x73, 1, 1, kOne, 32},
    {0x73, 1, 4, kOne, 4},
    {0x73, 2, 0, kAll, 0, 0xA001},
    {0x74, 1, 0, kAll, 32},
    {0x74, 1, 6, kOne, 4},
    {0x74, 7, 0, kAll, 0, 0xA001},
    {0x75, 1, 0, kAll, 52},
    {0x75, 101, 0, kAll, 52},
    {0x75, 1, 6, kOne, 4},
    {0x75, 1, 13, kOne, 4},
    {0x75, 1, 14, kOne, 0, 0xA002},
    {0x75, 2, 0, kAll, 0, 0xA001},
    {0x76, 1, 0, kAll, 32},
    {0x76, 1, 8, kOne, 4},
    {0x77, 1, 0, kAll, 32},
    {0x77, 2, 0, kAll, 0, 0xA001},
    {0x78, 1001, 1, kOne, 1},
    {0x78, 1001, 0, kAll, 1},
    {0x78, 1001, 1, kAll, 1},
    {0x78, 1001, 2, kOne, 0, 0xA002},
    {0x78, 600, 1, kOne, 0, 0xA001},
    {0x79, 0, 1, kOne, 2},
    {0x79, 999, 1, kOne, 2},
    {0x79, 1000, 1, kOne, 0, 0xA001},
    {0x7A, 0, 1, kOne, 1},
    {0x7A, 99, 1, kAll, 1},
    {0x7A, 100, 1, kOne, 0, 0xA001},
    {0x7B, 0, 1, kOne, 2},
    {0x7C, 0, 1, kOne, 4},
    {0x7D, 0, 1, kAll, 4},
    {0x7E, 0, 1, kOne, 16},
    {0x7F, 0, 0, kAll, 52},
    {0x7F, 0, 13, kOne, 4},
    {0x7F, 0, 14, kOne, 0, 0xA002},
    {0x7F, 0, 1, kAll, 0, 0xA002},
    {0x80, 0, 0, kAll, 36},
    {0x81, 0, 9, kOne, 4},
    {0x88, 1, 0, kAll, 28},
    {0x88, 1, 2, kOne, 12},
    {0x89, 11, 0, kAll, 48},
    {0x89, 11, 2, kOne, 16},
    {0x89, 12, 0, kAll, 0, 0xA001},
    {0x8C, 0, 1, kOne, 32},
    {0x8C, 99, 0, kAll, 32},
    {0x8C, 100, 1, kOne, 0, 0xA001},
    {0x30A, 1, 0, kAll, 268},
    {0x30A, 4, 7, kOne, 96},
    {0x30A, 5, 0, kAll, 0, 0xA001},
    {0x30A, 1, 9, kOne, 0, 0xA002},
    {0x30B, 4100, 0, kAll, 268},
    {0x30B, 101, 0, kAll, 0, 0xA001},
};

struct Writing {
  std::uint16_t command, instance;
  std::uint8_t attribute, service;
  std::string data;
  std::uint16_t added;  ///< 0: done.
};

std::string Bytes(std::size_t count) { return std::string(count, '\x01'); }

const Writing kWritings[] = {
    {0x78, 2701, 1, kPutOne, Bytes(1), 0},
    {0x78, 2956, 1, kPutAll, Bytes(1), 0},
    {0x78, 1001, 1, kPutOne, Bytes(1), 0xA001},
    {0x78, 2701, 1, kPutOne, Bytes(2), 0xB003},
    {0x79, 559, 1, kPutOne, Bytes(2), 0},
    {0x79, 560, 1, kPutOne, Bytes(2), 0xA001},
    {0x7A, 5, 1, kPutOne, Bytes(1), 0},
    {0x7A, 5, 0, kPutAll, Bytes(1), 0},
    {0x7A, 5, 1, kPutOne, Bytes(4), 0xB003},
    {0x7B, 5, 1, kPutOne, Bytes(2), 0},
    {0x7B, 6, 1, kPutOne, Bytes(4), 0xB003},
    {0x7B, 6, 1, kPutOne, Bytes(1), 0xB003},
    {0x7C, 5, 1, kPutOne, Bytes(4), 0},
    {0x7D, 5, 1, kPutAll, Bytes(4), 0},
    {0x7E, 5, 1, kPutOne, Bytes(16), 0},
    {0x7E, 5, 1, kPutOne, Bytes(32), 0xB003},
    {0x8C, 6, 1, kPutOne, Bytes(32), 0},
    {0x8C, 6, 1, kPutOne, Bytes(16), 0xB003},
    {0x7F, 5, 0, kPutAll, Bytes(52), 0},
    {0x7F, 5, 6, kPutOne, Bytes(4), 0},
    {0x7F, 5, 0, kPutOne, Bytes(52), 0xA002},
    {0x7F, 5, 0, kPutAll, Bytes(48), 0xB003},
    {0x80, 5, 0, kPutAll, Bytes(36), 0},
    {0x81, 5, 0, kPutAll, Bytes(36), 0},
    {0x82, 1, 1, kPutOne, hses::Word(1), 0},
    {0x82, 2, 1, kPutOne, hses::Word(1), 0},
    {0x82, 3, 1, kPutOne, hses::Word(1), 0xA001},
    {0x82, 1, 1, kPutOne, hses::Word(2), 0xB004},
    {0x82, 1, 1, kOne, hses::Word(1), 0xA002},
    {0x82, 1, 2, kPutOne, hses::Word(1), 0xA002},
    {0x83, 1, 1, kPutOne, hses::Word(2), 0},
    {0x83, 2, 1, kPutAll, hses::Word(1), 0},
    {0x83, 3, 1, kPutOne, hses::Word(1), 0},
    {0x83, 4, 1, kPutOne, hses::Word(1), 0xA001},
    {0x83, 2, 1, kPutOne, hses::Word(3), 0xB004},
    {0x83, 2, 1, kPutOne, Bytes(3), 0xB003},
    {0x84, 2, 1, kPutOne, hses::Word(2), 0},
    {0x84, 2, 1, kPutOne, hses::Word(4), 0xB004},
    {0x84, 1, 1, kPutOne, hses::Word(1), 0xA001},
    {0x85, 1, 1, kPutOne, Bytes(30), 0},
    {0x85, 1, 1, kPutOne, Bytes(33), 0xB003},
    {0x86, 2, 1, kPutOne, hses::Word(1), 0xA001},
    {0x86, 1, 1, kPutOne, hses::Word(2), 0xB004},
    {0x86, 1, 1, kPutOne, hses::Word(1), 0},
    // From here on the job runs.
    {0x86, 1, 1, kPutOne, hses::Word(1), 0x2010},
    {0x87, 1, 0, kPutAll, hses::JobSelection("INIT_ROS", 0), 0x2010},
    {0x8A, 1, 1, kPutAll, Bytes(104), 0x2010},
    {0x8B, 1, 1, kPutAll, Bytes(88), 0x2010},
    {0x8B, 2, 0, kPutAll, Bytes(88), 0x2010},
};

struct PluralCase {
  std::uint16_t command, instance;
  std::uint8_t service;
  std::uint32_t count;
  std::size_t size;  ///< Of an element.
  std::uint16_t added;
};

const PluralCase kPlurals[] = {
    {0x300, 1001, kMany, 2, 1, 0},      {0x300, 1001, kMany, 3, 1, 0xB004},
    {0x300, 1001, kMany, 0, 1, 0xB004}, {0x300, 512, kMany, 2, 1, 0xA001},
    {0x300, 2701, kPutMany, 2, 1, 0},   {0x300, 1001, kPutMany, 2, 1, 0xA001},
    {0x301, 0, kMany, 237, 2, 0},       {0x301, 0, kMany, 238, 2, 0xB004},
    {0x301, 0, kPutMany, 3, 2, 0},      {0x302, 0, kMany, 100, 1, 0},
    {0x302, 2, kMany, 100, 1, 0xA001},  {0x303, 0, kMany, 10, 2, 0},
    {0x304, 0, kMany, 100, 4, 0},       {0x304, 0, kMany, 119, 4, 0xB004},
    {0x304, 7, kPutMany, 5, 4, 0},      {0x305, 0, kMany, 3, 4, 0},
    {0x306, 0, kMany, 29, 16, 0},       {0x306, 0, kMany, 30, 16, 0xB004},
    {0x307, 0, kMany, 9, 52, 0},        {0x307, 0, kMany, 10, 52, 0xB004},
    {0x307, 0, kPutMany, 2, 52, 0},     {0x308, 0, kMany, 13, 36, 0},
    {0x309, 0, kMany, 13, 36, 0},       {0x30C, 0, kMany, 14, 32, 0},
    {0x30C, 0, kMany, 15, 32, 0xB004},  {0x30C, 8, kPutMany, 2, 32, 0},
};

}  // namespace

TEST_CASE("supervision reads whole or by attribute", "[unit]") {
  Supervisor supervisor;
  for (const Reading& one : kReadings) {
    CAPTURE(one.command, one.instance, int{one.attribute}, int{one.service});
    const auto answer = supervisor.Ask(one.command, one.instance, one.attribute, one.service);
    CHECK(answer.status == (one.size > 0 ? hses::kOk : hses::kRefused));
    CHECK(answer.added_status == one.added);
    CHECK(answer.data.size() == one.size);
  }
  // An attribute is a part of the whole.
  supervisor.rig.emulator.Alarm(4315);
  const std::string whole = supervisor.Ask(0x70, 1, 0, kAll).data;
  CHECK(supervisor.Ask(0x70, 1, 1, kOne).data == whole.substr(0, 4));
  CHECK(supervisor.Ask(0x70, 1, 5, kOne).data == whole.substr(28, 32));
  CHECK_THAT(supervisor.Ask(0x70, 1, 5, kOne).data, Catch::Matchers::Contains("COLLISION DETECT"));
  CHECK(Le32At(supervisor.Ask(0x72, 1, 2, kOne).data, 0) == hses::Status::kAlarm);
}

TEST_CASE("supervision writes, and refuses with the documented codes", "[unit]") {
  Supervisor supervisor;
  for (const Writing& one : kWritings) {
    CAPTURE(one.command, one.instance, int{one.attribute}, int{one.service}, one.data.size());
    const auto answer =
        supervisor.Ask(one.command, one.instance, one.attribute, one.service, one.data);
    CHECK(answer.status == (one.added == 0 ? hses::kOk : hses::kRefused));
    CHECK(answer.added_status == one.added);
  }
  CHECK(supervisor.Ask(0x7A, 5, 1, kOne).data == Bytes(1));
  CHECK(supervisor.Ask(0x7F, 5, 0, kAll).data == Bytes(52));
  CHECK(Le32At(supervisor.Ask(0x72, 1, 1, kOne).data, 0) ==
        (hses::Status::kOneCycle | hses::Status::kRunning | hses::Status::kPlay |
         hses::Status::kCommandRemote));
  // Writing needs REMOTE, reading does not.
  supervisor.rig.emulator.SetRemote(false);
  CHECK(supervisor.Ask(0x7A, 5, 1, kPutOne, Bytes(1)).added_status == hses::kNotRemote);
  CHECK(supervisor.Ask(0x304, 5, 0, kPutMany, hses::Word(1) + Bytes(4)).added_status ==
        hses::kNotRemote);
  CHECK(supervisor.Ask(0x7A, 5, 1, kOne).status == hses::kOk);
}

TEST_CASE("supervision reads and writes several at once", "[unit]") {
  Supervisor supervisor;
  for (const PluralCase& one : kPlurals) {
    CAPTURE(one.command, one.instance, int{one.service}, one.count);
    const bool write = one.service == kPutMany;
    std::string data = hses::Word(one.count);
    if (write) data += Bytes(one.count * one.size);
    const auto answer = supervisor.Ask(one.command, one.instance, 0, one.service, data);
    CHECK(answer.status == (one.added == 0 ? hses::kOk : hses::kRefused));
    CHECK(answer.added_status == one.added);
    if (one.added == 0 && !write) {
      CHECK(answer.data.size() == 4 + one.count * one.size);
      CHECK(Le32At(answer.data, 0) == one.count);
    }
  }
  CHECK(supervisor.Ask(0x7C, 11, 1, kOne).data == Bytes(4));
  CHECK(supervisor.Ask(0x7C, 12, 1, kOne).data == std::string(4, '\0'));
  CHECK(supervisor.Ask(0x304, 0, 0, kMany, "abc").added_status == hses::kDataSize);
  CHECK(supervisor.Ask(0x304, 0, 0, kPutMany, hses::Word(2) + Bytes(4)).added_status ==
        hses::kDataSize);
  CHECK(supervisor.Ask(0x304, 0, 1, kMany, hses::Word(1)).added_status == hses::kNoAttribute);
  CHECK(supervisor.Ask(0x304, 0, 0, kAll, hses::Word(1)).added_status == hses::kNoAttribute);
}

TEST_CASE("a text variable is the same by 16 and by 32 characters", "[unit]") {
  Supervisor supervisor;
  const std::string longer = "more than sixteen characters";
  std::string slot = longer;
  slot.resize(32);
  REQUIRE(supervisor.Ask(0x8C, 7, 1, kPutOne, slot).status == hses::kOk);
  CHECK(supervisor.Ask(0x7E, 7, 1, kOne).data == "more than sixtee");
  REQUIRE(
      supervisor.Ask(0x7E, 7, 1, kPutOne, std::string("short") + std::string(11, '\0')).status ==
      hses::kOk);
  CHECK(supervisor.Ask(0x8C, 7, 1, kOne).data == std::string("short") + std::string(27, '\0'));
}

TEST_CASE("short values may be written in a slot of four bytes", "[unit]") {
  Supervisor supervisor;
  const auto put = [&supervisor](std::uint16_t command, std::uint32_t value) {
    return supervisor.Ask(command, 5, 1, kPutOne, hses::Word(value)).added_status;
  };
  const auto get = [&supervisor](std::uint16_t command) {
    return supervisor.Ask(command, 5, 1, kOne).data;
  };
  CHECK(put(0x7A, 7) == 0);
  CHECK(get(0x7A) == "\x07");
  CHECK(put(0x7B, 0xfffffffb) == 0);  // -5
  CHECK(get(0x7B) == "\xfb\xff");
  CHECK(put(0x79, 40000) == 0);
  CHECK(get(0x79) == "\x40\x9c");
  CHECK(put(0x7A, 256) == hses::kDataSize);  // More than it holds.
  CHECK(put(0x7A, 0xfffffffb) == hses::kDataSize);
  CHECK(put(0x7B, 0xffff0005) == hses::kDataSize);
  CHECK(put(0x7B, 0x00010005) == hses::kDataSize);
}

TEST_CASE("unknown commands and files are refused, not left without an answer", "[unit]") {
  Supervisor supervisor;
  for (const int command : {0x00, 0x6F, 0x8A, 0x8B, 0x8D, 0x2FF, 0x30D, 0xFFFF}) {
    CAPTURE(command);
    const auto answer = supervisor.Ask(static_cast<std::uint16_t>(command), 1, 0, kAll);
    CHECK(answer.status == hses::kCommandUndefined);
    CHECK(answer.added_status == hses::kNoCommand);
  }
  asio::io_context io;
  asio::ip::udp::socket socket(io, {asio::ip::make_address("127.0.0.1"), 0});
  socket.non_blocking(true);
  ArmRig& rig = supervisor.rig;
  CHECK(rig.emulator.hses_file_port() != rig.emulator.hses_port());
  socket.send_to(asio::buffer(hses::Encode(
                     hses::Request{hses::Division::kFile, 0, 9, 0, 0, 0, 0, 0x32, "*.JBI"})),
                 {asio::ip::make_address("127.0.0.1"),
                  static_cast<std::uint16_t>(rig.emulator.hses_file_port())});
  rig.Run(5);
  std::array<char, 512> bytes{};
  const std::size_t size = socket.receive(asio::buffer(bytes));
  const auto decoded = hses::DecodeAnswer(std::string_view(bytes.data(), size));
  const auto answer = std::get<hses::Answer>(decoded);
  CHECK(answer.division == hses::Division::kFile);
  CHECK(answer.id == 9);
  CHECK(answer.service == 0x32);
  CHECK(answer.status == hses::kCommandUndefined);
}

}  // namespace tubetwin::test
