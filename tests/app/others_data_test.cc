// What lies in a folder and is not the program's own is neither replaced nor removed.

#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

const char* const kRun = "run --set pile.count=1 --seed 1 --threads 1 -q --out o";

/// Waits until `condition` holds, for a minute at most.
template <class Condition>
void Await(const Condition& condition) {
  for (int i = 0; i < 1200 && !condition(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  REQUIRE(condition());
}

TEST_CASE("run and emulate refuse a campaign's folder and files that they did not write", "[app]") {
  for (const std::string verb : {"run --force", "run", "emulate --any-ports --for 0.1"}) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "o/failures/variant-00-round-000001");
    Write(folder, "o/campaign.json", "{}\n");
    Write(folder, "o/failures/variant-00-round-000001/attempt.json", "mine");
    Write(folder, "o/summary.json", "mine");
    CheckRefused(folder, verb + " --set pile.count=1 --out o", 73, "holds a campaign");
    CHECK(ReadFile(folder / "o/failures/variant-00-round-000001/attempt.json") == "mine");
    CHECK(ReadFile(folder / "o/summary.json") == "mine");
  }
  for (const char* name : {"failures/mine.txt", "summary.json", "timings.jsonl", "report.html",
                           "cell.xml", "start.pile.json", "manifest.json", "given.pile.json"}) {
    const TemporaryFolder folder;
    INFO(name);
    fs::create_directories((fs::path(folder / "o") / name).parent_path());
    Write(folder, std::string("o/") + name, "mine");
    CheckRefused(folder, kRun, 73, "--force to replace it");
    CHECK(ReadFile(folder / (std::string("o/") + name)) == "mine");
    CHECK_FALSE(fs::exists(folder / "o/config.resolved.toml"));
  }
  for (const char* name : {"cell.toml", "world.json", "events.jsonl", "start.pile.json"}) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "o");
    Write(folder, std::string("o/") + name, "mine");
    CheckRefused(folder, "emulate --any-ports --for 0.1 --set pile.count=1 --out o", 73, name);
    CHECK(ReadFile(folder / (std::string("o/") + name)) == "mine");
  }
}

TEST_CASE("A round replaces what its own manifest names and leaves what lies beside it",
          "[app][slow]") {
  const TemporaryFolder folder;
  REQUIRE(RunProgram(folder, std::string(kRun) + " --record").code == 0);
  const Json manifest = ReadJsonFile(folder / "o/manifest.json");
  CHECK(manifest["verb"] == "run");
  CHECK(manifest["ended"] == true);
  CHECK(manifest["files"]["picks.jsonl"]["rows"] == Lines(ReadFile(folder / "o/picks.jsonl")));
  CHECK(manifest["files"]["cell.rec.zst"]["bytes"] == fs::file_size(folder / "o/cell.rec.zst"));
  CHECK_FALSE(fs::exists(folder / "o/.lock"));
  // What somebody put there is somebody's, also in a folder of the program's.
  fs::create_directories(folder / "o/failures/attempt_007");
  Write(folder, "o/failures/attempt_007/notes.txt", "mine");
  Write(folder, "o/notes.txt", "mine");
  REQUIRE(RunProgram(folder, kRun).code == 0);
  CHECK_FALSE(fs::exists(folder / "o/cell.rec.zst"));
  CHECK(ReadFile(folder / "o/failures/attempt_007/notes.txt") == "mine");
  CHECK(ReadFile(folder / "o/notes.txt") == "mine");
  // Rows that changed since are no rows of it.
  REQUIRE(RunProgram(folder, "campaign report o").code == 0);
  const std::string rows = ReadFile(folder / "o/picks.jsonl");
  WriteFileAtomically(folder / "o/picks.jsonl",
                      rows.substr(0, rows.rfind('\n', rows.size() - 2) + 1));
  CheckRefused(folder, "campaign report o", 65, "o/picks.jsonl: is not what was written: ");
  // Another configuration, a campaign: refused, nothing changed.
  CheckRefused(folder, "run --set pile.count=2 --seed 1 --out o", 73, "another configuration");
  Write(folder, "C.toml", "rounds = 1\n[[variant]]\ncount = 1\n");
  CheckRefused(folder, "campaign run C.toml --out o", 73, "no campaign's");
}

TEST_CASE("Of two rounds or two emulations in one folder the second is refused", "[app][slow]") {
  const TemporaryFolder folder;
  const auto busy = [&] { return fs::exists(folder / "o/.lock"); };
  // What runs in the background; the names are there for whoever reads an outcome.
  Write(folder, "out.txt", "");
  Write(folder, "err.txt", "");
  const std::string aside = "> first.txt 2>&1 & echo $! > '" + folder.path() + "/pid'";
  REQUIRE(RunProgram(folder, kRun, "exec ", aside).code == 0);
  Await(busy);
  CheckRefused(folder, "run --set pile.count=2 --seed 2 --out o", 73,
               "is being filled by process ");
  Await([&] { return !busy(); });
  CHECK(ReadJsonFile(folder / "o/manifest.json")["seed"] == 1);
  CHECK(ReadJsonFile(folder / "o/summary.json")["tubes_start"] == 1);
  const std::string emulate = "emulate --any-ports --set pile.count=1 --seed 1 --out o";
  CheckRefused(folder, emulate, 73, "which no `tubetwin emulate` wrote");  // The round's.
  fs::remove_all(folder / "o");
  REQUIRE(RunProgram(folder, emulate + " --for 1000", "exec ", aside).code == 0);
  Await([&] { return fs::exists(folder / "o/cell.toml"); });
  const std::string cell = ReadFile(folder / "o/cell.toml");
  CheckRefused(folder, emulate, 73, "is being filled by process ");
  CHECK(ReadFile(folder / "o/cell.toml") == cell);
  REQUIRE(std::system(("kill $(cat '" + folder.path() + "/pid')").c_str()) == 0);
  Await([&] { return !busy(); });
  // The emulation's own folder serves it again.
  CHECK(RunProgram(folder, emulate + " --for 0.1").code == 0);
}

TEST_CASE("Without EGL a film is refused before the round, which leaves nothing", "[app]") {
  const TemporaryFolder folder;
  CheckRefused(folder, std::string(kRun) + " --video", 69, "libegl",
               "__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent.json ");
  CHECK_FALSE(fs::exists(folder / "o"));
  CheckRefused(folder, std::string(kRun) + " --video --dry-run", 64, "--video: only a round");
}

TEST_CASE("A full disk is told by the name of what was to be written and the reason",
          "[app][slow]") {
  const TemporaryFolder folder;
  const std::string small = "ulimit -f 100; ";  // Files of 100 blocks of 512 or 1024 B.
  CheckRefused(folder, "run --set pile.count=1 --seed 1 --record --out o -q", 74,
               "o/cell.rec.zst: cannot be written at byte ", small);
  CHECK(fs::exists(folder / "o/summary.json"));
  const Outcome replayed = RunProgram(folder, "replay o/cell.rec.zst --verify -q");
  INFO(replayed.err);
  CHECK(replayed.code == 0);
  CHECK_THAT(replayed.out, Contains("where the recording was cut short"));
  CheckRefused(folder, "replay o/cell.rec.zst --mcap m/x.mcap", 74,
               "m/x.mcap: cannot be written at byte ", small);
  CHECK(fs::is_empty(folder / "m"));
}

}  // namespace
}  // namespace tubetwin
