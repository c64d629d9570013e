#include "hw_bridge/emulators/photoneo/gige_registers.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <iterator>

#include "hw_bridge/codecs/big_endian.h"
#include "hw_bridge/codecs/gvsp.h"
#include "hw_bridge/emulators/photoneo/gige_genicam.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr std::size_t kRegisterBytes = 0x10000;
constexpr std::size_t kDiscoveryBytes = 0xf8;
constexpr std::uint32_t kUserSets = 3;
constexpr std::uint32_t kStandard1_2 = 0x00010002, kBigEndianUtf8 = 0x80000001;
/// Concatenated registers, writing memory, sending packets again.
constexpr std::uint32_t kCapabilities = 0x7;
constexpr std::uint32_t kTicksPerS = 1000000000;
constexpr std::uint32_t kShippedHeartbeat_ms = 3000, kShortestHeartbeat_ms = 500;
constexpr std::uint32_t kSmallestPacket = 220, kLargestPacket = 65000;

struct Span {
  std::uint32_t first, last;
};
/// What a client may write.
constexpr Span kWritable[] = {
    {gige::kHeartbeat, gige::kHeartbeat},
    {gige::kControl, gige::kControl},
    {gige::kStreamPort, gige::kPacketDelay},
    {gige::kStreamAddress, gige::kStreamAddress},
    {gige::kAcquisitionMode, gige::kTriggerActivation},
    {gige::kPixelFormat, gige::kPixelFormat},
    {gige::kComponent, gige::kComponentEnabled},
    {gige::kUserSet, gige::kUserSetReset},
    {gige::kSettings, gige::kSettingsEnd - 4},
};

bool IsWritable(std::uint32_t address) {
  return std::any_of(std::begin(kWritable), std::end(kWritable), [address](const Span& span) {
    return address >= span.first && address <= span.last;
  });
}

std::pair<GvcpStatus, std::string> Refused(GvcpStatus status) { return {status, ""}; }

/// Number of what was done, for the answer to writing.
std::string Index(std::size_t done) {
  std::string out;
  PutU16(out, 0);
  PutU16(out, static_cast<unsigned>(done));
  return out;
}

}  // namespace

GigeRegisters::GigeRegisters(int width, int height, std::uint32_t address,
                             std::uint32_t packet_size)
    : memory_(kRegisterBytes, '\0') {
  const std::string description = kScannerGenicam;
  Set(gige::kVersion, kStandard1_2);
  Set(gige::kDeviceMode, kBigEndianUtf8);
  Set(gige::kAddress, address);
  Set(gige::kMask, 0xff000000);
  PutText(gige::kVendor, "tubetwin", 32);
  PutText(gige::kModel, "emulated scanner", 32);
  PutText(gige::kDeviceVersion, "1", 32);
  PutText(gige::kManufacturerInfo, "no real device", 48);
  PutText(gige::kSerial, "1", 16);
  char url[64];
  std::snprintf(url, sizeof url, "Local:scanner.xml;%zx;%zx", kRegisterBytes, description.size());
  PutText(gige::kUrl, url, 512);
  Set(gige::kInterfaces, 1);
  Set(gige::kStreams, 1);
  Set(gige::kCapability, kCapabilities);
  Set(gige::kHeartbeat, kShippedHeartbeat_ms);
  Set(gige::kTickLow, kTicksPerS);
  Set(gige::kPacketSize, packet_size);
  Set(gige::kAcquisitionMode, 1);
  Set(gige::kWidth, static_cast<std::uint32_t>(width));
  Set(gige::kHeight, static_cast<std::uint32_t>(height));
  Set(gige::kPixelFormat, kPixelCoord3dAbc32f);
  Set(gige::kComponent, gige::kRangeComponent);
  Set(gige::kComponentEnabled, 1);
  PutText(gige::kDescription, "as shipped", 64);
  Set(gige::kExposure, std::bit_cast<std::uint32_t>(20.48f));
  user_sets_.assign(kUserSets, std::string(Settings()));
  memory_ += description;
}

std::string_view GigeRegisters::Settings() const {
  return std::string_view(memory_).substr(gige::kSettings, gige::kSettingsEnd - gige::kSettings);
}

std::uint32_t GigeRegisters::Get(std::uint32_t address) const {
  TT_CHECK(address + 4 <= memory_.size());
  return U32At(memory_, address);
}

void GigeRegisters::Set(std::uint32_t address, std::uint32_t value) {
  TT_CHECK(address + 4 <= memory_.size());
  std::string bytes;
  PutU32(bytes, value);
  memory_.replace(address, 4, bytes);
}

void GigeRegisters::PutText(std::uint32_t address, std::string text, std::size_t room) {
  text.resize(room);
  memory_.replace(address, room, text);
}

std::pair<GvcpStatus, std::string> GigeRegisters::Do(const GvcpRequest& request, bool controller) {
  switch (static_cast<GvcpCommand>(request.command)) {
    case GvcpCommand::kDiscovery:
      return {GvcpStatus::kSuccess, memory_.substr(0, kDiscoveryBytes)};
    case GvcpCommand::kReadRegister:
      return ReadRegisters(request.data);
    case GvcpCommand::kWriteRegister:
      return WriteRegisters(request.data, controller);
    case GvcpCommand::kReadMemory:
      return ReadMemory(request.data);
    case GvcpCommand::kWriteMemory:
      return WriteMemory(request.data, controller);
    case GvcpCommand::kPacketResend:
      break;
  }
  return Refused(GvcpStatus::kNotImplemented);
}

