#include "hw_bridge/emulators/photoneo/gige_registers.h"

#include <bit>

#include "hw_bridge/codecs/big_endian.h"
#include "models/base/random.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

constexpr std::uint32_t kHere = 0x7f000001;

struct RegisterBench {
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
  /// Of a component.
  GvcpStatus WriteBlock(ScanComponent component, std::uint32_t offset, std::uint32_t value) {
    return Write(gige::ComponentBlock(component) + offset, value);
  }
  GvcpStatus Enable(ScanComponent component, bool yes = true) {
    return WriteBlock(component, gige::kEnabled, yes ? 1 : 0);
  }
  std::string Read(std::uint32_t address, std::uint32_t size) {
    return Ask(GvcpCommand::kReadMemory, Words({address, size})).second.substr(4);
  }
  GigeRegisters registers{GigeDevice{160, 120, 1000.0, kHere, 1500, 9000}};
};

std::uint32_t Bits(float value) { return std::bit_cast<std::uint32_t>(value); }

TEST_CASE("The description is where the first URL says, whole", "[unit]") {
  RegisterBench bench;
  const auto [status, url] =
      bench.Ask(GvcpCommand::kReadMemory, RegisterBench::Words({gige::kUrl, 512}));
  CHECK(status == GvcpStatus::kSuccess);
  CHECK_THAT(url.substr(4), StartsWith("Local:scanner.xml;10000;"));
  const std::uint32_t size =
      static_cast<std::uint32_t>(std::stoul(url.substr(4 + 24, 8), nullptr, 16));
  std::string xml;
  while (xml.size() < size) {
    const auto at = static_cast<std::uint32_t>(0x10000 + xml.size());
    const auto [read, part] = bench.Ask(GvcpCommand::kReadMemory, RegisterBench::Words({at, 512}));
    REQUIRE(read == GvcpStatus::kSuccess);
    REQUIRE(part.size() == 516);
    xml += part.substr(4);
  }
  xml.resize(size);
  CHECK_THAT(xml, StartsWith("<?xml") && Contains("DeviceModelName") &&
                      Contains("</RegisterDescription>"));
}

TEST_CASE("No address and no value reaches beyond the registers", "[unit]") {
  RegisterBench bench;
  // The datagram that ended the camera library's own fake camera.
  CHECK(bench.Status(GvcpCommand::kReadRegister, RegisterBench::Words({0x12000})) ==
        GvcpStatus::kInvalidAddress);
  CHECK(bench.Status(GvcpCommand::kReadRegister, RegisterBench::Words({0xfffffffc})) ==
        GvcpStatus::kInvalidAddress);
  CHECK(bench.Status(GvcpCommand::kReadRegister, RegisterBench::Words({2})) ==
        GvcpStatus::kBadAlignment);
  CHECK(bench.Status(GvcpCommand::kReadMemory, RegisterBench::Words({0xffff0000, 4})) ==
        GvcpStatus::kInvalidAddress);
  CHECK(bench.Status(GvcpCommand::kReadMemory, RegisterBench::Words({0, 0xfffc})) ==
        GvcpStatus::kInvalidParameter);
  CHECK(bench.Status(GvcpCommand::kReadMemory, RegisterBench::Words({0, 0})) ==
        GvcpStatus::kInvalidParameter);
  CHECK(bench.Status(GvcpCommand::kWriteMemory, RegisterBench::Words({0xfffffffc, 1, 2})) ==
        GvcpStatus::kInvalidAddress);
  CHECK(bench.Write(0x10000, 1) == GvcpStatus::kInvalidAddress);
  for (const std::uint32_t address : {gige::kVendor, gige::kWidth, gige::kUrl, gige::kCapability}) {
    CHECK(bench.Write(address, 1) == GvcpStatus::kWriteProtect);
  }
  CHECK(bench.Write(gige::kPacketSize, 100) == GvcpStatus::kInvalidParameter);
  CHECK(bench.Write(gige::kHeartbeat, 0) == GvcpStatus::kInvalidParameter);
  CHECK(bench.Write(gige::kUserSet, 3) == GvcpStatus::kInvalidParameter);
  CHECK(bench.WriteBlock(ScanComponent::kRange, gige::kComponentId, 5) ==
        GvcpStatus::kWriteProtect);
  CHECK(bench.Write(gige::kSettingsEnd, 1) == GvcpStatus::kWriteProtect);
  CHECK(bench.Ask(static_cast<GvcpCommand>(0x1234), "").first == GvcpStatus::kNotImplemented);
}

