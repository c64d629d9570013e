#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tubetwin {

// Numbers as Modbus and the Net F/T send them. The readers' precondition: the bytes are there.

inline void PutU8(std::string& out, unsigned value) { out.push_back(static_cast<char>(value)); }
inline void PutU16(std::string& out, unsigned value) {
  PutU8(out, value >> 8);
  PutU8(out, value);
}
inline void PutU32(std::string& out, std::uint32_t value) {
  PutU16(out, value >> 16);
  PutU16(out, value);
}

inline std::uint8_t U8At(std::string_view bytes, std::size_t at) {
  return static_cast<std::uint8_t>(bytes[at]);
}
inline std::uint16_t U16At(std::string_view bytes, std::size_t at) {
  return static_cast<std::uint16_t>(U8At(bytes, at) << 8 | U8At(bytes, at + 1));
}
inline std::uint32_t U32At(std::string_view bytes, std::size_t at) {
  return static_cast<std::uint32_t>(U16At(bytes, at)) << 16 | U16At(bytes, at + 2);
}

}  // namespace tubetwin
