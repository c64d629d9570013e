// The runner with rounds that take no time: what becomes of rounds, stops and limits.

#include "twin/campaign/run_campaign.h"
#include "models/base/json.h"

#include <filesystem>
#include <fstream>

#include "tests/campaign/fake_rounds.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/campaign/campaign_status.h"
#include "twin/campaign/campaign_summary.h"
#include "twin/campaign/record_line.h"
#include "twin/campaign/shard_file.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

}  // namespace

TEST_CASE("a finished shard does nothing and an empty one is finished") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(3);
  RunAll(campaign, folder / "c", {0, 5});
  int rounds = 0;
  const CampaignRun again = RunCampaign(
      campaign,
      [&](const RoundTask& task) {
        ++rounds;
        return FakeRound(campaign, task);
      },
      Options(folder / "c", {0, 5}));
  CHECK(again.end == CampaignEnd::kDone);
  CHECK(again.progress.done == 1);
  const CampaignRun empty = RunAll(campaign, folder / "c", {4, 5});
  CHECK(empty.end == CampaignEnd::kDone);
  CHECK(empty.progress.total == 0);
  RunAll(campaign, folder / "c", {1, 5});
  RunAll(campaign, folder / "c", {2, 5});
  CHECK(ReadShards({folder / "c"}).records.size() == 3);
}

TEST_CASE("a round that throws or crashes becomes a row that names it, the others are untouched") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(6, 2);
  CampaignRunOptions options = Options(folder / "c");
  std::vector<std::string> notices;
  options.notice = [&](const std::string& line) { notices.push_back(line); };
  const CampaignRun run = RunCampaign(
      campaign,
      [&](const RoundTask& task) {
        if (task.variant == 1 && task.round == 2) ::raise(SIGSEGV);
        if (task.variant == 0 && task.round == 3) throw LogicError("x < y does not hold");
        if (task.variant == 0 && task.round == 4) ::_exit(3);
        return FakeRound(campaign, task);
      },
      options);
  CHECK(run.end == CampaignEnd::kDone);
  CHECK(run.progress.faults == 3);
  const CampaignResult result = ReadShards({folder / "c"});
  const RoundRecord& crashed = result.records[6 + 2];
  REQUIRE(crashed.attempts.size() == 1);
  CHECK(crashed.round == 2);
  CHECK(crashed.variant == 1);
  CHECK(crashed.summary.crashed());
  CHECK(crashed.attempts[0].outcome == AttemptOutcome::kFault);
  CHECK(crashed.attempts[0].success == false);
  CHECK_THAT(crashed.attempts[0].reason,
             Contains("crashed: its process ended by signal 11 (Segmentation fault)"));
  CHECK_THAT(result.records[3].attempts[0].reason, Contains("x < y"));
  CHECK_THAT(result.records[4].attempts[0].reason, Contains("exit code 3"));
  CHECK(notices.size() == 3);
  WriteMerged(result, folder / "m");
  const Json summary = ReadJsonFile(folder / "m/summary.json");
  CHECK(summary["crashed"] == 3);
  CHECK(summary["variants"][1]["failures"]["crashed"] == 1);
  // Every other round is what it would have been.
  RunAll(campaign, folder / "good");
  const CampaignResult good = ReadShards({folder / "good"});
  for (std::size_t i = 0; i < good.records.size(); ++i) {
    if (i == 3 || i == 4 || i == 8) continue;
    CHECK(RecordDifference(good.records[i], result.records[i]) == "");
  }
}

TEST_CASE("a round whose process is killed from outside runs once more") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(4);
  const CampaignRun run = RunCampaign(
      campaign,
      [&](const RoundTask& task) {
        const std::string mark = folder / "once";
        if (task.round == 1 && !fs::exists(mark)) {
          std::ofstream(mark) << "here";
          ::kill(::getpid(), SIGKILL);
        }
        if (task.round == 2) ::kill(::getpid(), SIGKILL);
        return FakeRound(campaign, task);
      },
      Options(folder / "c"));
  CHECK(run.progress.faults == 1);
  const CampaignResult result = ReadShards({folder / "c"});
  CHECK(result.records[1].summary.end == RoundEnd::kEmpty);
  CHECK_THAT(result.records[2].attempts[0].reason, Contains("signal 9"));
}

TEST_CASE("a stop lets the rounds in hand end, begins no other, and the rest runs later") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(30);
  CampaignRunOptions options = Options(folder / "c");
  int done = 0;
  options.progress = [&](const ShardProgress& progress) { done = progress.done; };
  options.stop_requested = [&] { return done >= 4; };
  const CampaignRun stopped = RunCampaign(campaign, Rounds(campaign), options);
  CHECK(stopped.end == CampaignEnd::kStopped);
  CHECK(stopped.progress.done >= 4);
  CHECK(stopped.progress.done < 30);
  CHECK(ReadCampaignStatus(folder / "c").lines.at(0).state == "stopped");
  RunAll(campaign, folder / "c");
  RunAll(campaign, folder / "whole");
  CHECK(MergedBytes({folder / "c"}, folder / "m1") ==
        MergedBytes({folder / "whole"}, folder / "m2"));
}

