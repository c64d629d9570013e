#pragma once

#include <cstdint>
#include <deque>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/recording/cell_event.h"
#include "hw_bridge/recording/event_codec.h"
#include "models/base/disk/output_file.h"
#include "models/bin.h"
#include "models/cell_model.h"
#include "models/part.h"

namespace tubetwin {

// A cell recording (cell.rec.zst): everything that crossed the border of a cell in one round, in
// order. Not to be confused with twin/render's recordings, which hold what a round looked like.
//
// The file is a chain of blocks. Each is a zstd skippable frame (its head: what the block holds,
// from when to when, how long it is, a check sum) and a zstd frame (its content, with zstd's own
// check sum); `zstd -dc` gives the contents one after another. The first block is the header
// (JSON), then come events, each cloud in a block of its own before the event that takes it, then
// the end mark (JSON: why, how many) and an index in a last skippable frame. Blocks are read
// without what came before, and written whole: after a kill the blocks before the last one are
// there. At most five seconds of cell time or 256 KiB of events are in the block that is lost.

/// What a recording says before its first event.
struct CellRecordingHeader {
  std::map<std::string, std::string> versions;  ///< Program, engine, compiler.
  std::int64_t seed = 0;
  /// The configuration of the pipeline and the cell, complete (config.resolved.toml), and its
  /// fingerprint.
  std::string config_toml;
  std::string fingerprint;
  CellModel model;
  Bin bin;
  Part part;
  /// JSON of the moment in which a stored round was taken up; empty: the round began at its
  /// beginning.
  std::string held;
};

/// One block, as its head and the index say.
struct RecordingBlock {
  enum class Kind : std::uint8_t { kHeader, kEvents, kCloud, kEnd } kind = Kind::kEvents;
  std::uint64_t byte = 0;  ///< Where it starts in the file.
  std::uint64_t number = 0;
  TimeNs first{0}, last{0};  ///< Cell time before its first event and at its last one.
  std::uint64_t size = 0;    ///< Of its content.
  std::uint64_t packed = 0;  ///< Of its zstd frame.
};
const char* ToString(RecordingBlock::Kind kind);

/// Writes a recording. Holds one block of events at most, and one cloud while it is written. One
/// thread.
class CellRecordingWriter {
 public:
  /// Creates the file (and its folder), in place of an old one. Throws Error(kCannotCreate | kIo).
  CellRecordingWriter(const std::string& path, const CellRecordingHeader& header);
  /// Writes what is left; without Finish() the recording then looks like one of a killed program.
  ~CellRecordingWriter();
  CellRecordingWriter(const CellRecordingWriter&) = delete;
  CellRecordingWriter& operator=(const CellRecordingWriter&) = delete;

  /// Throws Error(kIo) when the disk is full; what was written is a whole recording that was cut
  /// short, and nothing may be added any more.
  void Add(const CellEvent& event);
  /// The end mark and the index. `reason`: why the round ended. Nothing may be added afterwards.
  void Finish(const std::string& reason);

  std::uint64_t bytes_written() const { return out_.size(); }

 private:
  void WriteBlock(RecordingBlock::Kind kind, const std::string& content, TimeNs first, TimeNs last);
  void WriteEvents();
  void WriteIndex();

  OutputFile out_;
  std::uint64_t commands_ = 0, reads_ = 0;
  EventEncoder encoder_;
  std::string events_;  ///< Of the block that is being filled.
  TimeNs first_{0};
  bool finished_ = false;  ///< Nothing is written any more: it is whole, or the disk is full.
  std::vector<RecordingBlock> blocks_;
};

/// Reads a recording, block by block. Holds one block and one cloud. One thread.
class CellRecording {
 public:
  /// Opens the file, reads its header and its index, or without one the heads of all blocks. A last
  /// block that is cut short is dropped. Throws Error(kMissing), and Error(kBadData) naming file
  /// and byte when it is no cell recording or a head is damaged.
  explicit CellRecording(const std::string& path);

  const std::string& path() const { return path_; }
  const CellRecordingHeader& header() const { return header_; }
  const std::vector<RecordingBlock>& blocks() const { return blocks_; }
  /// Whether the index was there; else the blocks' heads were read.
  bool indexed() const { return indexed_; }
  /// Whether the end mark is there; else the recording was cut short (the program was killed).
  bool complete() const;
  /// Why the round ended, by the end mark; empty when the recording was cut short.
  const std::string& end_reason() const { return end_reason_; }
  std::uint64_t dropped_bytes() const { return dropped_; }  ///< Of the last, incomplete block.
  std::uint64_t size_bytes() const { return size_; }
  TimeNs end_time() const;  ///< Of the last event.

  /// The next event, nothing at the end. Throws Error(kBadData) naming file, byte and block when
  /// the block is damaged.
  std::optional<CellEvent> Next();
  /// The next event is the first one of the block that holds `time`, or of the first one after it.
  void Seek(TimeNs time);

 private:
  bool ReadIndex();
  void ReadHeads();
  /// The head of a block at `byte`, or nothing when the file ends inside the block.
  std::optional<RecordingBlock> HeadAt(std::uint64_t byte, std::uint64_t number);
  std::string Content(const RecordingBlock& block);
  std::string Name(const RecordingBlock& block) const;
  bool LoadEvents();
  [[noreturn]] void Fail(std::uint64_t byte, const std::string& what) const;

  std::string path_;
  std::ifstream in_;
  std::uint64_t size_ = 0, dropped_ = 0;
  bool indexed_ = false;
  std::string end_reason_;
  CellRecordingHeader header_;
  std::vector<RecordingBlock> blocks_;

  std::size_t next_block_ = 0;
  std::unique_ptr<const std::string> content_;  ///< On the heap: the decoder looks into it.
  std::optional<EventDecoder> decoder_;
  /// Blocks of clouds that no event has taken yet; each is read when it is.
  std::deque<std::size_t> clouds_;
};

}  // namespace tubetwin
