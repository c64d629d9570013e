#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tubetwin {

/// One zstd frame with content size and check sum, by zstd's level (1: recordings are written while
/// a cell runs). Throws Error(kInternal).
std::string Compressed(std::string_view content, int level = 1);

/// Content of exactly one such frame. `size`: what it must have; larger contents are not allocated.
/// Throws Error(kBadData) "SOURCE: WHAT".
std::string Decompressed(std::string_view frame, std::uint64_t size, const std::string& source);

/// Content of exactly one frame that states its size, at most `max_size`: of a file that `zstd`
/// wrote. Throws Error(kBadData) "SOURCE: WHAT" before anything larger is allocated.
std::string DecompressedFile(std::string_view frame, std::uint64_t max_size,
                             const std::string& source);

}  // namespace tubetwin