std::pair<GvcpStatus, std::string> GigeRegisters::ReadRegisters(const std::string& data) const {
  const auto addresses = GvcpAddresses(data);
  if (std::holds_alternative<DecodeError>(addresses)) {
    return Refused(GvcpStatus::kInvalidParameter);
  }
  std::string out;
  for (const std::uint32_t address : std::get<std::vector<std::uint32_t>>(addresses)) {
    if (address % 4 != 0) return Refused(GvcpStatus::kBadAlignment);
    if (address >= kRegisterBytes) return Refused(GvcpStatus::kInvalidAddress);
    PutU32(out, Get(address));
  }
  return {GvcpStatus::kSuccess, out};
}

GvcpStatus GigeRegisters::MayWrite(std::uint32_t address, std::uint32_t value,
                                   bool controller) const {
  if (address % 4 != 0) return GvcpStatus::kBadAlignment;
  if (address >= kRegisterBytes) return GvcpStatus::kInvalidAddress;
  if (!IsWritable(address)) return GvcpStatus::kWriteProtect;
  if (!controller) return GvcpStatus::kAccessDenied;
  const auto valid = [](bool yes) {
    return yes ? GvcpStatus::kSuccess : GvcpStatus::kInvalidParameter;
  };
  // There is one component, of one format.
  if (address == gige::kComponent || address == gige::kPixelFormat) {
    return valid(value == Get(address));
  }
  if (address == gige::kUserSet) return valid(value < kUserSets);
  if (address == gige::kHeartbeat) return valid(value >= kShortestHeartbeat_ms);
  if (address == gige::kPacketSize) {
    const std::uint32_t size = value & 0xffff;
    return valid(size >= kSmallestPacket && size <= kLargestPacket);
  }
  if (address == gige::kUserSetSave || address == gige::kUserSetReset) {
    return Get(gige::kUserSet) == 0 ? GvcpStatus::kWriteProtect : GvcpStatus::kSuccess;
  }
  return GvcpStatus::kSuccess;
}

void GigeRegisters::Write(std::uint32_t address, std::uint32_t value) {
  std::string& chosen = user_sets_[Get(gige::kUserSet)];
  switch (address) {
    case gige::kUserSetLoad:
      memory_.replace(gige::kSettings, chosen.size(), chosen);
      return;
    case gige::kUserSetSave:
      chosen = Settings();
      return;
    case gige::kUserSetReset:
      chosen = user_sets_.front();
      return;
    default:
      Set(address, value);
  }
}

std::pair<GvcpStatus, std::string> GigeRegisters::WriteRegisters(const std::string& data,
                                                                 bool controller) {
  const auto writes = GvcpWrites(data);
  if (std::holds_alternative<DecodeError>(writes)) return Refused(GvcpStatus::kInvalidParameter);
  std::size_t done = 0;
  for (const auto& [address, value] :
       std::get<std::vector<std::pair<std::uint32_t, std::uint32_t>>>(writes)) {
    const GvcpStatus status = MayWrite(address, value, controller);
    if (status != GvcpStatus::kSuccess) return {status, Index(done)};
    Write(address, value);
    ++done;
  }
  return {GvcpStatus::kSuccess, Index(done)};
}

std::pair<GvcpStatus, std::string> GigeRegisters::ReadMemory(const std::string& data) const {
  const auto wanted = GvcpMemory(data);
  if (std::holds_alternative<DecodeError>(wanted)) return Refused(GvcpStatus::kInvalidParameter);
  const auto [address, size] = std::get<GvcpSpan>(wanted);
  if (address % 4 != 0 || size % 4 != 0) return Refused(GvcpStatus::kBadAlignment);
  constexpr std::size_t kAddressBytes = 4;
  if (size == 0 || size > kMaxGvcpData - kAddressBytes) {
    return Refused(GvcpStatus::kInvalidParameter);
  }
  if (address >= memory_.size()) return Refused(GvcpStatus::kInvalidAddress);
  std::string out = data.substr(0, kAddressBytes) + memory_.substr(address, size);
  out.resize(kAddressBytes + size);  // The description need not end on a whole word.
  return {GvcpStatus::kSuccess, out};
}

std::pair<GvcpStatus, std::string> GigeRegisters::WriteMemory(const std::string& data,
                                                              bool controller) {
  if (data.size() < 8 || data.size() % 4 != 0) return Refused(GvcpStatus::kInvalidParameter);
  const std::uint32_t begin = U32At(data, 0);
  for (std::size_t at = 4; at < data.size(); at += 4) {
    const auto address = static_cast<std::uint32_t>(begin + at - 4);
    const GvcpStatus status = MayWrite(address, U32At(data, at), controller);
    if (status != GvcpStatus::kSuccess) return {status, Index(at - 4)};
    Write(address, U32At(data, at));
  }
  return {GvcpStatus::kSuccess, Index(data.size() - 4)};
}

}  // namespace tubetwin
