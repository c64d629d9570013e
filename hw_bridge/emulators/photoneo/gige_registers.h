#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hw_bridge/codecs/gvcp.h"
#include "hw_bridge/emulators/photoneo/scan_components.h"

namespace tubetwin {

// Where the emulated scanner's registers stand.
namespace gige {
// Of the GigE Vision standard.
inline constexpr std::uint32_t kVersion = 0x0, kDeviceMode = 0x4, kAddress = 0x24, kMask = 0x34;
inline constexpr std::uint32_t kVendor = 0x48, kModel = 0x68, kDeviceVersion = 0x88;
inline constexpr std::uint32_t kManufacturerInfo = 0xa8, kSerial = 0xd8, kUrl = 0x200;
inline constexpr std::uint32_t kInterfaces = 0x600, kStreams = 0x904, kCapability = 0x934;
inline constexpr std::uint32_t kUserName = 0xe8, kUserNameEnd = 0xf8;
inline constexpr std::uint32_t kHeartbeat = 0x938, kTickLow = 0x940, kControl = 0xa00;
inline constexpr std::uint32_t kStreamPort = 0xd00, kPacketSize = 0xd04, kPacketDelay = 0xd08;
inline constexpr std::uint32_t kStreamAddress = 0xd18, kStreamSource = 0xd1c;
inline constexpr std::uint32_t kStreamCapability = 0xd20, kStreamConfiguration = 0xd24;
/// Of kPacketSize: send one packet of this size, now; packets are not to be cut in pieces on their
/// way (they never are).
inline constexpr std::uint32_t kFireTestPacket = 0x80000000, kDoNotFragment = 0x40000000;
inline constexpr std::uint32_t kSmallestPacket = 576;  ///< A leader of all parts fits.
inline constexpr std::uint32_t kMultipart =
    0x40;  ///< Of the stream's capability and configuration.
// Its own.
inline constexpr std::uint32_t kAcquisition = 0xb000, kTrigger = 0xb004, kDeviceReset = 0xb008;
inline constexpr std::uint32_t kLocked = 0xb00c;
inline constexpr std::uint32_t kWidth = 0xb010, kHeight = 0xb014, kPayloadSize = 0xb018;
inline constexpr std::uint32_t kLargestPacket = 0xb01c;
inline constexpr std::uint32_t kFocal = 0xb020, kCentreU = 0xb024, kCentreV = 0xb028;
inline constexpr std::uint32_t kComponent = 0xb030;  ///< Selected one, as in ScanComponent.
inline constexpr std::uint32_t kUserSet = 0xb0a0;    ///< Selected one, as an index; 0 is read only.
inline constexpr std::uint32_t kUserSetLoad = 0xb0a4, kUserSetSave = 0xb0a8;
inline constexpr std::uint32_t kUserSetReset = 0xb0ac, kUserSetDefault = 0xb0b0;
/// What user sets hold.
inline constexpr std::uint32_t kSettings = 0xb200, kSettingsEnd = 0xb2e0;
inline constexpr std::uint32_t kDescription = 0xb200, kDescriptionEnd = 0xb240;
/// Kept for clients that set them; the twin's scans are what its cell says.
inline constexpr std::uint32_t kOperationMode = 0xb240, kExposure = 0xb244;
inline constexpr std::uint32_t kTextureSource = 0xb248;
inline constexpr std::uint32_t kNormalsRadius = 0xb24c, kJumboFrames = 0xb250;
inline constexpr std::uint32_t kAcquisitionMode = 0xb254, kTriggerSelector = 0xb258;
inline constexpr std::uint32_t kTriggerMode = 0xb25c, kTriggerSource = 0xb260;
inline constexpr std::uint32_t kTriggerActivation = 0xb264;
inline constexpr std::uint32_t kOutputMode = 0xb268;  ///< 0: x y z, 1: z only.
/// One block for each ScanComponent: enabled, pixel format, id.
inline constexpr std::uint32_t kComponents = 0xb280, kComponentBlock = 0x10;
inline constexpr std::uint32_t kEnabled = 0x0, kPixelFormat = 0x4, kComponentId = 0x8;
inline constexpr std::uint32_t ComponentBlock(ScanComponent component) {
  return kComponents + static_cast<std::uint32_t>(component) * kComponentBlock;
}
}  // namespace gige

/// What the emulated scanner is.
struct GigeDevice {
  int width = 0, height = 0;
  double focal_px = 0;
  std::uint32_t address = 0;  ///< IPv4.
  /// Largest packets that its interface takes, with all headers.
  std::uint32_t packet_size = 1500, jumbo_packet_size = 9000;
};

/// What the client wants of the next frame.
struct GigeFrameSettings {
  struct Component {
    ScanComponent component = ScanComponent::kRange;
    std::uint32_t pixel_format = 0;
  };
  std::vector<Component> components;  ///< Enabled ones, in the order of their ids.
  bool multipart = false;
  int normals_radius = 0;
};

/// The memory of the emulated scanner and what requests do to it. Every request is judged before
/// anything of it is done. Not thread-safe.
class GigeRegisters {
 public:
  explicit GigeRegisters(const GigeDevice& device);

  /// The answer's status and data. `controller`: whether it comes from the program that has
  /// control, or nobody has it.
  std::pair<GvcpStatus, std::string> Do(const GvcpRequest& request, bool controller);

  std::uint32_t Get(std::uint32_t address) const;
  void Set(std::uint32_t address, std::uint32_t value);

  GigeFrameSettings FrameSettings() const;
  /// Whether frames are taken one after the other, without triggers.
  bool free_runs() const;
  /// Ends control, acquisition and stream.
  void EndControl();

 private:
  std::pair<GvcpStatus, std::string> ReadRegisters(const std::string& data) const;
  std::pair<GvcpStatus, std::string> WriteRegisters(const std::string& data, bool controller);
  std::pair<GvcpStatus, std::string> ReadMemory(const std::string& data) const;
  std::pair<GvcpStatus, std::string> WriteMemory(const std::string& data, bool controller);
  GvcpStatus MayWrite(std::uint32_t address, std::uint32_t value, bool controller) const;
  bool Allows(std::uint32_t address, std::uint32_t value) const;
  bool AllowsFormat(ScanComponent component, std::uint32_t format) const;
  bool AllowsPacket(std::uint32_t value) const;
  void Write(std::uint32_t address, std::uint32_t value);
  void Load(std::uint32_t user_set);
  void PowerUp();
  void Settle();
  std::uint32_t PayloadSize() const;
  void PutText(std::uint32_t address, std::string text, std::size_t room);
  std::string_view Settings() const;

  GigeDevice device_;
  std::string memory_;                  ///< All registers, then the description.
  std::vector<std::string> user_sets_;  ///< The first as shipped.
};

}  // namespace tubetwin
