// Whose the files of a result folder are, and when its rows are on the disk.

#include "twin/round/folder/result_folder.h"

#include <algorithm>
#include <filesystem>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/full_disk.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"
#include "twin/round/folder/file_checks.h"
#include "twin/round/round_recorder.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

const ResultFolder::Claim kClaim{
    "run", {"rows.jsonl", "page.html", "given.toml", "failures"}, false};

/// Fills the folder as a whole call of a verb does.
void Fill(const std::string& path, const std::string& content) {
  ResultFolder folder(path, kClaim);
  folder.Begin({"given.toml"});
  WriteFileAtomically(path + "/rows.jsonl", content + "\n");
  WriteFileAtomically(path + "/page.html", content);
  WriteFileAtomically(path + "/given.toml", content);
  folder.Add({"failures/attempt_001/view.pcd", "failures/attempt_001/film.mp4"});
  WriteFileAtomically(path + "/failures/attempt_001/view.pcd", content);
  folder.End(Json{{"schema", "tubetwin/manifest/1"}}, {"page.html"});
}

}  // namespace

TEST_CASE("a manifest names all files and has the checks of those that stay as they are") {
  const TemporaryFolder folder;
  Fill(folder / "o", "a");
  const Json files = ReadJsonFile(folder / "o/manifest.json")["files"];
  CHECK(files["rows.jsonl"] == Json{{"bytes", 2}, {"rows", 1}, {"check", Fingerprint("a\n")}});
  CHECK(files["failures/attempt_001/view.pcd"] == Json{{"bytes", 1}, {"check", Fingerprint("a")}});
  for (const char* name : {"page.html", "failures", "failures/attempt_001/film.mp4"}) {
    CHECK(files[name].is_null());
  }
  RequireWholeFiles(folder / "o", {"rows.jsonl"}, true);
  fs::remove(folder / "o/failures/attempt_001/view.pcd");  // To save room.
  RequireWholeFiles(folder / "o", {"rows.jsonl"}, true);
  WriteFileAtomically(folder / "o/given.toml", "b");
  CHECK_THAT(Refused([&] { RequireWholeFiles(folder / "o", {"rows.jsonl"}, true); }).what(),
             Contains("o/given.toml: is not what was written: check sum"));
}

TEST_CASE("the next call removes what the manifest names, but for what it still reads") {
  const TemporaryFolder folder;
  Fill(folder / "o", "a");
  WriteFileAtomically(folder / "o/mine.txt", "mine");
  WriteFileAtomically(folder / "o/failures/attempt_001/mine.txt", "mine");
  fs::create_directory(folder / "o/failures/mine");
  ResultFolder again(folder / "o", kClaim);
  again.Begin({"given.toml"});
  CHECK_FALSE(fs::exists(folder / "o/rows.jsonl"));
  CHECK_FALSE(fs::exists(folder / "o/page.html"));
  CHECK_FALSE(fs::exists(folder / "o/failures/attempt_001/view.pcd"));
  CHECK(ReadFile(folder / "o/given.toml") == "a");
  CHECK(ReadFile(folder / "o/mine.txt") == "mine");
  CHECK(ReadFile(folder / "o/failures/attempt_001/mine.txt") == "mine");
  CHECK(fs::exists(folder / "o/failures/mine"));
}

TEST_CASE("what a killed call had begun is the next one's, to the last file") {
  const TemporaryFolder folder;
  {
    ResultFolder killed(folder / "o", kClaim);
    killed.Begin({});
    WriteFileAtomically(folder / "o/rows.jsonl", "half");
    killed.Add({"failures/attempt_001/view.pcd"});
    WriteFileAtomically(folder / "o/failures/attempt_001/view.pcd", "half");
  }
  ResultFolder next(folder / "o", kClaim);
  next.Begin({});
  CHECK_FALSE(fs::exists(folder / "o/rows.jsonl"));
  CHECK_FALSE(fs::exists(folder / "o/failures"));
}

