#include "twin/campaign/merge.h"
#include "models/base/json.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "models/base/error.h"
#include "models/base/files.h"
#include "tests/campaign/fake_rounds.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/campaign/campaign_summary.h"
#include "twin/campaign/record_line.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

void RunShard(const Campaign& campaign, const std::string& folder, Shard shard) {
  CampaignRunOptions options;
  options.out_folder = folder;
  options.shard = shard;
  options.program_version = "test";
  RunCampaign(
      campaign, [&](const RoundTask& task) { return FakeRound(campaign, task); }, options);
}

void CheckShardsRefused(const std::vector<std::string>& folders, ErrorKind kind,
                        const std::string& said) {
  INFO(said);
  try {
    ReadShards(folders);
    FAIL("not refused");
  } catch (const Error& e) {
    CHECK(e.kind() == kind);
    CHECK_THAT(e.what(), Contains(said));
  }
}

}  // namespace

TEST_CASE("missing rounds, doubled rounds and foreign shards are errors that name them") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(12, 2);
  RunShard(campaign, folder / "a", {0, 3});
  RunShard(campaign, folder / "b", {1, 3});
  CheckShardsRefused({folder / "a", folder / "b"}, ErrorKind::kBadData,
                     "variant 0 ('variant 0') lacks 4 of 12 rounds: 2, 5, 8, 11");
  RunShard(campaign, folder / "c", {2, 3});
  CHECK(ReadShards({folder / "c", folder / "a", folder / "b"}).records.size() == 24);
  RunShard(campaign, folder / "again", {1, 3});
  CheckShardsRefused({folder / "a", folder / "b", folder / "c", folder / "again"},
                     ErrorKind::kBadData, "variant 0 round 1 stands twice");
  CheckShardsRefused({folder / "a", folder / "b", folder / "c", folder / "again"},
                     ErrorKind::kBadData, "with the same rows");
  RunShard(FakeCampaign(12, 2, 7), folder / "other", {1, 3});
  CheckShardsRefused({folder / "a", folder / "other"}, ErrorKind::kBadData, "seed is 1 against 7");
  fs::copy_file(folder / "other/shard-00001-of-00003.jsonl",
                folder / "b/shard-00001-of-00003.jsonl", fs::copy_options::overwrite_existing);
  CheckShardsRefused({folder / "a", folder / "b", folder / "c"}, ErrorKind::kBadData,
                     "belong to another campaign");
  fs::create_directories(folder / "empty");
  CheckShardsRefused({folder / "empty"}, ErrorKind::kMissing, "holds no campaign");
}

TEST_CASE("doubled rounds that differ say in what") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(2);
  RunShard(campaign, folder / "a", {0, 1});
  CampaignRunOptions options;
  options.out_folder = folder / "b";
  options.program_version = "test";
  RunCampaign(
      campaign,
      [&](const RoundTask& task) {
        RoundOutput out = FakeRound(campaign, task);
        out.record.attempts[0].outcome = AttemptOutcome::kDropped;
        return out;
      },
      options);
  CheckShardsRefused({folder / "a", folder / "b"}, ErrorKind::kBadData, "differs: row 1: outcome");
}

TEST_CASE("a merged folder reads back as what was merged and merges nothing else over it") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(5, 2);
  RunShard(campaign, folder / "a", {0, 1});
  const CampaignResult whole = ReadShards({folder / "a"});
  WriteMerged(whole, folder / "m");
  const CampaignResult again = ReadCampaignResult(folder / "m");
  REQUIRE(again.records.size() == whole.records.size());
  for (std::size_t i = 0; i < whole.records.size(); ++i) {
    CHECK(RecordDifference(whole.records[i], again.records[i]) == "");
    CHECK(ToJson(whole.records[i]) == ToJson(again.records[i]));
  }
  RunShard(FakeCampaign(5, 2, 3), folder / "other", {0, 1});
  CHECK_THROWS_AS(WriteMerged(ReadShards({folder / "other"}), folder / "m"), Error);
  CHECK(ReadCampaignResult(folder / "m").identity.seed == 1);
}

