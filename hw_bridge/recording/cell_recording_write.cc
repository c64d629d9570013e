#include <filesystem>

#include "hw_bridge/recording/cell_recording.h"
#include "hw_bridge/recording/cloud_packing.h"
#include "hw_bridge/recording/recording_blocks.h"
#include "hw_bridge/recording/recording_header.h"
#include "models/base/cloud/zstd_frame.h"
#include "models/base/error.h"
#include "models/base/files.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlockBytes = std::size_t{256} << 10;
constexpr TimeNs kBlockTime = std::chrono::seconds(5);

bool IsCaption(const CellEvent& event) {
  const auto* note = std::get_if<PipelineNote>(&event);
  return note != nullptr && note->kind == PipelineNote::Kind::kCaption;
}

OutputFile CreateWithFolder(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  MakeFolder(folder.empty() ? "." : folder.string());
  return OutputFile::Create(path);
}

}  // namespace

CellRecordingWriter::CellRecordingWriter(const std::string& path, const CellRecordingHeader& header)
    : out_(CreateWithFolder(path)) {
  WriteBlock(RecordingBlock::Kind::kHeader, HeaderToText(header), TimeNs(0), TimeNs(0));
}

CellRecordingWriter::~CellRecordingWriter() {
  if (finished_) return;
  try {
    WriteEvents();
  } catch (const std::exception&) {
    // What cannot be written any more is what a kill would have lost too.
  }
}

void CellRecordingWriter::Add(const CellEvent& event) {
  TT_CHECK(!finished_);
  if (const auto* taken = std::get_if<ScanTaken>(&event)) {
    WriteEvents();
    WriteBlock(RecordingBlock::Kind::kCloud, PackCloud(taken->cloud_S), taken->at, taken->at);
  }
  if (events_.empty()) first_ = encoder_.now();
  encoder_.Encode(event, events_);
  if (IsRead(event)) {
    ++reads_;
  } else if (!IsCaption(event)) {
    ++commands_;
  }
  if (events_.size() >= kBlockBytes || encoder_.now() - first_ >= kBlockTime) WriteEvents();
}

void CellRecordingWriter::Finish(const std::string& reason) {
  TT_CHECK(!finished_);
  WriteEvents();
  WriteBlock(RecordingBlock::Kind::kEnd, EndToText({reason, commands_, reads_}), encoder_.now(),
             encoder_.now());
  finished_ = true;
  out_.Append(IndexFrame(blocks_, out_.size()));
  out_.Close();
}

void CellRecordingWriter::WriteEvents() {
  if (events_.empty()) return;
  WriteBlock(RecordingBlock::Kind::kEvents, events_, first_, encoder_.now());
  events_.clear();
  encoder_.Reset();
}

void CellRecordingWriter::WriteBlock(RecordingBlock::Kind kind, const std::string& content,
                                     TimeNs first, TimeNs last) {
  const std::string frame = Compressed(content);
  RecordingBlock block;
  block.kind = kind;
  block.byte = out_.size();
  block.number = blocks_.size();
  block.first = first;
  block.last = last;
  block.size = content.size();
  block.packed = frame.size();
  try {
    out_.Write(BlockHead(block) + frame);  // Safe from a kill of this program from here on.
  } catch (const Error&) {
    out_.CutTo(block.byte);
    finished_ = true;
    throw;
  }
  blocks_.push_back(block);
}

}  // namespace tubetwin
