#include "twin/campaign/merge.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/campaign/campaign.h"
#include "twin/campaign/campaign_summary.h"
#include "twin/campaign/record_line.h"
#include "twin/campaign/shard_file.h"
#include "twin/round/folder/file_checks.h"
#include "twin/round/records/json_fields.h"
#include "twin/round/result_files.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

using Key = std::pair<int, int>;  ///< Variant, round.

struct Found {
  RoundRecord record;
  std::string where;  ///< "FILE:7"
};

[[noreturn]] void Fail(const std::string& problem) { throw Error(ErrorKind::kBadData, problem); }

void AddShard(const std::string& file, const std::string& campaign, std::map<Key, Found>& found) {
  ShardContent content = ReadShardFile(file);
  if (!content.problems.empty()) {
    Fail(content.problems.front() + "; run this shard again, that round alone is repeated");
  }
  if (content.campaign != campaign) {
    Fail(file + ": its rounds belong to another campaign than the campaign.json beside it");
  }
  for (std::size_t i = 0; i < content.records.size(); ++i) {
    RoundRecord& record = content.records[i];
    const std::string where = file + ":" + std::to_string(content.line_of[i]);
    const auto [at, is_new] = found.try_emplace({record.variant, record.round});
    if (!is_new) {
      const std::string difference = RecordDifference(at->second.record, record);
      Fail(NameOf(record) + " stands twice, in " + at->second.where + " and in " + where +
           (difference.empty() ? ", with the same rows" : ", and differs: " + difference));
    }
    at->second = {std::move(record), where};
  }
}

/// "3, 5-9, 12 and 4 more".
std::string Ranges(const std::vector<int>& rounds) {
  constexpr int kShown = 6;
  std::string out;
  int shown = 0;
  std::size_t i = 0;
  for (; i < rounds.size() && shown < kShown; ++shown) {
    std::size_t last = i;
    while (last + 1 < rounds.size() && rounds[last + 1] == rounds[last] + 1) ++last;
    out += (out.empty() ? "" : ", ") + std::to_string(rounds[i]);
    if (last > i) out += "-" + std::to_string(rounds[last]);
    i = last + 1;
  }
  if (i < rounds.size()) out += " and " + std::to_string(rounds.size() - i) + " more";
  return out;
}

/// Every round of every variant, once, with its seed.
void CheckComplete(const CampaignResult& result, const std::map<Key, Found>& found,
                   const std::vector<std::string>& folders) {
  for (int variant = 0; variant < result.variants(); ++variant) {
    std::vector<int> missing;
    for (int round = 0; round < result.identity.rounds; ++round) {
      if (found.count({variant, round}) == 0) missing.push_back(round);
    }
    if (!missing.empty()) {
      Fail("variant " + std::to_string(variant) + " ('" + result.VariantName(variant) +
           "') lacks " + std::to_string(missing.size()) + " of " +
           std::to_string(result.identity.rounds) + " rounds: " + Ranges(missing) +
           "; run or name the shards that hold them (given: " + std::to_string(folders.size()) +
           " folders)");
    }
  }
  const std::int64_t seed = result.identity.seed;
  for (const auto& [key, one] : found) {
    if (key.first >= result.variants() || key.second >= result.identity.rounds ||
        one.record.seed != RoundSeed(seed, key.second)) {
      Fail(one.where + ": " + NameOf(one.record) + " is no round of this campaign");
    }
  }
}

Key KeyOf(const JsonView& row) { return {VariantOf(row), CountFromJson(row.Field("round"))}; }

/// Records out of the three row files of a merged folder.
std::vector<RoundRecord> ReadMerged(const std::string& folder) {
  std::vector<RoundRecord> out;
  std::map<Key, std::size_t> at;
  const fs::path from(folder);
  ReadJsonLines((from / "rounds.jsonl").string(), [&](const JsonView& row) {
    RoundRecord record;
    std::tie(record.variant, record.round) = KeyOf(row);
    record.seed = row.Field("seed").AsInteger();
    record.summary = SummaryFromJson(row.Field("summary"));
    if (!at.emplace(KeyOf(row), out.size()).second) row.Fail(NameOf(record) + " stands twice");
    out.push_back(std::move(record));
  });
  const auto record_of = [&](const JsonView& row) -> RoundRecord& {
    const auto found = at.find(KeyOf(row));
    if (found == at.end()) row.Fail("its round is not in rounds.jsonl");
    return out[found->second];
  };
  ReadJsonLines((from / "picks.jsonl").string(), [&](const JsonView& row) {
    record_of(row).attempts.push_back(AttemptFromJson(row));
  });
  ReadJsonLines((from / "timings.jsonl").string(), [&](const JsonView& row) {
    record_of(row).timings.push_back(TimingFromJson(row));
  });
  return out;
}

}  // namespace

