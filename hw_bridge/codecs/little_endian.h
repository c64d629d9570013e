#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace tubetwin {

// Numbers as Yaskawa's YRC1000 sends them. The readers' precondition: the bytes are there.

inline void PutLe8(std::string& out, unsigned value) { out.push_back(static_cast<char>(value)); }
inline void PutLe16(std::string& out, unsigned value) {
  PutLe8(out, value);
  PutLe8(out, value >> 8);
}
inline void PutLe32(std::string& out, std::uint32_t value) {
  PutLe16(out, value);
  PutLe16(out, value >> 16);
}
inline void PutLeFloat(std::string& out, float value) {
  PutLe32(out, std::bit_cast<std::uint32_t>(value));
}

inline std::uint8_t Le8At(std::string_view bytes, std::size_t at) {
  return static_cast<std::uint8_t>(bytes[at]);
}
inline std::uint16_t Le16At(std::string_view bytes, std::size_t at) {
  return static_cast<std::uint16_t>(Le8At(bytes, at) | Le8At(bytes, at + 1) << 8);
}
inline std::uint32_t Le32At(std::string_view bytes, std::size_t at) {
  return Le16At(bytes, at) | static_cast<std::uint32_t>(Le16At(bytes, at + 2)) << 16;
}
inline std::int32_t LeInt32At(std::string_view bytes, std::size_t at) {
  return static_cast<std::int32_t>(Le32At(bytes, at));
}
inline float LeFloatAt(std::string_view bytes, std::size_t at) {
  return std::bit_cast<float>(Le32At(bytes, at));
}

}  // namespace tubetwin
