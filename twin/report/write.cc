#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/campaign/campaign_summary.h"
#include "twin/report/campaign_page.h"
#include "twin/report/round_page.h"
#include "twin/round/attempt_facts.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

/// A round whose result folder was kept.
struct Kept {
  std::string folder;
  const RoundRecord* record = nullptr;
  std::string failure;  ///< Class of its first failed attempt; empty when none failed.
};

std::string FirstFailure(const RoundRecord& record) {
  for (const AttemptFacts& facts : FactsOf(record)) {
    if (!facts.failure.empty()) return facts.failure;
  }
  return "";
}

/// Kept rounds of the campaign below the folders, by arm and round.
std::vector<Kept> KeptRounds(const CampaignResult& result,
                             const std::vector<std::string>& folders) {
  std::map<std::pair<int, int>, const RoundRecord*> records;
  for (const RoundRecord& record : result.records) records[{record.arm, record.round}] = &record;
  std::map<std::pair<int, int>, Kept> found;
  for (const std::string& folder : folders) {
    for (const char* kind : {"failures", "samples"}) {
      std::error_code none;  // No folder: none is kept.
      for (const auto& entry : fs::directory_iterator(fs::path(folder) / kind, none)) {
        int arm = 0, round = 0;
        const std::string name = entry.path().filename().string();
        if (std::sscanf(name.c_str(), "arm-%d-round-%d", &arm, &round) != 2) continue;
        const auto record = records.find({arm, round});
        if (record == records.end()) continue;
        found.try_emplace({arm, round}, Kept{entry.path().string(), record->second,
                                             FirstFailure(*record->second)});
      }
    }
  }
  std::vector<Kept> out;
  for (auto& [key, kept] : found) out.push_back(std::move(kept));
  return out;
}

/// Failed rounds so that every class comes before any comes twice.
std::vector<const Kept*> FailedByTurns(const std::vector<Kept>& kept) {
  std::map<std::string, int> seen;
  std::vector<std::pair<int, const Kept*>> turns;
  for (const Kept& one : kept) {
    if (!one.failure.empty()) turns.emplace_back(seen[one.failure]++, &one);
  }
  std::stable_sort(turns.begin(), turns.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const Kept*> out;
  for (const auto& [turn, one] : turns) out.push_back(one);
  return out;
}

std::vector<ShownAttempt> Shown(const std::vector<Kept>& kept, const std::string& file) {
  constexpr int kSuccesses = 2;  // To see how it should be.
  ShownLimits limits;
  std::vector<ShownAttempt> out;
  const auto add = [&](const Kept& one, ShownKind kind, ShownLimits& limit) {
    auto shown = ShownAttempts(*one.record, one.folder, LinkFrom(file, one.folder), kind, limit);
    std::move(shown.begin(), shown.end(), std::back_inserter(out));
  };
  for (const Kept* one : FailedByTurns(kept)) {
    if (limits.attempts <= kSuccesses) break;
    ShownLimits failures = limits;
    failures.attempts -= kSuccesses;
    add(*one, ShownKind::kFailures, failures);
    failures.attempts += kSuccesses;
    limits = failures;
  }
  limits.attempts = kSuccesses;
  limits.scene_bytes += 500'000;  // Kept back for them: failures may have used up the rest.
  for (const Kept& one : kept) {
    if (limits.attempts > 0) add(one, ShownKind::kSuccesses, limits);
  }
  return out;
}

Json SummaryOf(const CampaignResult& result, const std::string& folder) {
  const fs::path file = fs::path(folder) / "summary.json";
  if (!fs::exists(file)) return CampaignSummary(result);
  Json summary = ReadJsonFile(file.string());
  const JsonView view(summary, file.string());
  RequireSchema(view, "campaign_summary");
  std::size_t attempts = 0;
  for (const RoundRecord& record : result.records) attempts += record.picks.size();
  const auto told = view.Field("attempts").AsInteger();
  if (told != static_cast<std::int64_t>(attempts)) {
    throw Error(ErrorKind::kBadData, file.string() + ": tells of " + std::to_string(told) +
                                         " attempts, the rows are " + std::to_string(attempts) +
                                         "; merge again");
  }
  return summary;
}

}  // namespace

std::size_t WriteCampaignReport(const std::string& folder,
                                const std::vector<std::string>& kept_folders,
                                const std::string& file) {
  const CampaignResult result = ReadCampaignResult(folder);
  std::vector<std::string> folders = {folder};
  folders.insert(folders.end(), kept_folders.begin(), kept_folders.end());
  const std::string html =
      CampaignReportHtml(result, SummaryOf(result, folder), CampaignManifest(result),
                         Shown(KeptRounds(result, folders), file));
  WriteFileAtomically(file, html);
  return html.size();
}

}  // namespace tubetwin
