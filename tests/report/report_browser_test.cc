// Reports as a browser shows them. Needs chromium; without it, it says so and checks nothing.

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>

#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/campaign/fake_rounds.h"
#include "tests/report/report_fixture.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/campaign/campaign_round.h"
#include "twin/report/write_report.h"
#include "twin/round/result_files.h"

namespace tubetwin {
namespace {

constexpr std::uintmax_t kMostBytes = 10'000'000;  // "Page below 10 MB".

bool HasBrowser() {
  if (std::system("command -v chromium > /dev/null 2>&1") == 0) return true;
  WARN("SKIPPED: chromium is not installed, the pages were not opened (apt-get install chromium)");
  return false;
}

/// Runs all checks of report_browser.py on a page; returns its exit code and what it said.
int Browse(const TemporaryFolder& folder, const std::string& page, const std::string& summary,
           std::string& said) {
  const std::string log = folder / "browser.log";
  const std::string command = std::string("python3 '") + TUBETWIN_SOURCE_DIR +
                              "/tests/report/report_browser.py' '" + page + "' '" + summary +
                              "' > '" + log + "' 2>&1";
  const int status = std::system(command.c_str());
  said = ReadFile(log);
  return WEXITSTATUS(status);
}

void CheckInBrowser(const TemporaryFolder& folder, const std::string& page,
                    const std::string& summary) {
  CHECK(std::filesystem::file_size(page) < kMostBytes);
  std::string said;
  const int code = Browse(folder, page, summary, said);
  INFO(said);
  CHECK(code == 0);
  WARN(said);  // How long opening took: a figure to read, not one that a busy machine may fail.
}

}  // namespace

TEST_CASE("a campaign of 4,000 attempts opens without complaint or request, its numbers right") {
  if (!HasBrowser()) return;
  const TemporaryFolder folder;
  Campaign campaign = FakeCampaign(660, 2);
  campaign.variants[0].name = "</script><script>alert(1)</script>";
  campaign.variants[1].name = "a & <img src=x onerror=\"alert(2)\">";
  RunAll(campaign, folder.path());
  const CampaignResult result = ReadShards({folder.path()});
  std::size_t attempts = 0;
  int kept = 0;
  for (const RoundRecord& record : result.records) {
    attempts += record.attempts.size();
    if (record.attempts.size() <= 3 || kept >= 20) continue;
    ++kept;
    const std::string name = "failures/" + RoundFolderName(record.variant, record.round);
    WriteRecording(SmallRecording(static_cast<int>(record.attempts.size())),
                   folder / (name + "/recording.bin"));
  }
  REQUIRE(attempts >= 4000);
  WriteMerged(result, folder.path());
  WriteCampaignReport(folder.path(), {}, folder / "report.html");
  CheckInBrowser(folder, folder / "report.html", folder / "summary.json");
}

TEST_CASE("a round's page opens without complaint or request, its numbers right") {
  if (!HasBrowser()) return;
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(1);
  const RoundRecord round = FakeRound(campaign, {0, 0, 3, true}).record;
  WriteRoundRecord(round, folder.path());
  WriteRecording(SmallRecording(round.summary.attempts), folder / "recording.bin");
  WriteRoundReport(folder.path(), folder / "report.html", false);
  CheckInBrowser(folder, folder / "report.html", folder / "summary.json");

  // The checks themselves find what they look for.
  const std::string html = ReadFile(folder / "report.html");
  const auto fails = [&](const std::string& what, const std::string& by, const std::string& said) {
    std::string spoilt = html, found;
    const std::size_t at = spoilt.find(what);
    REQUIRE(at != std::string::npos);
    spoilt.replace(at, what.size(), by);
    WriteFileAtomically(folder / "spoilt.html", spoilt);
    CHECK(Browse(folder, folder / "spoilt.html", folder / "summary.json", found) != 0);
    CHECK_THAT(found, Catch::Contains(said));
  };
  fails("<footer>", "<script>console.error('oh')</script><footer>", "console: ['oh']");
  fails("<footer>", "<img src='https://example.invalid/x.png'><footer>", "log: ");
  fails("data-at=\"/placed\">3<", "data-at=\"/placed\">4<", "/placed: 4");
}

}  // namespace tubetwin
