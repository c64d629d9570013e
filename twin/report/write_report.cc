#include "twin/report/write_report.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/campaign/campaign_round.h"
#include "twin/round/records/json_fields.h"
#include "twin/round/result_files.h"

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
  for (const AttemptFacts& facts : FactsOf(record).attempts) {
    if (!facts.failure.empty()) return facts.failure;
  }
  return "";
}

/// Kept rounds of the campaign below the folders, by variant and round.
std::vector<Kept> KeptRounds(const CampaignResult& result,
                             const std::vector<std::string>& folders) {
  std::map<std::pair<int, int>, const RoundRecord*> records;
  for (const RoundRecord& record : result.records) {
    records[{record.variant, record.round}] = &record;
  }
  std::map<std::pair<int, int>, Kept> found;
  for (const std::string& folder : folders) {
    for (const char* kind : {"failures", "samples"}) {
      std::error_code none;  // No folder: none is kept.
      for (const auto& entry : fs::directory_iterator(fs::path(folder) / kind, none)) {
        const auto key = RoundOfFolderName(entry.path().filename().string());
        const auto record = key ? records.find(*key) : records.end();
        if (record == records.end()) continue;
        found.try_emplace(
            *key, Kept{entry.path().string(), record->second, FirstFailure(*record->second)});
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

std::vector<ShownAttempt> ChooseShown(const std::vector<Kept>& kept, const std::string& file) {
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

/// A summary beside the rows that was made of other rows is a sign of a half-done merge.
void CheckSummary(const CampaignResult& result, const std::string& folder) {
  const fs::path file = fs::path(folder) / "summary.json";
  if (!fs::exists(file)) return;
  const Json summary = ReadJsonFile(file.string());
  const JsonView view(summary, file.string());
  SchemaVersion(view, "campaign_summary", 2);
  std::size_t attempts = 0;
  for (const RoundRecord& record : result.records) attempts += record.attempts.size();
  const auto told = view.Field("attempts").AsInteger();
  if (told != static_cast<std::int64_t>(attempts)) {
    throw Error(ErrorKind::kBadData, file.string() + ": tells of " + std::to_string(told) +
                                         " attempts, the rows are " + std::to_string(attempts) +
                                         "; merge again");
  }
}

std::size_t Write(const std::string& file, const std::string& html) {
  WriteFileAtomically(file, html);
  return html.size();
}

}  // namespace

ReportInput CampaignReportInput(CampaignResult result, const std::vector<Metric>& metrics) {
  ReportInput input;
  input.result = std::move(result);
  input.summary = Summarize(input.result, metrics);
  input.manifest = ManifestOf(input.result);
  return input;
}

ReportInput RoundReportInput(RoundRecord record, bool computing_times,
                             const std::vector<Metric>& metrics) {
  CampaignResult one;
  one.identity.seed = record.seed;
  one.identity.rounds = 1;
  one.identity.variants = {"this round"};
  one.records.push_back(std::move(record));
  ReportInput input = CampaignReportInput(std::move(one), metrics);
  input.computing_times = computing_times;
  input.is_round = true;
  return input;
}

std::string LinkFrom(const std::string& file, const std::string& folder) {
  const fs::path from = fs::absolute(file).parent_path();
  const std::string link =
      fs::absolute(folder).lexically_normal().lexically_relative(from.lexically_normal()).string();
  return link == "." || link == "./" ? "" : link;
}

std::size_t WriteRoundReport(const std::string& folder, const std::string& file,
                             bool computing_times, const ReportHead& head) {
  const fs::path at(folder);
  const RoundRecord record = ReadRoundRecord(folder);
  KeptForReport kept;
  ShownLimits limits;
  kept.link = LinkFrom(file, folder);
  kept.attempts = ShownAttempts(record, folder, kept.link, ShownKind::kAll, limits);
  if (fs::exists(at / "picture.png")) {
    kept.picture = Base64(ReadFile((at / "picture.png").string()));
  }
  if (fs::exists(at / "video.mp4")) kept.video = (fs::path(kept.link) / "video.mp4").string();
  ReportInput input = RoundReportInput(record, computing_times);
  input.title = head.title;
  input.customer = head.customer;
  input.setups = {SetupOfRound(folder)};
  return Write(file, ReportHtml(input, kept, RoundSummaryJson(record)));
}

std::size_t WriteCampaignReport(const std::string& folder,
                                const std::vector<std::string>& kept_folders,
                                const std::string& file, const ReportHead& head) {
  ReportInput input = CampaignReportInput(ReadCampaignResult(folder));
  input.title = head.title;
  input.customer = head.customer;
  input.setups = SetupsOf(input.result.identity);
  CheckSummary(input.result, folder);
  std::vector<std::string> folders = {folder};
  folders.insert(folders.end(), kept_folders.begin(), kept_folders.end());
  KeptForReport kept;
  const std::vector<Kept> rounds = KeptRounds(input.result, folders);
  for (const Kept& one : rounds) {
    AddStartPile(one.folder, input.setups.at(static_cast<std::size_t>(one.record->variant)));
  }
  kept.attempts = ChooseShown(rounds, file);
  return Write(file, ReportHtml(input, kept, ToJson(input.summary)));
}

}  // namespace tubetwin
