#include "hw_bridge/recording/recording_blocks.h"

#include "hw_bridge/recording/byte_stream.h"
#include "hw_bridge/recording/crc32.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

// zstd skips frames with these magic numbers.
constexpr std::uint32_t kHeadMagic = 0x184D2A5C, kIndexMagic = 0x184D2A5D;
constexpr std::uint32_t kHeadTag = 0x52435454, kIndexTag = 0x49435454, kTailTag = 0x58435454;
constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kFrameHead = 8;  ///< Magic number and size of a skippable frame.
constexpr std::size_t kEntryBytes = 41;

void WriteTimes(const RecordingBlock& block, ByteWriter& out) {
  out.I64(block.first.count());
  out.I64(block.last.count());
  out.U64(block.size);
  out.U64(block.packed);
}

void ReadTimes(ByteReader& in, RecordingBlock& block) {
  block.first = TimeNs(in.I64());
  block.last = TimeNs(in.I64());
  block.size = in.U64();
  block.packed = in.U64();
}

bool KnownKind(std::uint8_t kind) {
  return kind <= static_cast<std::uint8_t>(RecordingBlock::Kind::kEnd);
}

}  // namespace

const char* ToString(RecordingBlock::Kind kind) {
  switch (kind) {
    case RecordingBlock::Kind::kHeader:
      return "header";
    case RecordingBlock::Kind::kEvents:
      return "events";
    case RecordingBlock::Kind::kCloud:
      return "cloud";
    case RecordingBlock::Kind::kEnd:
      return "end";
  }
  return "unknown";
}

std::string BlockHead(const RecordingBlock& block) {
  std::string bytes;
  ByteWriter out(bytes);
  out.U32(kHeadMagic);
  out.U32(kBlockHeadBytes - kFrameHead);
  out.U32(kHeadTag);
  out.U8(kVersion);
  out.U8(static_cast<std::uint8_t>(block.kind));
  out.U16(0);
  out.U64(block.number);
  WriteTimes(block, out);
  out.U32(Crc32(bytes));
  TT_CHECK(bytes.size() == kBlockHeadBytes);
  return bytes;
}

std::optional<RecordingBlock> ParseBlockHead(std::string_view bytes) {
  if (bytes.size() < kBlockHeadBytes) return std::nullopt;
  ByteReader in(bytes, "head");
  if (in.U32() != kHeadMagic || in.U32() != kBlockHeadBytes - kFrameHead) return std::nullopt;
  if (in.U32() != kHeadTag || in.U8() != kVersion) return std::nullopt;
  const std::uint8_t kind = in.U8();
  in.U16();
  RecordingBlock block;
  block.number = in.U64();
  ReadTimes(in, block);
  if (in.U32() != Crc32(bytes.substr(0, kBlockHeadBytes - 4)) || !KnownKind(kind)) {
    return std::nullopt;
  }
  block.kind = static_cast<RecordingBlock::Kind>(kind);
  return block;
}

std::string IndexFrame(const std::vector<RecordingBlock>& blocks, std::uint64_t byte) {
  std::string bytes;
  ByteWriter out(bytes);
  out.U32(kIndexMagic);
  out.U32(static_cast<std::uint32_t>(8 + kEntryBytes * blocks.size() + kIndexTailBytes));
  out.U32(kIndexTag);
  out.U32(static_cast<std::uint32_t>(blocks.size()));
  for (const RecordingBlock& block : blocks) {
    out.U64(block.byte);
    out.U8(static_cast<std::uint8_t>(block.kind));
    WriteTimes(block, out);
  }
  out.U32(Crc32(bytes));
  out.U64(byte);
  out.U32(kTailTag);
  return bytes;
}

std::optional<std::uint64_t> IndexStart(std::string_view tail) {
  if (tail.size() != kIndexTailBytes) return std::nullopt;
  ByteReader in(tail, "tail");
  in.U32();
  const std::uint64_t byte = in.U64();
  if (in.U32() != kTailTag) return std::nullopt;
  return byte;
}

std::optional<std::vector<RecordingBlock>> ParseIndex(std::string_view bytes) {
  constexpr std::size_t kAround = kFrameHead + 8 + kIndexTailBytes;
  if (bytes.size() < kAround) return std::nullopt;
  ByteReader in(bytes, "index");
  if (in.U32() != kIndexMagic || in.U32() != bytes.size() - kFrameHead) return std::nullopt;
  if (in.U32() != kIndexTag) return std::nullopt;
  const std::uint64_t count = in.U32();
  if (count * kEntryBytes != bytes.size() - kAround) return std::nullopt;
  std::vector<RecordingBlock> blocks(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    blocks[i].byte = in.U64();
    const std::uint8_t kind = in.U8();
    if (!KnownKind(kind)) return std::nullopt;
    blocks[i].kind = static_cast<RecordingBlock::Kind>(kind);
    blocks[i].number = i;
    ReadTimes(in, blocks[i]);
  }
  if (in.U32() != Crc32(bytes.substr(0, bytes.size() - kIndexTailBytes))) return std::nullopt;
  return blocks;
}

}  // namespace tubetwin
