#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tubetwin {

// Frames of the GigE Vision streaming protocol (GVSP) over UDP, big-endian. A frame is one leader
// (packet 0), its bytes in packets of the size that was agreed on, and one trailer. It is either
// one image, with ids of 16 bits, or several parts, with ids of 64 bits, as receivers want them:
// these find the number of parts where short ids have the packet's. No packet has bytes of two
// parts.

struct GvspFrame {
  std::uint64_t id = 1;  ///< From 1.
  std::uint64_t timestamp_ns = 0;
};
/// The id that travels with an image: 1 to 65535, then 1 again.
std::uint16_t GvspShortId(const GvspFrame& frame);

/// What a part is, as GigE Vision numbers it.
enum class GvspData : std::uint16_t { kImage2d = 1, kImage3d = 5, kConfidence = 9 };

struct GvspPart {
  std::uint16_t purpose_id = 0;  ///< GenICam's ComponentIDValue.
  GvspData data = GvspData::kImage2d;
  std::uint32_t pixel_format = 0;
  std::uint32_t width = 0, height = 0;
  std::uint64_t bytes = 0;  ///< 48 bits.
};

inline constexpr std::uint32_t kPixelMono10 = 0x01100003, kPixelConfidence8 = 0x010800c6;
inline constexpr std::uint32_t kPixelCoord3dA32f = 0x012000bd, kPixelCoord3dB32f = 0x012000be;
inline constexpr std::uint32_t kPixelCoord3dC32f = 0x012000bf, kPixelCoord3dAc8 = 0x021000b4;
inline constexpr std::uint32_t kPixelCoord3dAbc32f = 0x026000c0;
/// Every pixel format names the bits that a pixel takes.
inline constexpr std::size_t BytesPerPixel(std::uint32_t format) {
  return (format >> 16 & 0xff) / 8;
}

/// Headers of IP, UDP and GVSP: an agreed packet size counts them.
inline constexpr std::size_t kGvspImageOverhead = 20 + 8 + 8;
inline constexpr std::size_t kGvspPartsOverhead = 20 + 8 + 20 + 8;

/// `chunks`: the image's bytes are GigE Vision's chunks: each its data, its 32-bit id and its
/// 32-bit length, the image first.
std::string EncodeGvspImageLeader(const GvspFrame& frame, const GvspPart& image, bool chunks);
/// What stands before the bytes of payload packet `packet_id`, from 1; 24 bits.
std::string EncodeGvspImageHeader(const GvspFrame& frame, std::uint32_t packet_id);
std::string EncodeGvspImageTrailer(const GvspFrame& frame, const GvspPart& image, bool chunks,
                                   std::uint32_t packet_id);

/// At most 255 parts.
std::string EncodeGvspPartsLeader(const GvspFrame& frame, const std::vector<GvspPart>& parts);
/// `offset`: of the bytes that follow, from the first part's first on; 48 bits.
std::string EncodeGvspPartsHeader(const GvspFrame& frame, std::uint32_t packet_id, unsigned part,
                                  std::uint64_t offset);
std::string EncodeGvspPartsTrailer(const GvspFrame& frame, std::uint32_t packet_id);

}  // namespace tubetwin
