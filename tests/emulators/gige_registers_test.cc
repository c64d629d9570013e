#include "hw_bridge/emulators/photoneo/gige_registers.h"

#include "hw_bridge/codecs/big_endian.h"
#include "models/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

constexpr std::uint32_t kHere = 0x7f000001;

struct Bench {
  GvcpStatus Status(GvcpCommand command, const std::string& data, bool controller = true) {
    return Ask(command, data, controller).first;
  }
  std::pair<GvcpStatus, std::string> Ask(GvcpCommand command, const std::string& data,
                                         bool controller = true) {
    return registers.Do({static_cast<std::uint16_t>(command), true, 1, data}, controller);
  }
  static std::string Words(std::initializer_list<std::uint32_t> words) {
    std::string out;
    for (const std::uint32_t word : words) PutU32(out, word);
    return out;
  }
  GvcpStatus Write(std::uint32_t address, std::uint32_t value, bool controller = true) {
    return Status(GvcpCommand::kWriteRegister, Words({address, value}), controller);
  }
  GigeRegisters registers{160, 120, kHere, 16000};
};

TEST_CASE("The description is where the first URL says, whole", "[unit]") {
  Bench bench;
  const auto [status, url] = bench.Ask(GvcpCommand::kReadMemory, Bench::Words({gige::kUrl, 512}));
  CHECK(status == GvcpStatus::kSuccess);
  CHECK_THAT(url.substr(4), StartsWith("Local:scanner.xml;10000;"));
  const std::uint32_t size =
      static_cast<std::uint32_t>(std::stoul(url.substr(4 + 24, 8), nullptr, 16));
  std::string xml;
  while (xml.size() < size) {
    const auto at = static_cast<std::uint32_t>(0x10000 + xml.size());
    const auto [read, part] = bench.Ask(GvcpCommand::kReadMemory, Bench::Words({at, 512}));
    REQUIRE(read == GvcpStatus::kSuccess);
    REQUIRE(part.size() == 516);
    xml += part.substr(4);
  }
  xml.resize(size);
  CHECK_THAT(xml, StartsWith("<?xml") && Contains("DeviceModelName") &&
                      Contains("</RegisterDescription>"));
}

TEST_CASE("No address and no value reaches beyond the registers", "[unit]") {
  Bench bench;
  // The datagram that ended the camera library's own fake camera.
  CHECK(bench.Status(GvcpCommand::kReadRegister, Bench::Words({0x12000})) ==
        GvcpStatus::kInvalidAddress);
  CHECK(bench.Status(GvcpCommand::kReadRegister, Bench::Words({0xfffffffc})) ==
        GvcpStatus::kInvalidAddress);
  CHECK(bench.Status(GvcpCommand::kReadRegister, Bench::Words({2})) == GvcpStatus::kBadAlignment);
  CHECK(bench.Status(GvcpCommand::kReadMemory, Bench::Words({0xffff0000, 4})) ==
        GvcpStatus::kInvalidAddress);
  CHECK(bench.Status(GvcpCommand::kReadMemory, Bench::Words({0, 0xfffc})) ==
        GvcpStatus::kInvalidParameter);
  CHECK(bench.Status(GvcpCommand::kReadMemory, Bench::Words({0, 0})) ==
        GvcpStatus::kInvalidParameter);
  CHECK(bench.Status(GvcpCommand::kWriteMemory, Bench::Words({0xfffffffc, 1, 2})) ==
        GvcpStatus::kInvalidAddress);
  CHECK(bench.Write(0x10000, 1) == GvcpStatus::kInvalidAddress);
  for (const std::uint32_t address : {gige::kVendor, gige::kWidth, gige::kUrl, gige::kCapability}) {
    CHECK(bench.Write(address, 1) == GvcpStatus::kWriteProtect);
  }
  CHECK(bench.Write(gige::kPacketSize, 100) == GvcpStatus::kInvalidParameter);
  CHECK(bench.Write(gige::kHeartbeat, 0) == GvcpStatus::kInvalidParameter);
  CHECK(bench.Write(gige::kUserSet, 3) == GvcpStatus::kInvalidParameter);
  CHECK(bench.Write(gige::kPixelFormat, 0x01080001) == GvcpStatus::kInvalidParameter);
  CHECK(bench.Ask(static_cast<GvcpCommand>(0x1234), "").first == GvcpStatus::kNotImplemented);
}

TEST_CASE("Only who has control writes", "[unit]") {
  Bench bench;
  CHECK(bench.Write(gige::kTrigger, 1, false) == GvcpStatus::kAccessDenied);
  CHECK(bench.registers.Get(gige::kTrigger) == 0);
  CHECK(bench.Write(gige::kTrigger, 1) == GvcpStatus::kSuccess);
  CHECK(bench.registers.Get(gige::kTrigger) == 1);
  const auto [status, index] =
      bench.Ask(GvcpCommand::kWriteRegister, Bench::Words({gige::kTrigger, 0, gige::kVendor, 0}));
  CHECK(status == GvcpStatus::kWriteProtect);
  CHECK(index == Bench::Words({1}));  // So many were done.
}

TEST_CASE("User sets keep what was set, and the one as shipped stays so", "[unit]") {
  Bench bench;
  const std::uint32_t shipped = bench.registers.Get(gige::kExposure);
  CHECK(bench.Write(gige::kUserSetSave, 1) == GvcpStatus::kWriteProtect);
  CHECK(bench.Write(gige::kUserSet, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kExposure, 7) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSetSave, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSet, 0) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSetLoad, 1) == GvcpStatus::kSuccess);
  CHECK(bench.registers.Get(gige::kExposure) == shipped);
  CHECK(bench.Write(gige::kUserSet, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSetLoad, 1) == GvcpStatus::kSuccess);
  CHECK(bench.registers.Get(gige::kExposure) == 7);
  CHECK(bench.Write(gige::kUserSetReset, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSetLoad, 1) == GvcpStatus::kSuccess);
  CHECK(bench.registers.Get(gige::kExposure) == shipped);
}

TEST_CASE("Random requests are answered or refused, and the scanner stays what it is", "[unit]") {
  Bench bench;
  for (std::uint64_t round = 0; round < 20000; ++round) {
    RandomStream stream(1, round, "gvcp garbage");
    constexpr std::uint16_t kCommands[] = {0x02, 0x40, 0x80, 0x82, 0x84, 0x86, 0x99};
    std::string data(stream.Index(48), '\0');
    for (char& byte : data) byte = static_cast<char>(stream.Index(stream.Index(2) == 0 ? 3 : 256));
    const auto answer =
        bench.registers.Do({kCommands[stream.Index(7)], true, 1, data}, stream.Index(2) == 0);
    CHECK(answer.second.size() <= kMaxGvcpData);
  }
  CHECK(bench.registers.Get(gige::kWidth) == 160);
  CHECK(bench.registers.Get(gige::kHeight) == 120);
}

}  // namespace
}  // namespace tubetwin