std::vector<const RoundRecord*> CampaignResult::OfVariant(int variant) const {
  std::vector<const RoundRecord*> out;
  for (const RoundRecord& record : records) {
    if (record.variant == variant) out.push_back(&record);
  }
  return out;
}

CampaignResult ReadShards(const std::vector<std::string>& folders) {
  TT_CHECK(!folders.empty());
  CampaignResult result;
  std::map<Key, Found> found;
  for (const std::string& folder : folders) {
    const CampaignIdentity identity = ReadCampaignIdentity(folder);
    if (result.identity.document.is_null()) {
      result.identity = identity;
    } else if (const auto difference = DifferenceOf(result.identity, identity)) {
      Fail(folder + ": belongs to another campaign than " + folders.front() + ": " +
           difference->what +
           (difference->build_only
                ? "\nrounds of two builds of this program are not one campaign: run all shards "
                  "with one build, or compare the two"
                : ""));
    }
    const std::vector<std::string> files = ShardFiles(folder);
    if (files.empty()) {
      throw Error(ErrorKind::kMissing, folder + ": holds no shard (shard-*.jsonl) of a campaign");
    }
    const std::string campaign = identity.fingerprint();
    for (const std::string& file : files) AddShard(file, campaign, found);
  }
  CheckComplete(result, found, folders);
  for (auto& [key, one] : found) result.records.push_back(std::move(one.record));
  return result;
}

CampaignResult ReadCampaignResult(const std::string& folder) {
  if (!fs::exists(fs::path(folder) / "rounds.jsonl")) return ReadShards({folder});
  CampaignResult result;
  result.identity = ReadCampaignIdentity(folder);
  RequireWholeFiles(folder, {"picks.jsonl", "rounds.jsonl", "timings.jsonl"},
                    /*always=*/!result.identity.build.empty());
  std::map<Key, Found> found;
  for (RoundRecord& record : ReadMerged(folder)) {
    RequireConsistent(record, folder + "/picks.jsonl");
    const Key key{record.variant, record.round};
    found[key] = {std::move(record), folder + "/rounds.jsonl"};
  }
  CheckComplete(result, found, {folder});
  for (auto& [key, one] : found) result.records.push_back(std::move(one.record));
  return result;
}

void WriteMerged(const CampaignResult& result, const std::string& folder) {
  ClaimCampaignFolder(folder, result.identity);
  const fs::path out(folder);
  std::vector<Json> rounds, picks, timings;
  for (const RoundRecord& record : result.records) {
    const RowPlace place{record.round, record.variant};
    rounds.push_back(Json{{"round", record.round},
                          {"variant", record.variant},
                          {"seed", record.seed},
                          {"summary", ToJson(record.summary)}});
    for (const AttemptRecord& attempt : record.attempts) picks.push_back(ToJson(attempt, place));
    for (const AttemptTiming& timing : record.timings) timings.push_back(ToJson(timing, place));
  }
  WriteJsonLines(picks, (out / "picks.jsonl").string());
  WriteJsonLines(timings, (out / "timings.jsonl").string());
  WriteJsonLines(rounds, (out / "rounds.jsonl").string());
  WriteJsonFile(ToJson(Summarize(result)), (out / "summary.json").string());
  Json manifest = ToJson(ManifestOf(result));
  manifest["files"] = FileChecks(
      folder, {"campaign.json", "picks.jsonl", "timings.jsonl", "rounds.jsonl", "summary.json"},
      {});
  WriteJsonFile(manifest, (out / "manifest.json").string());
}

}  // namespace tubetwin
