#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "models/base/disk/file_lock.h"
#include "models/base/disk/output_file.h"
#include "twin/campaign/shard.h"
#include "twin/round/records/round_record.h"

namespace tubetwin {

/// What a shard's file holds: a head that names shard and campaign, then one checked line per round
/// in the order in which rounds ended.
struct ShardContent {
  Shard shard;
  std::string
      campaign;  ///< Fingerprint of the campaign's identity; empty when the head is damaged.
  std::vector<RoundRecord> records;
  std::vector<int> line_of;           ///< Of each record, from 1.
  std::vector<std::string> problems;  ///< "FILE:7: damaged ...": lines that hold no record.
  std::string damaged;                ///< Those lines.
};

/// "shard-00003-of-00017.jsonl".
std::string ShardFileName(const Shard& shard);
/// Shard files of a folder, by name.
std::vector<std::string> ShardFiles(const std::string& folder);
/// Reads what can be read; lines that cannot become problems. Throws Error(kMissing | kIo), and
/// Error(kBadData) when the name is no shard's.
ShardContent ReadShardFile(const std::string& path);

/// A shard's file while its rounds are run. One writer at a time: the file beside it is locked as
/// long as this lives.
class ShardWriter {
 public:
  /// Takes the shard: drops half-written, damaged and doubled lines (told in `notes`, their bytes
  /// kept in the file of the same name and ".damaged"), so that these rounds run again. Throws
  /// Error(kInterrupted) when another process has it, Error(kCannotCreate) when the folder holds
  /// shards of another count or of another campaign, Error(kBadData) when a round stands there
  /// twice with different rows; and what files throw.
  ShardWriter(const std::string& folder, const Shard& shard, const std::string& campaign,
              std::vector<std::string>& notes);

  /// Rounds that were there already.
  const std::vector<RoundRecord>& found() const { return found_; }
  /// Adds a round and waits until it is on the disk. Throws Error(kIo) when it cannot be written
  /// whole, the file then is as before, and when file or folder were removed or renamed meanwhile.
  void Append(const RoundRecord& record);
  /// Throws Error(kIo) when the file is not where it was made any more.
  void RequireInPlace() const { file_->RequireInPlace(); }
  /// In a forked child: the parent alone keeps lock and file.
  void CloseInChild();

 private:
  std::string path_;
  std::unique_ptr<FileLock> lock_;
  std::optional<OutputFile> file_;
  std::vector<RoundRecord> found_;
};

}  // namespace tubetwin
