#include "hw_bridge/emulators/photoneo/gige_registers.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <iterator>
#include <optional>

#include "hw_bridge/codecs/big_endian.h"
#include "hw_bridge/codecs/gvsp.h"
#include "hw_bridge/emulators/photoneo/gige_genicam.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr std::size_t kRegisterBytes = 0x10000;
constexpr std::size_t kDiscoveryBytes = 0xf8;
constexpr std::uint32_t kUserSets = 3;
constexpr std::uint32_t kStandard2_1 = 0x00020001, kBigEndianUtf8 = 0x80000001;
/// Concatenated registers, writing memory, sending packets again; the user's name, the serial
/// number.
constexpr std::uint32_t kCapabilities = 0xc0000007;
constexpr std::uint32_t kTicksPerS = 1000000000;
constexpr std::uint32_t kShippedHeartbeat_ms = 3000, kShortestHeartbeat_ms = 500;
constexpr float kShippedExposure_ms = 20.48f, kShortestExposure_ms = 10.24f;
constexpr float kLongestExposure_ms = 100.352f;
constexpr std::uint32_t kChunkTrailer = 8;

struct Span {
  std::uint32_t first, last;
};
/// What a client may write.
constexpr Span kWritable[] = {
    {gige::kUserName, gige::kUserNameEnd - 4},
    {gige::kHeartbeat, gige::kHeartbeat},
    {gige::kControl, gige::kControl},
    {gige::kStreamPort, gige::kPacketDelay},
    {gige::kStreamAddress, gige::kStreamAddress},
    {gige::kStreamConfiguration, gige::kStreamConfiguration},
    {gige::kAcquisition, gige::kLocked},
    {gige::kComponent, gige::kComponent},
    {gige::kUserSet, gige::kUserSetDefault},
    {gige::kSettings, gige::kOutputMode},
};

/// Choices of which the last is the value, the first 0.
constexpr std::pair<std::uint32_t, std::uint32_t> kLastChoice[] = {
    {gige::kAcquisition, 1},
    {gige::kTrigger, 1},
    {gige::kDeviceReset, 1},
    {gige::kLocked, 1},
    {gige::kComponent, kScanComponents - 1},
    {gige::kUserSet, kUserSets - 1},
    {gige::kUserSetDefault, kUserSets - 1},
    {gige::kOperationMode, 1},
    {gige::kTextureSource, 1},
    {gige::kNormalsRadius, 4},
    {gige::kJumboFrames, 1},
    {gige::kTriggerSelector, 0},
    {gige::kTriggerMode, 1},
    {gige::kTriggerSource, 1},
    {gige::kTriggerActivation, 1},
    {gige::kOutputMode, 1},
};
constexpr std::uint32_t kContinuous = 1, kLine1 = 0;

/// The component and its register that an address of the blocks is.
struct BlockRegister {
  ScanComponent component;
  std::uint32_t offset;
};
std::optional<BlockRegister> InBlocks(std::uint32_t address) {
  if (address < gige::kComponents || address >= gige::kSettingsEnd) return std::nullopt;
  const std::uint32_t at = address - gige::kComponents;
  return BlockRegister{static_cast<ScanComponent>(at / gige::kComponentBlock),
                       at % gige::kComponentBlock};
}

