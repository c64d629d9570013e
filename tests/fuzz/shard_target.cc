// Shards of a campaign: as files, and with check sums that fit the damage.

#include <sstream>

#include "models/base/files.h"
#include "tests/fuzz/byte_target.h"
#include "tests/fuzz/corpus_files.h"
#include "tests/fuzz/memory_file.h"
#include "tests/support/temporary_folder.h"
#include "twin/campaign/campaign.h"
#include "twin/campaign/record_line.h"
#include "twin/campaign/shard_file.h"
#include "twin/round/records/attempt_facts.h"

namespace tubetwin {
namespace {

/// A line as ParseCheckedLine wants it, whatever it is.
std::string WithCheck(std::string line) {
  const std::string check = Fingerprint(line);
  if (!line.empty()) line.pop_back();
  return line + ",\"check\":\"" + check + "\"}";
}

}  // namespace

void TryBytes(std::string_view bytes) {
  static const TemporaryFolder folder;
  const std::string path = folder / "shard-00000-of-00001.jsonl";
  std::string checked;
  std::istringstream lines{std::string(bytes)};
  for (std::string line; std::getline(lines, line);) checked += WithCheck(line) + "\n";
  for (const std::string& content : {std::string(bytes), checked}) {
    WriteFileAtomically(path, content);
    TryReader("reader of shards", path, [&] {
      const ShardContent shard = ReadShardFile(path);
      for (const RoundRecord& record : shard.records) FactsOf(record);
      for (const std::string& problem : shard.problems) {
        if (problem.find(path) == std::string::npos)
          DieOf("shards", "no file is named: " + problem);
      }
    });
  }
}

std::vector<std::string> ByteCorpus() { return CorpusFiles("shard"); }

}  // namespace tubetwin
