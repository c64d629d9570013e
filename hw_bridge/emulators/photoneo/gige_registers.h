#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hw_bridge/codecs/gvcp.h"

namespace tubetwin {

// Where the emulated scanner's registers stand.
namespace gige {
// Of the GigE Vision standard.
inline constexpr std::uint32_t kVersion = 0x0, kDeviceMode = 0x4, kAddress = 0x24, kMask = 0x34;
inline constexpr std::uint32_t kVendor = 0x48, kModel = 0x68, kDeviceVersion = 0x88;
inline constexpr std::uint32_t kManufacturerInfo = 0xa8, kSerial = 0xd8, kUrl = 0x200;
inline constexpr std::uint32_t kInterfaces = 0x600, kStreams = 0x904, kCapability = 0x934;
inline constexpr std::uint32_t kHeartbeat = 0x938, kTickLow = 0x940, kControl = 0xa00;
inline constexpr std::uint32_t kStreamPort = 0xd00, kPacketSize = 0xd04, kPacketDelay = 0xd08;
inline constexpr std::uint32_t kStreamAddress = 0xd18, kStreamSource = 0xd1c;
/// Of kPacketSize: send one packet of this size, now.
inline constexpr std::uint32_t kFireTestPacket = 0x80000000;
// Its own.
inline constexpr std::uint32_t kAcquisitionMode = 0xb000, kAcquisition = 0xb004;
inline constexpr std::uint32_t kTriggerSelector = 0xb008, kTriggerMode = 0xb00c;
inline constexpr std::uint32_t kTriggerSource = 0xb010, kTrigger = 0xb014;
inline constexpr std::uint32_t kTriggerActivation = 0xb018;
inline constexpr std::uint32_t kWidth = 0xb020, kHeight = 0xb024, kPixelFormat = 0xb028;
inline constexpr std::uint32_t kComponent = 0xb030, kComponentEnabled = 0xb034;
inline constexpr std::uint32_t kRangeComponent = 4;  ///< Id of the range image.
inline constexpr std::uint32_t kUserSet = 0xb0a0;    ///< Selected one, as an index; 0 is read only.
inline constexpr std::uint32_t kUserSetLoad = 0xb0a4, kUserSetSave = 0xb0a8;
inline constexpr std::uint32_t kUserSetReset = 0xb0ac;
/// What user sets hold. Kept for clients that set it; the scans of an emulated scanner are what its
/// cell says.
inline constexpr std::uint32_t kSettings = 0xb200, kSettingsEnd = 0xb260;
inline constexpr std::uint32_t kDescription = 0xb200, kOperationMode = 0xb240;
inline constexpr std::uint32_t kExposure = 0xb244, kTextureSource = 0xb248;
inline constexpr std::uint32_t kNormalsRadius = 0xb24c, kJumboFrames = 0xb250;
}  // namespace gige

/// The memory of the emulated scanner and what requests do to it. Every request is judged before
/// anything of it is done. Not thread-safe.
class GigeRegisters {
 public:
  GigeRegisters(int width, int height, std::uint32_t address, std::uint32_t packet_size);

  /// The answer's status and data. `controller`: whether it comes from the program that has
  /// control, or nobody has it.
  std::pair<GvcpStatus, std::string> Do(const GvcpRequest& request, bool controller);

  std::uint32_t Get(std::uint32_t address) const;
  void Set(std::uint32_t address, std::uint32_t value);

 private:
  std::pair<GvcpStatus, std::string> ReadRegisters(const std::string& data) const;
  std::pair<GvcpStatus, std::string> WriteRegisters(const std::string& data, bool controller);
  std::pair<GvcpStatus, std::string> ReadMemory(const std::string& data) const;
  std::pair<GvcpStatus, std::string> WriteMemory(const std::string& data, bool controller);
  GvcpStatus MayWrite(std::uint32_t address, std::uint32_t value, bool controller) const;
  void Write(std::uint32_t address, std::uint32_t value);
  void PutText(std::uint32_t address, std::string text, std::size_t room);
  std::string_view Settings() const;

  std::string memory_;                  ///< All registers, then the description.
  std::vector<std::string> user_sets_;  ///< The first as shipped.
};

}  // namespace tubetwin
