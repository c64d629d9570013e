#include "twin/report/write_report.h"

#include <filesystem>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/campaign/fake_rounds.h"
#include "tests/report/report_fixture.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/campaign/campaign_round.h"

namespace tubetwin {
namespace {

using Catch::Contains;

/// Both variants' names are as evil as a user's can be.
Campaign EvilCampaign(int rounds) {
  Campaign campaign = FakeCampaign(rounds, 2);
  campaign.variants[0].name = "</script><script>alert(1)</script>";
  campaign.variants[1].name = "a & <img src=x onerror=\"alert(2)\">";
  return campaign;
}

}  // namespace

TEST_CASE("all numbers of a campaign's page are those of summary.json") {
  const TemporaryFolder folder;
  const Campaign campaign = EvilCampaign(30);
  RunAll(campaign, folder.path());
  WriteMerged(ReadShards({folder.path()}), folder.path());
  const Json summary = ReadJsonFile(folder / "summary.json");
  const std::string page = folder / "report.html";
  WriteCampaignReport(folder.path(), {}, page);
  const std::string html = ReadFile(page);
  const auto shown = ShownNumbers(html);
  CHECK(shown.size() > 100);
  for (const auto& [pointer, value_and_text] : shown) {
    INFO(pointer);
    CHECK(Json::parse(value_and_text.first) == summary.at(Json::json_pointer(pointer)));
  }
  for (const char* pointer :
       {"/variants/1/rounds", "/variants/1/success/cluster95/0",
        "/variants/0/by_tubes_left/2/success/cluster95/1", "/variants/0/by_motion/0/success/n",
        "/variants/1/sim_s/placed_tube/p95", "/variants/0/in_tolerance/cluster95/0",
        "/variants/0/in_tolerance_at/50/k", "/variants/1/first_attempt_of_start/n"}) {
    INFO(pointer);
    CHECK(shown.count(pointer) == 1);
  }
  const std::string markup = Markup(html);
  CHECK(UnbalancedTags(markup).empty());
  CHECK(CountOf(markup, "<svg class=\"chart-svg\"") == 1);
  CHECK(CountOf(markup, "<div class=\"bars") >= 4);  // Gantt charts and levers of two variants.
  CHECK_THAT(html, !Contains("alert(1)</script>") && !Contains("<img src") &&
                       Contains("&lt;/script&gt;&lt;script&gt;alert(1)"));
  CHECK_THAT(markup, Contains("Content-Security-Policy") && !Contains("http:"));
}

TEST_CASE("kept failures come with recording, every class before one twice, then successes") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(12);
  RunAll(campaign, folder / "shard");
  const CampaignResult result = ReadShards({folder / "shard"});
  WriteMerged(result, folder / "merged");
  int failed_rounds = 0;
  for (const RoundRecord& record : result.records) {
    const bool failed = record.attempts.size() > 3;
    const std::string kept = (failed ? "shard/failures/" : "shard/samples/") +
                             RoundFolderName(record.variant, record.round);
    WriteRecording(SmallRecording(static_cast<int>(record.attempts.size())),
                   folder / (kept + "/recording.bin"));
    failed_rounds += failed ? 1 : 0;
  }
  REQUIRE(failed_rounds >= 2);
  const std::string page = folder / "merged/report.html";
  WriteCampaignReport(folder / "merged", {folder / "shard"}, page);
  const std::string html = ReadFile(page);
  CHECK(CountOf(Markup(html), "<svg class=\"plan\"") >= failed_rounds);
  CHECK(CountOf(html, ": success</option>") == 2);
  CHECK_THAT(html, Contains("tubetwin run ../shard/failures/variant-00-round-0000") &&
                       Contains("id=\"stage\""));
  // Without being told of the shards' folder there is nothing to show, and that is no error.
  WriteCampaignReport(folder / "merged", {}, page);
  CHECK_THAT(ReadFile(page), !Contains("id=\"stage\""));
}

TEST_CASE("a summary of other rows is refused") {
  const TemporaryFolder folder;
  RunAll(FakeCampaign(4), folder.path());
  WriteMerged(ReadShards({folder.path()}), folder.path());
  Json summary = ReadJsonFile(folder / "summary.json");
  summary["attempts"] = summary["attempts"].get<int>() + 1;
  WriteJsonFile(summary, folder / "summary.json");
  const auto refused = [&](const std::string& said) {
    try {
      WriteCampaignReport(folder.path(), {}, folder / "report.html");
      FAIL("not refused");
    } catch (const Error& e) {
      CHECK(e.kind() == ErrorKind::kBadData);
      CHECK_THAT(e.what(), Contains(said));
    }
  };
  refused("summary.json: is not what was written");
  // As a folder of before 0.4, which has no check sums.
  std::filesystem::remove(folder / "manifest.json");
  Json identity = ReadJsonFile(folder / "campaign.json");
  identity.erase("build");
  WriteJsonFile(identity, folder / "campaign.json");
  refused("merge again");
}

}  // namespace tubetwin
