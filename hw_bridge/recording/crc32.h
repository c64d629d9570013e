#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace tubetwin {

/// CRC-32 of IEEE 802.3 (reflected, 0xedb88320), as MCAP and zip files have it. `before`: of the
/// bytes that came before these.
inline std::uint32_t Crc32(std::string_view bytes, std::uint32_t before = 0) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> out{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t v = i;
      for (int bit = 0; bit < 8; ++bit) v = v & 1 ? 0xedb88320u ^ (v >> 1) : v >> 1;
      out[i] = v;
    }
    return out;
  }();
  std::uint32_t crc = ~before;
  for (const char c : bytes) crc = table[(crc ^ static_cast<std::uint8_t>(c)) & 0xff] ^ (crc >> 8);
  return ~crc;
}

}  // namespace tubetwin