TEST_CASE("a merged folder that lost a row or changed a value is refused by its check sums") {
  const TemporaryFolder folder;
  RunAll(FakeCampaign(6, 2), folder / "c");
  const auto damage = [&](const std::string& file, const auto& change, const std::string& said) {
    INFO(file << ": " << said);
    WriteMerged(ReadShards({folder / "c"}), folder / "m");
    CHECK(ReadCampaignResult(folder / "m").records.size() == 12);
    change(folder / ("m/" + file));
    const Error refused = Refusal([&] { ReadCampaignResult(folder / "m"); });
    CHECK(refused.kind() == ErrorKind::kBadData);
    CHECK_THAT(refused.what(), Contains("m/" + file) && Contains(said));
  };
  const auto drop_row = [](const std::string& file) {
    const std::string text = ReadFile(file);
    WriteFileAtomically(file, text.substr(text.find('\n') + 1));
  };
  const auto flip = [](const std::string& file) {
    std::string text = ReadFile(file);
    char& digit = text[text.find_first_of("0123456789", text.size() / 2)];
    digit = digit == '3' ? '4' : '3';
    WriteFileAtomically(file, text);
  };
  const auto remove = [](const std::string& file) { fs::remove(file); };
  const auto forget = [](const std::string& file) {
    Json manifest = ReadJsonFile(file);
    manifest.erase("files");
    WriteJsonFile(manifest, file);
  };
  WriteMerged(ReadShards({folder / "c"}), folder / "m");
  for (const char* rows : {"picks.jsonl", "timings.jsonl"}) {
    const int n = LinesOf(folder / ("m/" + std::string(rows)));
    damage(rows, drop_row, std::to_string(n - 1) + " rows against " + std::to_string(n));
    damage(rows, flip, "check sum");
    damage(rows, remove, "it is missing");
  }
  damage("rounds.jsonl", drop_row, "11 rows against 12");
  damage("summary.json", flip, "check sum");
  damage("manifest.json", remove, "merge the shards again");
  damage("manifest.json", forget, "merge the shards again");
}

TEST_CASE("of a merged folder without check sums, rows are compared with their rounds' summaries") {
  const TemporaryFolder folder;
  RunAll(FakeCampaign(6), folder / "c");
  const auto damage = [&](const std::string& from, const std::string& to, const std::string& said) {
    INFO(said);
    fs::remove_all(folder / "m");
    WriteMerged(ReadShards({folder / "c"}), folder / "m");
    Json identity = ReadJsonFile(folder / "m/campaign.json");
    identity.erase("build");  // As versions before 0.4 left it.
    WriteJsonFile(identity, folder / "m/campaign.json");
    fs::remove(folder / "m/manifest.json");
    CHECK(ReadCampaignResult(folder / "m").records.size() == 6);
    std::string text = ReadFile(folder / "m/picks.jsonl");
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    WriteFileAtomically(folder / "m/picks.jsonl", text);
    const Error refused = Refusal([&] { ReadCampaignResult(folder / "m"); });
    CHECK(refused.kind() == ErrorKind::kBadData);
    CHECK_THAT(refused.what(), Contains("m/picks.jsonl: variant 0 round ") && Contains(said));
  };
  damage("\"success\":true", "\"success\":false", " successes, its summary of ");
  damage("\"outcome\":\"nothing_held\"", "\"outcome\":\"dropped\"",
         " dropped tubes, its summary of ");
  WriteMerged(ReadShards({folder / "c"}), folder / "m2");
  const std::string picks = ReadFile(folder / "m2/picks.jsonl");
  damage(picks.substr(0, picks.find('\n') + 1), "", " attempts, its summary of ");
}

TEST_CASE(
    "statistics count truth, never belief, and a round's first attempt anew after each tube") {
  // Believed placed though nothing came; then placed at the second try; then two at once; one lost.
  const CampaignResult result =
      Result({Record(0,
                     {FakeAttempt(1, AttemptOutcome::kPlaced, false, 0),
                      FakeAttempt(1, AttemptOutcome::kPlaced, true, 1),
                      FakeAttempt(1, AttemptOutcome::kNothingHeld, false, 1),
                      FakeAttempt(2, AttemptOutcome::kPlaced, true, 2)},
                     FakeSummary(3, 2, 0, 120.0)),
              Record(1,
                     {FakeAttempt(1, AttemptOutcome::kPlaced, false, 2),
                      FakeAttempt(1, AttemptOutcome::kDropped, false, 2, 1)},
                     FakeSummary(3, 2, 1, 60.0)),
              Record(2, {}, FakeSummary(3, 0, 0, 10.0))});
  const Json summary = ToJson(Summarize(result));
  const Json& variant = summary["variants"][0];
  CHECK(variant["success"]["k"] == 2);
  CHECK(variant["success"]["n"] == 6);
  CHECK(variant["first_attempt"]["k"] == 1);
  CHECK(variant["first_attempt"]["n"] == 2);
  CHECK(variant["first_attempt_of_start"]["k"] == 1);
  CHECK(variant["first_attempt_of_start"]["n"] == 9);
  CHECK(variant["in_tolerance"]["k"] == 2);
  CHECK(variant["in_tolerance"]["n"] == 6);
  CHECK(variant["in_tolerance_at"]["5"]["k"] == 0);
  CHECK(variant["in_tolerance_at"]["10"]["k"] == 2);
  CHECK(variant["success"].contains("cluster95"));
  CHECK_FALSE(summary["success"].contains("cluster95"));  // Of the mix of variants.
  CHECK(variant["emptied"]["k"] == 0);
  CHECK(variant["emptied"]["n"] == 3);
  CHECK(variant["rounds"] == 3);
  CHECK(variant["several_placed"] == 1);
  CHECK(variant["outside"] == 1);
  CHECK(variant["failures"] ==
        Json{{"nothing_held", 1}, {"outside", 1}, {"placed_none", 1}, {"several_placed", 1}});
  CHECK(variant["belief"]["placed"] == Json{{"attempts", 4}, {"success", 2}});
  CHECK(variant["by_tubes_left"][0]["tubes_left"] == 3);
  CHECK(variant["by_tubes_left"][0]["success"]["n"] == 3);
  CHECK(variant["by_tubes_left"][1]["tubes_left"] == 2);
  CHECK(variant["by_tubes_left"][1]["success"]["k"] == 1);
  CHECK(variant["by_tubes_left"][1]["success"]["n"] == 2);
  CHECK(variant["by_tubes_left"][2]["tubes_left"] == 1);
  CHECK(variant["sim_s"]["attempt"]["total"]["n"] == 6);
  CHECK(variant["sim_s"]["placed_tube"]["median"] == 45.0);
  CHECK(summary["tubes_start"] == 9);
  CHECK(summary["placed"] == 4);
}