TEST_CASE("rounds that do not end within the grace are dropped whole") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(2);
  CampaignRunOptions options = Options(folder / "c");
  options.grace_s = 0.3;
  options.stop_requested = [&] { return fs::exists(folder / "c/begun"); };
  const CampaignRun run = RunCampaign(
      campaign,
      [&](const RoundTask& task) {
        std::ofstream(folder / "c/begun") << "here";
        ::pause();
        return FakeRound(campaign, task);
      },
      options);
  CHECK(run.end == CampaignEnd::kStopped);
  CHECK(run.progress.done == 0);
  CHECK(LinesOf(folder / "c/shard-00000-of-00001.jsonl") == 1);  // The head.
}

TEST_CASE("after the time limit no round begins") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(500);
  CampaignRunOptions options = Options(folder / "c");
  options.limit_s = 0.05;
  const CampaignRun run = RunCampaign(campaign, Rounds(campaign), options);
  CHECK(run.end == CampaignEnd::kTimeLimit);
  CHECK(run.progress.done < 500);
}

TEST_CASE("what is done after the rows cannot lose them, and its words are passed on") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(3);
  CampaignRunOptions options = Options(folder / "c");
  std::vector<std::string> notices;
  options.notice = [&](const std::string& line) { notices.push_back(line); };
  RunCampaign(
      campaign,
      [&](const RoundTask& task) {
        RoundOutput out = FakeRound(campaign, task);
        if (task.round == 0) out.afterwards = [] { return std::string("no film: no EGL"); };
        if (task.round == 1) out.afterwards = []() -> std::string { std::abort(); };
        return out;
      },
      options);
  CHECK(notices == std::vector<std::string>{"variant 0 round 0: no film: no EGL"});
  const CampaignResult result = ReadShards({folder / "c"});
  CHECK(result.records[1].summary.end == RoundEnd::kEmpty);
}

TEST_CASE("the processes of rounds do not grow over 200 rounds") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(200);
  CampaignRunOptions options = Options(folder / "c");
  const auto resident_kB = [] {
    std::ifstream statm("/proc/self/statm");
    long size = 0, resident = 0;
    statm >> size >> resident;
    return resident * ::sysconf(_SC_PAGESIZE) / 1024;
  };
  long early_kB = 0, late_kB = 0;
  options.progress = [&](const ShardProgress& progress) {
    (progress.done < 50 ? early_kB : late_kB) =
        std::max(resident_kB(), progress.done < 50 ? early_kB : late_kB);
  };
  RunCampaign(campaign, Rounds(campaign), options);
  REQUIRE(early_kB > 0);
  constexpr long kPages_kB = 2048;  // The allocator's own steps.
  CHECK(late_kB <= early_kB + kPages_kB);
}

TEST_CASE("status tells rounds, success, rate and shards that fell silent") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(10, 2);
  RunAll(campaign, folder / "c", {0, 2});
  CampaignStatus status = ReadCampaignStatus(folder / "c");
  CHECK(status.rounds == 20);
  CHECK(status.done == 10);
  CHECK(status.shards == 2);
  REQUIRE(status.lines.size() == 1);
  CHECK(status.lines[0].state == "done");
  CHECK_FALSE(status.seconds_left.has_value());
  Json json = ReadJsonFile(folder / "c/status/shard-00000-of-00002.json");
  json["state"] = "running";
  json["rounds_per_hour"] = 100.0;
  WriteJsonFile(json, folder / "c/status/shard-00000-of-00002.json");
  status = ReadCampaignStatus(folder / "c");
  CHECK(status.rounds_per_hour == 100.0);
  CHECK(*status.seconds_left == Approx(360.0));
  CHECK_THAT(ToText(status), Contains("10 of 20 rounds done") && Contains("6 min left"));
  json["written_unix_s"] = json["written_unix_s"].get<std::int64_t>() - 1000;
  WriteJsonFile(json, folder / "c/status/shard-00000-of-00002.json");
  status = ReadCampaignStatus(folder / "c");
  CHECK(status.lines[0].state == "silent");
  CHECK(status.rounds_per_hour == 0.0);
  CHECK(Refusal([&] { ReadCampaignStatus(folder / "none"); }).kind() == ErrorKind::kMissing);
}

TEST_CASE("status and progress tell parts per hour, and what the rounds of several variants are") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(2, 2);
  const CampaignRun run = RunAll(campaign, folder / "c");
  const std::string line = ProgressText(run.progress);
  CHECK_THAT(line,
             Contains("4/4 rounds (2 of each of 2 variants)") && Contains(" parts/h by variant"));
  const CampaignStatus status = ReadCampaignStatus(folder / "c");
  REQUIRE(status.parts_per_hour.size() == 2);
  const CampaignResult result = ReadShards({folder / "c"});
  const CampaignManifest manifest = ManifestOf(result);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(status.parts_per_hour[i].first == campaign.variants[i].name);
    // What the merged result will say, interval included.
    CHECK(ToJson(status.parts_per_hour[i].second) == ToJson(manifest.compute_s[i].parts_per_hour));
  }
  CHECK_THAT(ToText(status), Contains("4 of 4 rounds done (2 of each of 2 variants)") &&
                                 Contains("parts per hour, computing included: variant 1"));
  const CampaignRun alone = RunAll(FakeCampaign(2), folder / "one");
  CHECK_THAT(ProgressText(alone.progress), Contains("2/2 rounds, ") && Contains(" parts/h, "));
}

}  // namespace tubetwin