TEST_CASE("Only who has control writes", "[unit]") {
  RegisterBench bench;
  CHECK(bench.Write(gige::kTriggerMode, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kTriggerSource, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kTrigger, 1, false) == GvcpStatus::kAccessDenied);
  CHECK(bench.registers.Get(gige::kTrigger) == 0);
  CHECK(bench.Write(gige::kTrigger, 1) == GvcpStatus::kSuccess);
  CHECK(bench.registers.Get(gige::kTrigger) == 1);
  const auto [status, index] = bench.Ask(
      GvcpCommand::kWriteRegister, RegisterBench::Words({gige::kTrigger, 0, gige::kVendor, 0}));
  CHECK(status == GvcpStatus::kWriteProtect);
  CHECK(index == RegisterBench::Words({1}));  // So many were done.
}

TEST_CASE("User sets keep what was set, and the one as shipped stays so", "[unit]") {
  RegisterBench bench;
  const std::uint32_t shipped = bench.registers.Get(gige::kExposure);
  CHECK(bench.Write(gige::kUserSetSave, 1) == GvcpStatus::kWriteProtect);
  CHECK(bench.Write(gige::kUserSet, 1) == GvcpStatus::kSuccess);
  const std::uint32_t longer = Bits(30.72f);
  CHECK(bench.Write(gige::kExposure, longer) == GvcpStatus::kSuccess);
  CHECK(bench.Enable(ScanComponent::kNormal) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kOutputMode, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSetSave, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSet, 0) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSetLoad, 1) == GvcpStatus::kSuccess);
  CHECK(bench.registers.Get(gige::kExposure) == shipped);
  CHECK(bench.registers.FrameSettings().components.size() == 1);
  CHECK(bench.registers.Get(gige::kPayloadSize) == 160 * 120 * 12);
  CHECK(bench.Write(gige::kUserSet, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSetLoad, 1) == GvcpStatus::kSuccess);
  CHECK(bench.registers.Get(gige::kExposure) == longer);
  CHECK(bench.registers.FrameSettings().components.size() == 2);
  CHECK(bench.registers.Get(gige::kPayloadSize) == 160 * 120 * (4 + 12) + 16);
  CHECK(bench.Write(gige::kUserSetReset, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSetLoad, 1) == GvcpStatus::kSuccess);
  CHECK(bench.registers.Get(gige::kExposure) == shipped);
}

TEST_CASE("What frames hold is what was enabled, in the order of ids", "[unit]") {
  RegisterBench bench;
  REQUIRE(bench.registers.FrameSettings().components.size() == 1);  // As shipped: the range.
  CHECK(bench.registers.Get(gige::kPayloadSize) == 160 * 120 * 12);
  CHECK(bench.Enable(ScanComponent::kNormal) == GvcpStatus::kSuccess);
  CHECK(bench.Enable(ScanComponent::kConfidence) == GvcpStatus::kSuccess);
  CHECK(bench.Enable(ScanComponent::kIntensity) == GvcpStatus::kSuccess);
  CHECK(bench.WriteBlock(ScanComponent::kNormal, gige::kEnabled, 2) ==
        GvcpStatus::kInvalidParameter);
  const GigeFrameSettings settings = bench.registers.FrameSettings();
  REQUIRE(settings.components.size() == 4);
  CHECK_FALSE(settings.multipart);
  std::uint16_t last = 0;
  for (const auto& each : settings.components) {
    CHECK(InfoOf(each.component).id > last);
    last = InfoOf(each.component).id;
    CHECK(bench.registers.Get(gige::ComponentBlock(each.component) + gige::kComponentId) == last);
  }
  CHECK(last == 0xff00);
  // Chunks have 8 bytes more each, parts have not.
  CHECK(bench.registers.Get(gige::kPayloadSize) == 160 * 120 * (2 + 12 + 1 + 12) + 4 * 8);
  CHECK(bench.Write(gige::kStreamConfiguration, gige::kMultipart) == GvcpStatus::kSuccess);
  CHECK(bench.registers.FrameSettings().multipart);
  CHECK(bench.registers.Get(gige::kPayloadSize) == 160 * 120 * (2 + 12 + 1 + 12));
  CHECK(bench.Enable(ScanComponent::kRange, false) == GvcpStatus::kSuccess);
  CHECK(bench.registers.FrameSettings().components.size() == 3);
  CHECK(bench.Write(gige::kStreamConfiguration, 0x80000000) == GvcpStatus::kInvalidParameter);
}

