// `tubetwin campaign` as a user meets it, with real rounds of one tube.

#include <signal.h>

#include <filesystem>

#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

const char* const kCampaign =
    "seed = 3\nrounds = 2\n[keep]\nsample = 1.0\nfilms = false\n[[variant]]\npart = \"pvc_a\"\n"
    "count = 1\n";

}  // namespace

TEST_CASE("Wrong campaigns and shards end with 64, 66, 73 or 78 and leave nothing", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "C.toml", kCampaign);
  CheckRefused(folder, "campaign run C.toml --shard 5/4 --out o", 64, "the last of 4 is 3/4");
  CheckRefused(folder, "campaign run C.toml --out o", 64, "PARALLEL_SEQ=3", "PARALLEL_SEQ=3 ");
  CheckRefused(folder, "campaign run C.toml --shard 1/4 --out o", 64, "contradicts",
               "SLURM_ARRAY_TASK_ID=2 SLURM_ARRAY_TASK_COUNT=4 ");
  CheckRefused(folder, "campaign run C.toml --limit-time soon --out o", 64, "90s, 30m or 8h");
  CheckRefused(folder, "campaign run none.toml --out o", 66, "none.toml");
  CheckRefused(folder, "campaign run C.toml --set rounds=0 --out o", 78, "rounds");
  CheckRefused(folder, "campaign status o", 66, "holds no campaign");
  CheckRefused(folder, "campaign merge o --out m", 66, "holds no campaign");
  CheckRefused(folder, "campaign compare o o", 66, "holds no campaign");
  CheckRefused(folder, "campaign report o", 66, "holds no campaign");
  CHECK_FALSE(std::filesystem::exists(folder / "o"));
  CHECK_FALSE(std::filesystem::exists(folder / "m"));
  Write(folder, "taken", "a file, no folder\n");
  CheckRefused(folder, "campaign run C.toml --out taken", 73, "taken");
}

TEST_CASE("Two shards of a campaign merge to the bytes of the whole", "[app][slow]") {
  const TemporaryFolder folder;
  Write(folder, "C.toml", kCampaign);
  const Outcome late =
      RunProgram(folder, "campaign run C.toml --out whole --jobs 1 --limit-time 1s");
  INFO(late.err);
  CHECK(late.code == 75);
  const Json half = Json::parse(RunProgram(folder, "campaign status whole --json").out);
  CHECK(half["done"] == 1);
  const Outcome whole = RunProgram(folder, "campaign run C.toml --out whole --json");
  INFO(whole.err);
  REQUIRE(whole.code == 0);
  const Json summary = Json::parse(whole.out);
  CHECK(summary["rounds"] == 2);
  CHECK(summary["tubes_start"] == 2);
  CHECK(summary["placed"] == summary["success"]["k"]);
  // A sampled round's folder repeats the round.
  const std::string kept = "whole/samples/variant-00-round-000001";
  CHECK(std::filesystem::exists(folder / (kept + "/recording.bin")));
  CHECK_FALSE(std::filesystem::exists(folder / "whole/work"));

  CHECK(RunProgram(folder, "campaign run C.toml --out s --shards 2", "JOB_COMPLETION_INDEX=0 ")
            .code == 0);
  CheckRefused(folder, "campaign merge s --out m", 65, "lacks 1 of 2 rounds: 1");
  CHECK(RunProgram(folder, "campaign run C.toml --out t --shards 2", "PARALLEL_SEQ=2 ").code == 0);
  REQUIRE(RunProgram(folder, "campaign merge t s --out m").code == 0);
  for (const char* name : {"picks.jsonl", "rounds.jsonl", "summary.json", "campaign.json"}) {
    INFO(name);
    CHECK(ReadFile(folder / ("m/" + std::string(name))) ==
          ReadFile(folder / ("whole/" + std::string(name))));
  }
  // Pages: of the whole beside its rows, of the merged one with what its shards kept, of a round.
  const Outcome page = RunProgram(folder, "campaign report whole --json");
  CHECK(Json::parse(page.out)["bytes"] == std::filesystem::file_size(folder / "whole/report.html"));
  CHECK(RunProgram(folder, "campaign report m --kept s t --out pages/m.html").out ==
        "pages/m.html\n");
  CHECK_THAT(ReadFile(folder / "pages/m.html"), Catch::Contains("id=\"stage\""));
  const std::string without_times = ReadFile(folder / (kept + "/report.html"));
  CHECK(RunProgram(folder, "campaign report " + kept).code == 0);
  CHECK_THAT(without_times, !Catch::Contains("computing: planning"));
  CHECK_THAT(ReadFile(folder / (kept + "/report.html")), Catch::Contains("computing: planning"));
  const Outcome same = RunProgram(folder, "campaign compare whole m --json");
  CHECK(Json::parse(same.out)["pairs"][0]["tests"][0]["p"] == 1.0);
  CHECK(Json::parse(RunProgram(folder, "campaign status whole --json").out)["done"] == 2);
  CheckRefused(folder, "campaign run C.toml --out whole --set planner.exclude_free=true", 73,
               "planner.exclude_free is true against false");
}

}  // namespace tubetwin
