#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace tubetwin {

// Image frames of the GigE Vision streaming protocol (GVSP) over UDP, big-endian, 16-bit ids: one
// leader (packet 0), the image's bytes in packets of the size that was agreed on, one trailer.

struct GvspImage {
  std::uint16_t frame_id = 1;  ///< 0 is no frame.
  std::uint64_t timestamp_ns = 0;
  std::uint32_t pixel_format = 0;
  std::uint32_t width = 0, height = 0;
};

inline constexpr std::uint32_t kPixelCoord3dAbc32f = 0x026000c0;
/// Headers of IP, UDP and GVSP: an agreed packet size counts them.
inline constexpr std::size_t kGvspOverhead = 20 + 8 + 8;

std::string EncodeGvspLeader(const GvspImage& image);
/// What stands before the bytes of payload packet `packet_id`, from 1; 24 bits.
std::string EncodeGvspPayloadHeader(std::uint16_t frame_id, std::uint32_t packet_id);
std::string EncodeGvspTrailer(const GvspImage& image, std::uint32_t packet_id);

}  // namespace tubetwin