TEST_CASE("rows of before tolerances are read, merged as they were and told as not known") {
  const TemporaryFolder folder;
  RunAll(FakeCampaign(3), folder / "now");
  Json identity = ReadJsonFile(folder / "now/campaign.json");
  identity.erase("purpose");
  WriteJsonFile(identity, folder / "old/campaign.json");
  const std::string shard = "/shard-00000-of-00001.jsonl";
  const std::string mark = ReadCampaignIdentity(folder / "old").fingerprint();
  std::istringstream lines(ReadFile(folder / ("now" + shard)));
  std::string old;
  for (std::string line; std::getline(lines, line);) {
    Json json = ParseCheckedLine(line);
    if (json.contains("campaign")) json["campaign"] = mark;
    if (json.contains("picks")) {
      json["summary"].erase("tolerance");
      for (Json& row : json["picks"]) row.erase("in_tolerance");
    }
    old += CheckedLine(json) + "\n";
  }
  WriteFileAtomically(folder / ("old" + shard), old);
  WriteMerged(ReadShards({folder / "old"}), folder / "merged");
  CHECK_THAT(ReadFile(folder / "merged/picks.jsonl"), !Contains("in_tolerance"));
  const Json summary = ReadJsonFile(folder / "merged/summary.json");
  CHECK(summary["in_tolerance"]["n"] == 0);
  CHECK(summary["first_attempt_of_start"]["n"] == 9);
  CHECK(ReadJsonFile(folder / "merged/manifest.json")["purpose"].is_null());
  CHECK(ReadCampaignResult(folder / "merged").records.size() == 3);
  WriteMerged(ReadShards({folder / "now"}), folder / "new");
  CHECK(ReadJsonFile(folder / "new/manifest.json")["purpose"] == "development");
}

TEST_CASE(
    "a folder of before, whose rows say arm, is read, summed up and merged, not gone on with") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(3, 2);
  RunAll(campaign, folder / "now");
  const auto renamed = [](std::string text) {
    const std::pair<std::string, std::string> kNames[] = {
        {"\"variants\"", "\"arms\""},
        {"\"variant\"", "\"arm\""},
        {"tubetwin/campaign/2", "tubetwin/campaign/1"},
        {"tubetwin/shard/2", "tubetwin/shard/1"}};
    for (const auto& [now, before] : kNames) {
      for (auto at = text.find(now); at != std::string::npos; at = text.find(now, at + 1)) {
        text.replace(at, now.size(), before);
      }
    }
    return text;
  };
  // As an earlier version left it: its names, its check sums.
  WriteFileAtomically(folder / "old/campaign.json",
                      renamed(ReadFile(folder / "now/campaign.json")));
  const std::string shard = "/shard-00000-of-00001.jsonl";
  const std::string mark = ReadCampaignIdentity(folder / "old").fingerprint();
  std::istringstream lines(ReadFile(folder / ("now" + shard)));
  std::string old;
  for (std::string line; std::getline(lines, line);) {
    Json json = Json::parse(renamed(ParseCheckedLine(line).dump()));
    if (json.contains("campaign")) json["campaign"] = mark;
    old += CheckedLine(json) + "\n";
  }
  WriteFileAtomically(folder / ("old" + shard), old);

  const CampaignResult was = ReadCampaignResult(folder / "old");
  const CampaignResult is = ReadCampaignResult(folder / "now");
  CHECK(ToJson(Summarize(was)) == ToJson(Summarize(is)));
  WriteMerged(was, folder / "merged");
  CHECK(ReadFile(folder / "merged/campaign.json") == ReadFile(folder / "old/campaign.json"));
  CHECK(ReadCampaignResult(folder / "merged").records.size() == 6);
  const Error refused = Refusal([&] { RunAll(campaign, folder / "old"); });
  CHECK(refused.kind() == ErrorKind::kCannotCreate);
  CHECK_THAT(refused.what(), Contains("another version of the program (tubetwin/campaign/1)"));
}

}  // namespace tubetwin
