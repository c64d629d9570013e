// The program as a user meets it: exit codes and messages for bad input, and small real runs.

#include <filesystem>
#include <string>

#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

const char* const kGoodPile =
    R"({"schema": "tubetwin/pile/1", "bin": {"size_m": [0.77, 0.58, 0.09]}, "part": "pvc_a",
 "tubes": [{"id": 4, "centerline_m": [[-0.24, 0, 0.0125], [0.26, 0, 0.0125]], "radius_m": 0.0125, "mass_kg": 0.055}],
 "seed": 1, "settled": false})";

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST_CASE("A missing input ends with 66 and names the file or the nearest part", "[app]") {
  const TemporaryFolder folder;
  CheckRefused(folder, "run --pile no.csv --out o", 66, "no.csv: no such file");
  CheckRefused(folder, "perceive no.pcd --part pvc_a --out t.json", 66, "no.pcd: no such file");
  CheckRefused(folder, "pile generate --part pvc_b --count 3 --seed 1 --out p.json", 66, "pvc_a");
  CHECK_FALSE(std::filesystem::exists(folder.path() + "/o"));
}

TEST_CASE("`help` is help, of the program and of every verb", "[app]") {
  const TemporaryFolder folder;
  const Outcome plain = RunProgram(folder, "help");
  CHECK(plain.code == 0);
  CHECK(plain.out == RunProgram(folder, "--help").out);
  const Outcome verb = RunProgram(folder, "help campaign run");
  CHECK(verb.code == 0);
  CHECK(verb.out == RunProgram(folder, "campaign run --help").out);
  CHECK_THAT(verb.out, Catch::Contains("[keep]") && Catch::Contains("[[variant]]") &&
                           Catch::Contains("share of rounds whose folder is kept"));
  CheckRefused(folder, "help rnu", 64, "no verb is called 'rnu'; nearest: 'run'");
}

TEST_CASE("A misspelt verb or option is told with the nearest, on every verb", "[app]") {
  const TemporaryFolder folder;
  CheckRefused(folder, "rnu --out o", 64, "no verb is called 'rnu'; nearest: 'run'");
  CheckRefused(folder, "campaign reprot o", 64,
               "no verb of `tubetwin campaign` is called 'reprot'; nearest: 'report'");
  CheckRefused(folder, "run --out o --vidoe", 64,
               "--vidoe is no option of `tubetwin run`; nearest: --video");
  CheckRefused(folder, "campaign report o --tilte=T", 64,
               "--tilte is no option of `tubetwin campaign report`; nearest: --title");
  CheckRefused(folder, "doctor --jsn", 64, "nearest: --json");
}

TEST_CASE("A wrong command line ends with 64", "[app]") {
  const TemporaryFolder folder;
  CheckRefused(folder, "fly --out o", 64, "fly");
  CheckRefused(folder, "run", 64, "--out");
  CheckRefused(folder, "run --out o --bin 0.8,0.6", 64, "0.8,0.6");
  CheckRefused(folder, "run --out o --require placed", 64, "KEY>=VALUE");
  CheckRefused(folder, "pile generate --part pvc_a --count 0 --seed 1 --out p.json", 64, "count");
}

TEST_CASE("A bad configuration ends with 78, naming file, line and the nearest key", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "unknown.toml", "seed = 1\n[pile]\ncuont = 7\n");
  CheckRefused(folder, "run unknown.toml --out o", 78, "unknown.toml:3");
  CheckRefused(folder, "run unknown.toml --out o", 78, "count");
  Write(folder, "type.toml", "[pile]\ncount = \"seven\"\n");
  CheckRefused(folder, "config check type.toml", 78, "type.toml:2");
  CheckRefused(folder, "config check type.toml --set pile.count=-3", 78, "pile.count");
  CHECK_FALSE(std::filesystem::exists(folder.path() + "/o"));
}

TEST_CASE("A bad pile ends with 65, naming file and field", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "nan.csv", "tube,index,x,y,z\n1,0,0.1,0.1,0.02\n1,1,nan,0.1,0.02\n");
  CheckRefused(folder, "run --pile nan.csv --out o", 65, "nan.csv");
  Write(folder, "empty.json",
        Replaced(kGoodPile, kGoodPile + std::string(kGoodPile).find("[{"), "[]}"));
  CheckRefused(folder, "pile show empty.json", 65, "empty.json");
  Write(
      folder, "none.json",
      R"({"schema": "tubetwin/pile/1", "bin": {"size_m": [0.77, 0.58, 0.09]}, "part": "pvc_a", "tubes": [], "seed": 1, "settled": false})");
  CheckRefused(folder, "run --pile none.json --out o", 65, "tube");
  Write(folder, "long.json", Replaced(kGoodPile, "[-0.24, 0, 0.0125]", "[-1.24, 0, 0.0125]"));
  CheckRefused(folder, "run --pile long.json --out o", 65, "diagonal");
  Write(folder, "type.json",
        Replaced(kGoodPile, "\"radius_m\": 0.0125", "\"radius_m\": \"thick\""));
  CheckRefused(folder, "run --pile type.json --out o", 65, "radius_m");
  CHECK_FALSE(std::filesystem::exists(folder.path() + "/o/picks.jsonl"));
}

