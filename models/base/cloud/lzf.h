#pragma once

#include <string>
#include <string_view>

namespace tubetwin {

/// Most bytes that one byte of LZF can stand for: a run of 264 from 3.
inline constexpr std::size_t kLzfLargestRatio = 88;

/// Unpacks LZF, with which PCD's binary_compressed is packed, to exactly `size` bytes. A byte below
/// 32 is followed by that many literal bytes and one more; any other names a run that was unpacked
/// before: 3 bits of length (7: the next byte adds to it; and two more), 13 bits of distance (and
/// one more). `size` bytes are allocated only when the packed ones can fill them. Throws
/// Error(kBadData) naming `source` and the byte of the stream where it is damaged, or gives another
/// number of bytes.
std::string LzfUnpacked(std::string_view packed, std::size_t size, const std::string& source);

}  // namespace tubetwin