TEST_CASE("a manifest leads nowhere out of its folder, by dots, names or links") {
  const TemporaryFolder folder;
  const std::string mine = folder / "mine.txt";
  WriteFileAtomically(mine, "mine");
  fs::create_directory(folder / "elsewhere");
  WriteFileAtomically(folder / "elsewhere/view.pcd", "mine");
  fs::create_directory(folder / "o");
  fs::create_directory_symlink("../elsewhere", folder / "o/failures");
  WriteJsonFile(Json{{"verb", "run"},
                     {"files",
                      {{"../mine.txt", nullptr},
                       {mine, nullptr},
                       {"failures", nullptr},
                       {"failures/view.pcd", nullptr},
                       {"failures/../../mine.txt", nullptr}}}},
                folder / "o/manifest.json");
  ResultFolder taken(folder / "o", kClaim);
  taken.Begin({});
  CHECK(ReadFile(mine) == "mine");
  CHECK(ReadFile(folder / "elsewhere/view.pcd") == "mine");
}

TEST_CASE("what no manifest of the verb names is refused; a campaign's folder always") {
  const TemporaryFolder folder;
  WriteFileAtomically(folder / "o/failures/mine.txt", "mine");
  const Error refused = Refused([&] { ResultFolder(folder / "o", kClaim); });
  CHECK(refused.kind() == ErrorKind::kCannotCreate);
  CHECK_THAT(refused.what(), Contains("holds failures, which no `tubetwin run` wrote"));
  CHECK_FALSE(fs::exists(folder / "o/.lock"));
  ResultFolder::Claim forced = kClaim;
  forced.force = true;
  {
    ResultFolder taken(folder / "o", forced);
    taken.Begin({});
  }
  CHECK(ReadFile(folder / "o/failures/mine.txt") == "mine");
  // Another verb's manifest, one that is none, a link that leads nowhere.
  Fill(folder / "p", "a");
  CHECK_THAT(Refused([&] {
               ResultFolder(folder / "p", {"emulate", {"rows.jsonl"}, false});
             }).what(),
             Contains("no `tubetwin emulate` wrote"));
  WriteFileAtomically(folder / "p/manifest.json", "{\"verb\": \"run\", \"files\": [");
  CHECK_THROWS_AS(ResultFolder(folder / "p", kClaim), Error);
  fs::create_directory(folder / "q");
  fs::create_symlink("nowhere", folder / "q/rows.jsonl");
  CHECK_THROWS_AS(ResultFolder(folder / "q", kClaim), Error);
  WriteFileAtomically(folder / "c/campaign.json", "{}");
  CHECK_THAT(Refused([&] { ResultFolder(folder / "c", forced); }).what(),
             Contains("holds a campaign"));
}

TEST_CASE("a folder is filled by one call at a time") {
  const TemporaryFolder folder;
  {
    const ResultFolder first(folder / "o", kClaim);
    const Error refused = Refused([&] { ResultFolder(folder / "o", kClaim); });
    CHECK(refused.kind() == ErrorKind::kCannotCreate);
    CHECK_THAT(refused.what(), Contains("is being filled by " + ThisProcess()));
  }
  CHECK(fs::is_empty(folder / "o"));
  ResultFolder(folder / "o", kClaim).Begin({});
}

TEST_CASE("each row of a cell without truth is on the disk when its attempt ends") {
  const TemporaryFolder folder;
  RoundOptions options;
  options.out_folder = folder.path();
  options.keep = RoundKeep::kRows;
  RoundRecorder recorder(RoundScorer(), options);
  recorder.SaveRowsAtOnce();
  AttemptReport report;
  report.outcome = AttemptOutcome::kPlaced;
  const auto rows = [&](const char* name) {
    const std::string text = ReadFile(folder / name);
    return std::count(text.begin(), text.end(), '\n');
  };
  for (int attempt = 1; attempt <= 3; ++attempt) {
    report.attempt = attempt;
    recorder.OnAttemptEnd(report);
    CHECK(rows("picks.jsonl") == attempt);
    CHECK(rows("timings.jsonl") == attempt);
  }
  std::string all;
  for (const AttemptRecord& record : recorder.attempts) {
    all += ToJson(record, RowPlace()).dump() + "\n";
  }
  CHECK(ReadFile(folder / "picks.jsonl") == all);
  {
    const FullDisk full(all.size() + 10);
    report.attempt = 4;
    CHECK(Refused([&] { recorder.OnAttemptEnd(report); }).kind() == ErrorKind::kIo);
  }
  CHECK(ReadFile(folder / "picks.jsonl") == all);
}

}  // namespace tubetwin
