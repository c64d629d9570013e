#include "twin/campaign/shard_file.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/campaign/record_line.h"
#include "twin/round/records/json_fields.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

// A child that was just forked shares the lock for a moment, also when its parent is killed then.
constexpr double kPatience_s = 2.0;
constexpr std::uint64_t kMaxLineBytes = std::uint64_t{64} << 20;  // A round of many attempts.

std::optional<Shard> ShardOfName(const std::string& name) {
  Shard shard;
  if (std::sscanf(name.c_str(), "shard-%d-of-%d.jsonl", &shard.index, &shard.count) != 2 ||
      shard.count < 1 || shard.index < 0 || shard.index >= shard.count ||
      ShardFileName(shard) != name) {
    return std::nullopt;
  }
  return shard;
}

std::string HeadLine(const Shard& shard, const std::string& campaign) {
  return CheckedLine(Json{{"schema", "tubetwin/shard/2"},
                          {"shard", shard.index},
                          {"of", shard.count},
                          {"campaign", campaign}});
}

/// Drops doubled rounds; differing ones are an error.
std::vector<RoundRecord> Unique(const ShardContent& content, const std::string& path,
                                std::vector<std::string>& notes) {
  std::vector<RoundRecord> out;
  std::map<std::pair<int, int>, std::size_t> seen;
  for (std::size_t i = 0; i < content.records.size(); ++i) {
    const RoundRecord& record = content.records[i];
    const auto [at, is_new] = seen.emplace(std::pair{record.variant, record.round}, i);
    if (is_new) {
      out.push_back(record);
      continue;
    }
    const std::string where = path + ":" + std::to_string(content.line_of[i]) + ": " +
                              NameOf(record) + " stands already in line " +
                              std::to_string(content.line_of[at->second]);
    const std::string difference = RecordDifference(content.records[at->second], record);
    if (!difference.empty()) {
      throw Error(ErrorKind::kBadData, where + " and differs: " + difference);
    }
    notes.push_back(where + "; one is dropped");
  }
  return out;
}

/// Adds the lines to the file beside the shard that holds what was dropped from it.
void KeepDamaged(const std::string& lines, const std::string& path) {
  if (lines.empty()) return;
  const std::string file = path + ".damaged";
  std::error_code ignored;  // Not there: it is made.
  const std::string before =
      fs::is_regular_file(fs::symlink_status(file, ignored)) ? ReadFile(file) : "";
  WriteFileAtomically(file, before + lines);
}

}  // namespace

std::string ShardFileName(const Shard& shard) {
  char name[64];
  std::snprintf(name, sizeof name, "shard-%05d-of-%05d.jsonl", shard.index, shard.count);
  return name;
}

std::vector<std::string> ShardFiles(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code ignored;  // An unreadable folder holds no shard, callers say so.
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (ShardOfName(entry.path().filename().string())) out.push_back(entry.path().string());
  }
  std::sort(out.begin(), out.end());
  return out;
}

ShardContent ReadShardFile(const std::string& path) {
  ShardContent out;
  const auto shard = ShardOfName(fs::path(path).filename().string());
  if (!shard) {
    throw Error(ErrorKind::kBadData, path + ": shard files are named shard-00000-of-00004.jsonl");
  }
  out.shard = *shard;
  int number = 0;
  ForEachLine(path, kMaxLineBytes, [&](const std::string& line, bool whole) {
    const std::string where = path + ":" + std::to_string(++number) + ": ";
    // A line counts when its line break is there too: the next one is written behind it.
    if (!whole) {
      out.problems.push_back(where + "half-written");
      out.damaged += line + "\n";
      return;
    }
    try {
      if (number == 1) {
        const Json head = ParseCheckedLine(line);
        const JsonView view(head, "head");
        SchemaVersion(view, "shard", 2);
        out.campaign = view.Field("campaign").AsString();
      } else {
        RoundRecord record = ParseRecordLine(line);
        if (!out.shard.Owns(record.round)) {
          throw Error(ErrorKind::kBadData, NameOf(record) + " is none of shard " + shard->Name());
        }
        out.records.push_back(std::move(record));
        out.line_of.push_back(number);
      }
    } catch (const Error& e) {
      out.problems.push_back(where + e.what());
      out.damaged += line + "\n";
    }
  });
  return out;
}

ShardWriter::ShardWriter(const std::string& folder, const Shard& shard, const std::string& campaign,
                         std::vector<std::string>& notes)
    : path_((fs::path(folder) / ShardFileName(shard)).string()) {
  const std::string lock_file = path_ + ".lock";
  lock_ = FileLock::TryTake(lock_file, kPatience_s);
  if (!lock_) {
    throw Error(ErrorKind::kInterrupted, path_ + ": shard " + shard.Name() + " is being run by " +
                                             ReadFile(lock_file) + "; wait for it to end");
  }
  lock_->Sign();
  for (const std::string& other : ShardFiles(folder)) {
    const auto found = ShardOfName(fs::path(other).filename().string());
    if (found->count != shard.count) {
      throw Error(ErrorKind::kCannotCreate,
                  folder + ": is split into " + std::to_string(found->count) + " shards (" +
                      fs::path(other).filename().string() + "), not " +
                      std::to_string(shard.count) + "; go on with " + std::to_string(found->count) +
                      ", or give another --out");
    }
  }
  const std::string head = HeadLine(shard, campaign) + "\n";
  if (!fs::exists(path_)) {
    WriteFileAtomically(path_, head);
  } else {
    const ShardContent content = ReadShardFile(path_);
    if (!content.campaign.empty() && content.campaign != campaign) {
      throw Error(ErrorKind::kCannotCreate, path_ + ": holds rounds of another campaign");
    }
    for (const std::string& problem : content.problems) notes.push_back(problem + "; dropped");
    found_ = Unique(content, path_, notes);
    KeepDamaged(content.damaged, path_);
    if (content.campaign.empty() || !content.problems.empty() ||
        found_.size() != content.records.size()) {
      WriteFileInPieces(path_, [&](OutputFile& out) {
        out.Write(head);
        for (const RoundRecord& record : found_) out.Write(RecordLine(record) + "\n");
      });
    }
  }
  file_.emplace(OutputFile::Continue(path_));
}

void ShardWriter::CloseInChild() {
  file_.reset();
  lock_.reset();  // Closing one of two descriptors keeps the parent's lock.
}

void ShardWriter::Append(const RoundRecord& record) {
  TT_CHECK(file_.has_value());
  try {
    file_->Append(RecordLine(record) + "\n");
  } catch (const Error& error) {
    throw Error(error.kind(), NameOf(record) + ": " + error.what() +
                                  "; make room and run again, all rounds before it are kept");
  }
  file_->RequireInPlace();
}

}  // namespace tubetwin
