#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "hw_bridge/codecs/decode_error.h"

namespace tubetwin {

// The control protocol of GigE Vision (GVCP) over UDP, as a camera hears it: requests of 8 bytes
// and their data, big-endian; answers likewise.

enum class GvcpCommand : std::uint16_t {
  kDiscovery = 0x0002,
  kPacketResend = 0x0040,
  kReadRegister = 0x0080,
  kWriteRegister = 0x0082,
  kReadMemory = 0x0084,
  kWriteMemory = 0x0086,
};

enum class GvcpStatus : std::uint16_t {
  kSuccess = 0x0000,
  kNotImplemented = 0x8001,
  kInvalidParameter = 0x8002,
  kInvalidAddress = 0x8003,
  kWriteProtect = 0x8004,
  kBadAlignment = 0x8005,
  kAccessDenied = 0x8006,
};

inline constexpr std::size_t kGvcpHeader = 8;
/// Bytes of a request's or answer's data at most: one packet of 576 bytes with all headers.
inline constexpr std::size_t kMaxGvcpData = 540;

struct GvcpRequest {
  std::uint16_t command = 0;  ///< One of GvcpCommand, or another.
  bool wants_answer = false;
  std::uint16_t id = 0;
  std::string data;
  bool long_ids = false;  ///< Of a kPacketResend: frames have ids of 64 bits.
};

/// Fails for what is no request: too short, too long, another first byte, another length than it
/// says. Commands and data are not judged.
std::variant<GvcpRequest, DecodeError> DecodeGvcpRequest(std::string_view bytes);
std::string EncodeGvcpRequest(const GvcpRequest& request);
/// The answer to `request`.
std::string EncodeGvcpAnswer(const GvcpRequest& request, GvcpStatus status, std::string_view data);

// What the data of a request say. Each fails when their length is no such data's.

/// Addresses of a kReadRegister.
std::variant<std::vector<std::uint32_t>, DecodeError> GvcpAddresses(std::string_view data);
/// Addresses and values of a kWriteRegister.
std::variant<std::vector<std::pair<std::uint32_t, std::uint32_t>>, DecodeError> GvcpWrites(
    std::string_view data);
struct GvcpSpan {
  std::uint32_t address = 0, size = 0;
};
/// What a kReadMemory wants to read.
std::variant<GvcpSpan, DecodeError> GvcpMemory(std::string_view data);
struct GvcpResend {
  std::uint64_t frame_id = 0;  ///< 16 bits of it without `long_ids`.
  bool long_ids = false;
  std::uint32_t first = 0, last = 0;  ///< Packets.
};
/// What a kPacketResend wants again.
std::variant<GvcpResend, DecodeError> GvcpResendOf(const GvcpRequest& request);

}  // namespace tubetwin
