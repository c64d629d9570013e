#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tubetwin {

/// One zstd frame with content size and check sum. Throws Error(kInternal).
std::string Compressed(std::string_view content);

/// Content of exactly one such frame. `size`: what it must have; larger contents are not allocated.
/// Throws Error(kBadData) "SOURCE: WHAT".
std::string Decompressed(std::string_view frame, std::uint64_t size, const std::string& source);

}  // namespace tubetwin
