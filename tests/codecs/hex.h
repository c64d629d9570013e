#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

namespace tubetwin::test {

/// The bytes that a text of hexadecimal digits says; blanks do not count, "00*40" is 40 times 00.
inline std::string FromHex(std::string_view text) {
  std::string out;
  std::size_t at = 0;
  while (at < text.size()) {
    if (text[at] == ' ') {
      ++at;
      continue;
    }
    const auto byte =
        static_cast<char>(std::strtol(std::string(text.substr(at, 2)).c_str(), nullptr, 16));
    at += 2;
    std::size_t times = 1;
    if (at < text.size() && text[at] == '*') {
      const std::size_t end = std::min(text.find(' ', at), text.size());
      times = std::strtoul(std::string(text.substr(at + 1, end - at - 1)).c_str(), nullptr, 10);
      at = end;
    }
    out.append(times, byte);
  }
  return out;
}

inline std::string ToHex(std::string_view bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i > 0 && i % 4 == 0) out += ' ';
    const auto byte = static_cast<unsigned char>(bytes[i]);
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
  return out;
}

/// "09 10 03 E8", as manuals of Modbus print their frames.
inline std::string ToSpacedHex(std::string_view bytes) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string out;
  for (const char letter : bytes) {
    const auto byte = static_cast<unsigned char>(letter);
    if (!out.empty()) out += ' ';
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
  return out;
}

}  // namespace tubetwin::test
