#include "twin/campaign/merge.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/campaign/campaign.h"
#include "twin/campaign/campaign_summary.h"
#include "twin/campaign/record_line.h"
#include "twin/campaign/shard_file.h"
#include "twin/round/result_files.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

using Key = std::pair<int, int>;  ///< Arm, round.

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
    const auto [at, is_new] = found.try_emplace({record.arm, record.round});
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

/// Every round of every arm, once, with its seed.
void CheckComplete(const CampaignResult& result, const std::map<Key, Found>& found,
                   const std::vector<std::string>& folders) {
  for (int arm = 0; arm < result.arms(); ++arm) {
    std::vector<int> missing;
    for (int round = 0; round < result.rounds(); ++round) {
      if (found.count({arm, round}) == 0) missing.push_back(round);
    }
    if (!missing.empty()) {
      Fail("arm " + std::to_string(arm) + " ('" + result.ArmName(arm) + "') lacks " +
           std::to_string(missing.size()) + " of " + std::to_string(result.rounds()) +
           " rounds: " + Ranges(missing) + "; run or name the shards that hold them (given: " +
           std::to_string(folders.size()) + " folders)");
    }
  }
  const auto seed = result.identity["seed"].get<std::int64_t>();
  for (const auto& [key, one] : found) {
    if (key.first >= result.arms() || key.second >= result.rounds() ||
        one.record.seed != RoundSeed(seed, key.second)) {
      Fail(one.where + ": " + NameOf(one.record) + " is no round of this campaign");
    }
  }
}

/// Records out of the three row files of a merged folder.
std::vector<RoundRecord> ReadMerged(const std::string& folder) {
  std::vector<RoundRecord> out;
  std::map<Key, std::size_t> at;
  const auto each_line = [&](const std::string& name, const auto& use) {
    const std::string file = (fs::path(folder) / name).string();
    std::istringstream lines(ReadFile(file));
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
      const std::string where = file + ":" + std::to_string(++number);
      Json json = Json::parse(line, nullptr, false);
      if (json.is_discarded()) Fail(where + ": not valid JSON");
      const JsonView view(json, where);
      use(json,
          Key{static_cast<int>(view.Field("arm").AsInteger()),
              static_cast<int>(view.Field("round").AsInteger())},
          where);
    }
  };
  each_line("rounds.jsonl", [&](const Json& json, Key key, const std::string& where) {
    RoundRecord record;
    record.arm = key.first;
    record.round = key.second;
    record.seed = JsonView(json, where).Field("seed").AsInteger();
    record.summary = json["summary"];
    if (!at.emplace(key, out.size()).second) Fail(where + ": " + NameOf(record) + " stands twice");
    out.push_back(std::move(record));
  });
  for (const char* name : {"picks.jsonl", "timings.jsonl"}) {
    const bool picks = std::string(name) == "picks.jsonl";
    each_line(name, [&](Json& json, Key key, const std::string& where) {
      const auto found = at.find(key);
      if (found == at.end()) Fail(where + ": its round is not in rounds.jsonl");
      RoundRecord& record = out[found->second];
      (picks ? record.picks : record.timings).push_back(std::move(json));
    });
  }
  return out;
}

}  // namespace

std::vector<const RoundRecord*> CampaignResult::OfArm(int arm) const {
  std::vector<const RoundRecord*> out;
  for (const RoundRecord& record : records) {
    if (record.arm == arm) out.push_back(&record);
  }
  return out;
}

CampaignResult ReadShards(const std::vector<std::string>& folders) {
  TT_CHECK(!folders.empty());
  CampaignResult result;
  std::map<Key, Found> found;
  for (const std::string& folder : folders) {
    const Json identity = ReadCampaignIdentity(folder);
    if (result.identity.is_null()) {
      result.identity = identity;
    } else if (const auto difference = FirstDifference(result.identity, identity)) {
      Fail(folder + ": belongs to another campaign than " + folders.front() + ": " + *difference);
    }
    const std::vector<std::string> files = ShardFiles(folder);
    if (files.empty()) {
      throw Error(ErrorKind::kMissing, folder + ": holds no shard (shard-*.jsonl) of a campaign");
    }
    const std::string campaign = Fingerprint(identity.dump());
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
  std::map<Key, Found> found;
  for (RoundRecord& record : ReadMerged(folder)) {
    const Key key{record.arm, record.round};
    found[key] = {std::move(record), folder + "/rounds.jsonl"};
  }
  CheckComplete(result, found, {folder});
  for (auto& [key, one] : found) result.records.push_back(std::move(one.record));
  return result;
}

Json WriteMerged(const CampaignResult& result, const std::string& folder) {
  ClaimCampaignFolder(folder, result.identity);
  const fs::path out(folder);
  std::vector<Json> rounds, picks, timings;
  for (const RoundRecord& record : result.records) {
    rounds.push_back(Json{{"round", record.round},
                          {"arm", record.arm},
                          {"seed", record.seed},
                          {"summary", record.summary}});
    picks.insert(picks.end(), record.picks.begin(), record.picks.end());
    timings.insert(timings.end(), record.timings.begin(), record.timings.end());
  }
  const Json summary = CampaignSummary(result);
  WriteJsonLines(picks, (out / "picks.jsonl").string());
  WriteJsonLines(timings, (out / "timings.jsonl").string());
  WriteJsonLines(rounds, (out / "rounds.jsonl").string());
  WriteJsonFile(summary, (out / "summary.json").string());
  WriteJsonFile(CampaignManifest(result), (out / "manifest.json").string());
  return summary;
}

}  // namespace tubetwin