TEST_CASE("Each component has its own pixel formats", "[unit]") {
  RegisterBench bench;
  const auto format = [&bench](ScanComponent component, std::uint32_t value) {
    return bench.WriteBlock(component, gige::kPixelFormat, value) == GvcpStatus::kSuccess;
  };
  CHECK(format(ScanComponent::kNormal, kPixelCoord3dAc8));
  CHECK(format(ScanComponent::kNormal, kPixelCoord3dAbc32f));
  CHECK_FALSE(format(ScanComponent::kNormal, kPixelMono10));
  CHECK(format(ScanComponent::kIntensity, kPixelMono10));
  CHECK_FALSE(format(ScanComponent::kIntensity, 0x02180014));  // There is no colour.
  CHECK(format(ScanComponent::kConfidence, kPixelConfidence8));
  // The range's follows from the output mode.
  CHECK_FALSE(format(ScanComponent::kRange, kPixelCoord3dC32f));
  CHECK(bench.Write(gige::kOutputMode, 1) == GvcpStatus::kSuccess);
  CHECK(format(ScanComponent::kRange, kPixelCoord3dC32f));
  CHECK_FALSE(format(ScanComponent::kRange, kPixelCoord3dAbc32f));
  CHECK(bench.registers.Get(gige::kPayloadSize) == 160 * 120 * 4);
}

TEST_CASE("Packets are as large as the interface takes them", "[unit]") {
  RegisterBench bench;
  CHECK(bench.registers.Get(gige::kPacketSize) == 1500);
  CHECK(bench.Write(gige::kPacketSize, 1504) == GvcpStatus::kInvalidParameter);
  CHECK(bench.Write(gige::kPacketSize, 572) == GvcpStatus::kInvalidParameter);
  CHECK(bench.Write(gige::kPacketSize, 576) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kPacketSize, gige::kDoNotFragment | 1400) == GvcpStatus::kSuccess);
  // Pixels are little-endian, always.
  CHECK(bench.Write(gige::kPacketSize, 0x20000000 | 1400) == GvcpStatus::kInvalidParameter);
  CHECK(bench.Write(gige::kJumboFrames, 1) == GvcpStatus::kSuccess);
  CHECK(bench.registers.Get(gige::kLargestPacket) == 9000);
  CHECK(bench.Write(gige::kPacketSize, 9000) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kJumboFrames, 0) == GvcpStatus::kSuccess);
  CHECK(bench.registers.Get(gige::kPacketSize) == 1500);
}

TEST_CASE("Only a scanner that waits for software triggers takes one", "[unit]") {
  RegisterBench bench;
  CHECK(bench.registers.free_runs());
  CHECK(bench.Write(gige::kTrigger, 1) == GvcpStatus::kAccessDenied);
  CHECK(bench.Write(gige::kTriggerMode, 1) == GvcpStatus::kSuccess);
  CHECK_FALSE(bench.registers.free_runs());
  CHECK(bench.Write(gige::kTrigger, 1) == GvcpStatus::kAccessDenied);  // The line triggers.
  CHECK(bench.Write(gige::kTriggerSource, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kTrigger, 1) == GvcpStatus::kSuccess);
  bench.registers.EndControl();
  CHECK(bench.registers.Get(gige::kTrigger) == 0);
}

TEST_CASE("A reset starts it anew, with the user set that was chosen for that", "[unit]") {
  RegisterBench bench;
  CHECK(bench.Write(gige::kUserSetDefault, 3) == GvcpStatus::kInvalidParameter);
  CHECK(bench.Write(gige::kUserSet, 2) == GvcpStatus::kSuccess);
  CHECK(bench.Enable(ScanComponent::kIntensity) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSetSave, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kUserSetDefault, 2) == GvcpStatus::kSuccess);
  CHECK(bench.Enable(ScanComponent::kIntensity, false) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kControl, 2) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kAcquisition, 1) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kPacketSize, 600) == GvcpStatus::kSuccess);
  CHECK(bench.Write(gige::kDeviceReset, 1) == GvcpStatus::kSuccess);
  CHECK(bench.registers.Get(gige::kControl) == 0);
  CHECK(bench.registers.Get(gige::kAcquisition) == 0);
  CHECK(bench.registers.Get(gige::kPacketSize) == 1500);
  CHECK(bench.registers.FrameSettings().components.size() == 2);
}

TEST_CASE("It has the names of a PhoXi, and says that it is none", "[unit]") {
  RegisterBench bench;
  CHECK_THAT(bench.Read(gige::kVendor, 32), StartsWith(std::string("Photoneo\0", 9)));
  CHECK_THAT(bench.Read(gige::kModel, 32), StartsWith(std::string("PhoXi3DScan\0", 12)));
  CHECK_THAT(bench.Read(gige::kManufacturerInfo, 48), StartsWith("emulated by tubetwin"));
  CHECK(bench.Status(GvcpCommand::kWriteMemory, RegisterBench::Words({gige::kUserName}) +
                                                    std::string("left cell\0\0\0", 12)) ==
        GvcpStatus::kSuccess);
  const auto found = bench.Ask(GvcpCommand::kDiscovery, "").second;
  CHECK_THAT(found.substr(gige::kUserName), StartsWith("left cell"));
}

TEST_CASE("Random requests are answered or refused, and the scanner stays what it is", "[unit]") {
  RegisterBench bench;
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
