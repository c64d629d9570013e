#include "hw_bridge/recording/cell_recording.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "hw_bridge/recording/cloud_packing.h"
#include "hw_bridge/recording/recording_blocks.h"
#include "hw_bridge/recording/recording_header.h"
#include "models/base/cloud/zstd_frame.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

using Kind = RecordingBlock::Kind;

/// Bytes [byte, byte + size) of a file that has them.
std::string BytesAt(std::ifstream& in, std::uint64_t byte, std::uint64_t size) {
  std::string bytes(static_cast<std::size_t>(size), '\0');
  in.clear();
  in.seekg(static_cast<std::streamoff>(byte));
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

}  // namespace

CellRecording::CellRecording(const std::string& path) : path_(path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw Error(ErrorKind::kMissing, path + ": no such file");
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    throw Error(ErrorKind::kBadData, path + ": no regular file; a cell recording is needed");
  }
  in_.open(path, std::ios::binary);
  if (!in_) throw Error(ErrorKind::kIo, path + ": cannot be read");
  size_ = std::filesystem::file_size(path);
  if (!ReadIndex()) ReadHeads();
  header_ = HeaderFromText(Content(blocks_.front()), path + ": its header");
  if (complete()) end_reason_ = EndFromText(Content(blocks_.back()), path + ": its end").reason;
  Seek(TimeNs::min());
}

bool CellRecording::complete() const { return blocks_.back().kind == Kind::kEnd; }

TimeNs CellRecording::end_time() const { return blocks_.back().last; }

bool CellRecording::ReadIndex() {
  if (size_ < kBlockHeadBytes + kIndexTailBytes) return false;
  const auto start = IndexStart(BytesAt(in_, size_ - kIndexTailBytes, kIndexTailBytes));
  if (!start || *start >= size_ - kIndexTailBytes) return false;
  auto blocks = ParseIndex(BytesAt(in_, *start, size_ - *start));
  if (!blocks || blocks->empty() || blocks->front().kind != Kind::kHeader) return false;
  // The blocks must lie one behind the other, from the file's start to the index.
  std::uint64_t at = 0;
  for (const RecordingBlock& block : *blocks) {
    if (block.byte != at || block.packed > size_) return false;
    at += kBlockHeadBytes + block.packed;
  }
  if (at != *start) return false;
  blocks_ = std::move(*blocks);
  indexed_ = true;
  return true;
}

void CellRecording::ReadHeads() {
  std::uint64_t at = 0;
  while (at < size_) {
    const std::optional<RecordingBlock> block = HeadAt(at, blocks_.size());
    if (!block) break;
    blocks_.push_back(*block);
    at += kBlockHeadBytes + block->packed;
    if (block->kind == Kind::kEnd) return;  // What follows is an index that cannot be used.
  }
  dropped_ = size_ - at;
  if (blocks_.empty()) {
    Fail(0, size_ == 0 ? "no cell recording (it is empty)" : "the file ends within its header");
  }
}

std::optional<RecordingBlock> CellRecording::HeadAt(std::uint64_t byte, std::uint64_t number) {
  const std::string bytes = BytesAt(in_, byte, kBlockHeadBytes);
  if (bytes.size() < kBlockHeadBytes && number > 0) return std::nullopt;
  std::optional<RecordingBlock> block = ParseBlockHead(bytes);
  if (!block && number == 0) Fail(0, "no cell recording (it does not begin with one's header)");
  if (!block || block->number != number || (number == 0) != (block->kind == Kind::kHeader)) {
    Fail(byte, "block " + std::to_string(number) + ": damaged: its head is no head of that block");
  }
  block->byte = byte;
  if (block->packed > size_ - byte - kBlockHeadBytes) return std::nullopt;
  return block;
}

std::string CellRecording::Name(const RecordingBlock& block) const {
  return path_ + ": byte " + std::to_string(block.byte) + ": block " +
         std::to_string(block.number) + " (" + ToString(block.kind) + ", from " +
         std::to_string(Seconds(block.first)) + " s)";
}

std::string CellRecording::Content(const RecordingBlock& block) {
  const std::uint64_t max_bytes = block.kind == Kind::kCloud ? kMaxCloudBytes : kMaxEventBytes;
  const auto head = HeadAt(block.byte, block.number);
  if (!head || head->packed != block.packed || head->size != block.size ||
      head->kind != block.kind) {
    Fail(block.byte, "block " + std::to_string(block.number) +
                         ": damaged: its head is not what the index says");
  }
  if (block.size > max_bytes) {
    throw Error(ErrorKind::kBadData, Name(block) + ": holds " + std::to_string(block.size) +
                                         " bytes, at most " + std::to_string(max_bytes) +
                                         " are allowed");
  }
  return Decompressed(BytesAt(in_, block.byte + kBlockHeadBytes, block.packed), block.size,
                      Name(block));
}

void CellRecording::Seek(TimeNs time) {
  decoder_.reset();
  clouds_.clear();
  next_block_ = 0;
  while (next_block_ < blocks_.size() &&
         (blocks_[next_block_].kind != Kind::kEvents || blocks_[next_block_].last < time)) {
    ++next_block_;
  }
  // A block that begins with taking a cloud stands behind that cloud.
  if (next_block_ < blocks_.size() && blocks_[next_block_ - 1].kind == Kind::kCloud) {
    clouds_.push_back(next_block_ - 1);
  }
}

bool CellRecording::LoadEvents() {
  for (; next_block_ < blocks_.size(); ++next_block_) {
    const RecordingBlock& block = blocks_[next_block_];
    if (block.kind == Kind::kCloud) clouds_.push_back(next_block_);
    if (block.kind != Kind::kEvents) continue;
    content_ = std::make_unique<const std::string>(Content(block));
    decoder_.emplace(*content_, block.first, Name(block));
    ++next_block_;
    return true;
  }
  return false;
}

std::optional<CellEvent> CellRecording::Next() {
  for (;;) {
    if (decoder_) {
      std::optional<CellEvent> event = decoder_->Next();
      if (event) {
        if (auto* taken = std::get_if<ScanTaken>(&*event)) {
          const RecordingBlock& here = blocks_[next_block_ - 1];
          if (clouds_.empty()) Fail(here.byte, "a scan is taken, but there is no cloud before it");
          const RecordingBlock& cloud = blocks_[clouds_.front()];
          clouds_.pop_front();
          taken->cloud_S = UnpackCloud(Content(cloud), Name(cloud));
        }
        return event;
      }
      decoder_.reset();
    }
    if (!LoadEvents()) return std::nullopt;
  }
}

void CellRecording::Fail(std::uint64_t byte, const std::string& what) const {
  throw Error(ErrorKind::kBadData, path_ + ": byte " + std::to_string(byte) + ": " + what);
}

}  // namespace tubetwin
