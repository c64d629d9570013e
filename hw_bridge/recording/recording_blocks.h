#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hw_bridge/recording/cell_recording.h"

namespace tubetwin {

// The bytes around the blocks of a cell recording; what the writer and the reader share.

/// A block's head: one zstd skippable frame of this many bytes.
inline constexpr std::size_t kBlockHeadBytes = 60;
/// What stands at the very end when there is an index: check sum, where the index starts, tag.
inline constexpr std::size_t kIndexTailBytes = 16;
/// Largest content of a block of events, header or end; a cloud's is by its pixels.
inline constexpr std::uint64_t kMaxEventBytes = std::uint64_t{1} << 26;
inline constexpr std::uint64_t kMaxCloudBytes = std::uint64_t{20} << 24;

std::string BlockHead(const RecordingBlock& block);
/// Nothing when the bytes are no undamaged head; `byte` of the result is not set.
std::optional<RecordingBlock> ParseBlockHead(std::string_view bytes);

/// The index of `blocks`, to stand at `byte`.
std::string IndexFrame(const std::vector<RecordingBlock>& blocks, std::uint64_t byte);
/// Where the index starts by the last bytes of a file, if they are of an index.
std::optional<std::uint64_t> IndexStart(std::string_view tail);
/// Nothing when the bytes are no undamaged index.
std::optional<std::vector<RecordingBlock>> ParseIndex(std::string_view bytes);

}  // namespace tubetwin