bool IsWritable(std::uint32_t address) {
  if (const auto block = InBlocks(address)) return block->offset <= gige::kPixelFormat;
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

GigeRegisters::GigeRegisters(const GigeDevice& device)
    : device_(device), memory_(kRegisterBytes, '\0') {
  const std::string description = ScannerGenicam();
  Set(gige::kVersion, kStandard2_1);
  Set(gige::kDeviceMode, kBigEndianUtf8);
  Set(gige::kAddress, device.address);
  Set(gige::kMask, 0xff000000);
  PutText(gige::kVendor, "Photoneo", 32);
  PutText(gige::kModel, "PhoXi3DScan", 32);
  PutText(gige::kDeviceVersion, "1.13.0", 32);
  PutText(gige::kManufacturerInfo, "emulated by tubetwin, no real device", 48);
  PutText(gige::kSerial, "TWIN-001", 16);
  char url[64];
  std::snprintf(url, sizeof url, "Local:scanner.xml;%zx;%zx", kRegisterBytes, description.size());
  PutText(gige::kUrl, url, 512);
  Set(gige::kInterfaces, 1);
  Set(gige::kStreams, 1);
  Set(gige::kCapability, kCapabilities);
  Set(gige::kStreamCapability, gige::kMultipart);
  Set(gige::kTickLow, kTicksPerS);
  Set(gige::kWidth, static_cast<std::uint32_t>(device.width));
  Set(gige::kHeight, static_cast<std::uint32_t>(device.height));
  const auto number = [](double value) {
    return std::bit_cast<std::uint32_t>(static_cast<float>(value));
  };
  Set(gige::kFocal, number(device.focal_px));
  Set(gige::kCentreU, number(0.5 * (device.width - 1)));
  Set(gige::kCentreV, number(0.5 * (device.height - 1)));
  PutText(gige::kDescription, "as shipped", gige::kDescriptionEnd - gige::kDescription);
  Set(gige::kExposure, number(kShippedExposure_ms));
  Set(gige::kAcquisitionMode, kContinuous);
  for (std::size_t i = 0; i < kScanComponents; ++i) {
    const auto component = static_cast<ScanComponent>(i);
    Set(gige::ComponentBlock(component) + gige::kPixelFormat, InfoOf(component).pixel_format);
    Set(gige::ComponentBlock(component) + gige::kComponentId, InfoOf(component).id);
  }
  Set(gige::ComponentBlock(ScanComponent::kRange) + gige::kEnabled, 1);
  user_sets_.assign(kUserSets, std::string(Settings()));
  memory_ += description;
  PowerUp();
}

/// What the registers are whatever a client has written before.
void GigeRegisters::PowerUp() {
  EndControl();
  Set(gige::kHeartbeat, kShippedHeartbeat_ms);
  Set(gige::kStreamConfiguration, 0);
  Set(gige::kComponent, static_cast<std::uint32_t>(ScanComponent::kRange));
  Set(gige::kUserSet, Get(gige::kUserSetDefault));
  Set(gige::kPacketSize, device_.packet_size);
  Load(Get(gige::kUserSetDefault));
}

void GigeRegisters::EndControl() {
  for (const std::uint32_t address :
       {gige::kControl, gige::kAcquisition, gige::kTrigger, gige::kLocked, gige::kStreamPort}) {
    Set(address, 0);
  }
}

void GigeRegisters::Load(std::uint32_t user_set) {
  memory_.replace(gige::kSettings, user_sets_[user_set].size(), user_sets_[user_set]);
  Settle();
}

/// Registers that follow from others.
void GigeRegisters::Settle() {
  const std::uint32_t largest =
      Get(gige::kJumboFrames) != 0 ? device_.jumbo_packet_size : device_.packet_size;
  Set(gige::kLargestPacket, largest);
  if ((Get(gige::kPacketSize) & 0xffff) > largest) Set(gige::kPacketSize, largest);
  Set(gige::ComponentBlock(ScanComponent::kRange) + gige::kPixelFormat,
      Get(gige::kOutputMode) == 0 ? kPixelCoord3dAbc32f : kPixelCoord3dC32f);
  Set(gige::kPayloadSize, PayloadSize());
}

std::uint32_t GigeRegisters::PayloadSize() const {
  const GigeFrameSettings settings = FrameSettings();
  std::size_t bytes = 0;
  for (const GigeFrameSettings::Component& each : settings.components) {
    bytes += BytesPerPixel(each.pixel_format) * Get(gige::kWidth) * Get(gige::kHeight);
    if (!settings.multipart && settings.components.size() > 1) bytes += kChunkTrailer;
  }
  return static_cast<std::uint32_t>(bytes);
}

GigeFrameSettings GigeRegisters::FrameSettings() const {
  GigeFrameSettings settings;
  for (std::size_t i = 0; i < kScanComponents; ++i) {
    const auto component = static_cast<ScanComponent>(i);
    if (Get(gige::ComponentBlock(component) + gige::kEnabled) == 0) continue;
    settings.components.push_back(
        {component, Get(gige::ComponentBlock(component) + gige::kPixelFormat)});
  }
  settings.multipart = (Get(gige::kStreamConfiguration) & gige::kMultipart) != 0;
  settings.normals_radius = static_cast<int>(Get(gige::kNormalsRadius));
  return settings;
}

bool GigeRegisters::free_runs() const { return Get(gige::kTriggerMode) == 0; }

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
  if (!Allows(address, value)) return GvcpStatus::kInvalidParameter;
  if (address == gige::kUserSetSave || address == gige::kUserSetReset) {
    return Get(gige::kUserSet) == 0 ? GvcpStatus::kWriteProtect : GvcpStatus::kSuccess;
  }
  // There is nothing to trigger while frames come by themselves, or by the line.
  if (address == gige::kTrigger && (free_runs() || Get(gige::kTriggerSource) == kLine1)) {
    return GvcpStatus::kAccessDenied;
  }
  return GvcpStatus::kSuccess;
}

bool GigeRegisters::Allows(std::uint32_t address, std::uint32_t value) const {
  if (const auto block = InBlocks(address)) {
    return block->offset == gige::kEnabled ? value <= 1 : AllowsFormat(block->component, value);
  }
  for (const auto& [choice, last] : kLastChoice) {
    if (address == choice) return value <= last;
  }
  switch (address) {
    case gige::kAcquisitionMode:
      return value == kContinuous;
    case gige::kExposure: {
      const auto exposure_ms = std::bit_cast<float>(value);
      return exposure_ms >= kShortestExposure_ms && exposure_ms <= kLongestExposure_ms;
    }
    case gige::kHeartbeat:
      return value >= kShortestHeartbeat_ms;
    case gige::kStreamConfiguration:
      return (value & ~gige::kMultipart) == 0;
    case gige::kPacketSize:
      return AllowsPacket(value);
    default:
      return true;
  }
}

bool GigeRegisters::AllowsFormat(ScanComponent component, std::uint32_t format) const {
  if (component == ScanComponent::kNormal && format == kPixelCoord3dAc8) return true;
  if (component == ScanComponent::kRange) {
    return format == Get(gige::ComponentBlock(component) + gige::kPixelFormat);
  }
  return format == InfoOf(component).pixel_format;
}

bool GigeRegisters::AllowsPacket(std::uint32_t value) const {
  const std::uint32_t size = value & 0xffff;
  const std::uint32_t flags = value & ~0xffffu;
  return size >= gige::kSmallestPacket && size <= Get(gige::kLargestPacket) &&
         (flags & ~(gige::kFireTestPacket | gige::kDoNotFragment)) == 0;
}

void GigeRegisters::Write(std::uint32_t address, std::uint32_t value) {
  std::string& chosen = user_sets_[Get(gige::kUserSet)];
  switch (address) {
    case gige::kUserSetLoad:
      return Load(Get(gige::kUserSet));
    case gige::kUserSetSave:
      chosen = Settings();
      return;
    case gige::kUserSetReset:
      chosen = user_sets_.front();
      return;
    case gige::kDeviceReset:
      return PowerUp();
    default:
      Set(address, value);
      return Settle();
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