TEST_CASE("Tubes that cannot lie so are refused by evaluate or simulated apart, never pruned",
          "[app]") {
  const TemporaryFolder folder;
  Write(folder, "wall.json", Replaced(kGoodPile, "[0.26, 0, 0.0125]", "[0.40, 0, 0.0125]"));
  CheckRefused(folder, "evaluate wall.json --out s.json", 65, "inside the bin's wall");
  Write(folder, "floor.json", Replaced(kGoodPile, "[0.26, 0, 0.0125]", "[0.26, 0, -0.05]"));
  CheckRefused(folder, "evaluate floor.json --out s.json", 65, "inside the bin's floor");
  CHECK_FALSE(std::filesystem::exists(folder.path() + "/s.json"));
  Write(folder, "same.csv",
        "tube,index,x,y,z\n0,0,-0.2,0,0.0125\n0,1,0.2,0,0.0125\n"
        "1,0,-0.2,0,0.0125\n1,1,0.2,0,0.0125\n");
  CheckRefused(folder, "evaluate same.csv --tube 9 --out s.json", 65, "has the tubes ");
  REQUIRE(RunProgram(folder, "evaluate same.csv --motions up --out s.json").code == 0);
  const Json scores = Json::parse(ReadFile(folder.path() + "/s.json"));
  for (const Json& candidate : scores["candidates"]) CHECK(candidate["status"] != "pruned");
}

TEST_CASE("An output that cannot be made ends with 73", "[app]") {
  const TemporaryFolder folder;
  Write(folder, "taken", "a file, no folder\n");
  CheckRefused(folder, "pile generate --part pvc_a --count 1 --seed 1 --out taken/p.json", 73,
               "taken");
}

TEST_CASE("Rows of another configuration are kept and end with 73", "[app]") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() + "/o");
  Write(folder, "o/picks.jsonl", "{}\n");
  Write(folder, "o/config.resolved.toml", "seed = 5\n");
  Write(folder, "p.json", kGoodPile);
  CheckRefused(folder, "run --pile p.json --out o", 73, "another configuration");
  CHECK(ReadFile(folder.path() + "/o/picks.jsonl") == "{}\n");
}

TEST_CASE("Images without EGL end with 69 and name the packages", "[app][render]") {
  const TemporaryFolder folder;
  Write(folder, "p.json", kGoodPile);
  CheckRefused(folder, "render p.json --out p.png", 69, "libegl",
               "__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere.json ");
  CHECK_FALSE(std::filesystem::exists(folder.path() + "/p.png"));
}

TEST_CASE("The resolved configuration reads back as itself", "[app]") {
  const TemporaryFolder folder;
  const Outcome first = RunProgram(folder, "config dump --set pile.count=5 --seed 9");
  REQUIRE(first.code == 0);
  Write(folder, "dumped.toml", first.out);
  const Outcome second = RunProgram(folder, "config dump dumped.toml");
  CHECK(second.code == 0);
  CHECK(second.out == first.out);
}

TEST_CASE("One tube is picked and placed, and the same seed gives the same rows", "[app][slow]") {
  const TemporaryFolder folder;
  Write(folder, "p.json", kGoodPile);
  const Outcome first =
      RunProgram(folder, "run --pile p.json --seed 3 --threads 1 --require 'placed>=1' --out a");
  INFO(first.err);
  REQUIRE(first.code == 0);
  const Outcome again =
      RunProgram(folder, "run a/config.resolved.toml --threads 2 --require 'placed>=2' --out b");
  CHECK(again.code == 1);  // Only one tube: the requirement does not hold.
  CHECK(ReadFile(folder.path() + "/a/picks.jsonl") == ReadFile(folder.path() + "/b/picks.jsonl"));
  CHECK(ReadFile(folder.path() + "/a/summary.json") == ReadFile(folder.path() + "/b/summary.json"));
  CHECK(ReadFile(folder.path() + "/a/start.pile.json") ==
        ReadFile(folder.path() + "/b/start.pile.json"));
  const Json row = Json::parse(ReadFile(folder.path() + "/a/picks.jsonl"));
  CHECK(row["success"] == true);
  CHECK(row["target"] == 0);
  CHECK(row["truth"]["held"] == 1);
  CHECK(row["truth"]["placed_ids"] == Json::array({4}));  // The file's own id.
  CHECK(row["truth"]["placement_error_mm"].get<double>() < 10.0);
  const bool turned = row["truth"]["placement_error_deg"].get<double>() > 10.0;
  CHECK(row["in_tolerance"] == !turned);
}

}  // namespace
}  // namespace tubetwin
