#pragma once

#include <string>

#include "models/base/random.h"

namespace tubetwin {

/// What LinkFaults::corrupt does to messages: the same bytes in every run.
class Corruption {
 public:
  /// Changes one to four of the bytes.
  void Change(std::string& bytes) {
    if (bytes.empty()) return;
    const std::uint32_t times = 1 + stream_.Index(4);
    for (std::uint32_t i = 0; i < times; ++i) {
      char& byte = bytes[stream_.Index(static_cast<std::uint32_t>(bytes.size()))];
      byte = static_cast<char>(byte ^ (1 + stream_.Index(255)));
    }
  }

 private:
  RandomStream stream_{1, 0, "corrupt link"};
};

}  // namespace tubetwin
