// Shards that are killed, damaged, doubled, fought over or out of disk: no round lost, none
// doubled.

#include "twin/campaign/shard_file.h"

#include <sys/resource.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numeric>
#include <sstream>

#include "models/base/disk/build_id.h"
#include "models/base/json.h"
#include "tests/campaign/fake_rounds.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/campaign/record_line.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

}  // namespace

TEST_CASE("17 shards in any order, five killed at random moments, merge to one run's bytes",
          "[campaign]") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(102, 2);
  const auto begun = std::chrono::steady_clock::now();
  REQUIRE(RunAll(campaign, folder / "whole").end == CampaignEnd::kDone);
  // As long as one shard takes on this machine now, so that kills fall anywhere in it.
  const auto shard_us = static_cast<std::uint32_t>(
      std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begun).count() /
      17);
  const std::string expected = MergedBytes({folder / "whole"}, folder / "merged_whole");

  RandomStream random(5, 0, "kills");
  std::vector<int> order(17);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  std::vector<std::string> folders;
  int killed = 0, kept = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Shard shard{order[i], 17};
    // Every third shard in the folder of its own that another machine would have.
    const std::string out = folder / (i % 3 == 0 ? "own" + std::to_string(i) : "shared");
    if (std::find(folders.begin(), folders.end(), out) == folders.end()) folders.push_back(out);
    if (i < 5) {
      const int code =
          InChild([&] { RunAll(campaign, out, shard); }, static_cast<int>(random.Index(shard_us)));
      killed += code == -SIGKILL ? 1 : 0;
      const std::string file = out + "/" + ShardFileName(shard);
      kept += fs::exists(file) ? static_cast<int>(ReadShardFile(file).records.size()) : 0;
    }
    REQUIRE(RunAll(campaign, out, shard).end == CampaignEnd::kDone);
  }
  INFO(killed << " killed before their end with " << kept << " rounds saved");
  CHECK(killed >= 1);
  std::reverse(folders.begin(), folders.end());
  CHECK(MergedBytes(folders, folder / "merged") == expected);
}

TEST_CASE("a changed configuration is refused with the key that differs, and nothing is lost") {
  const TemporaryFolder folder;
  RunAll(FakeCampaign(4), folder / "c");
  const std::string before = ReadFile(folder / "c/shard-00000-of-00001.jsonl");
  Campaign other = FakeCampaign(4);
  other.variants[0].scenario.planner.exclude_free = true;
  const Error refused = Refusal([&] { RunAll(other, folder / "c"); });
  CHECK(refused.kind() == ErrorKind::kCannotCreate);
  CHECK_THAT(refused.what(),
             Contains("variants.0.config.planner.exclude_free is true against false"));
  const Error seed = Refusal([&] { RunAll(FakeCampaign(4, 1, 2), folder / "c"); });
  CHECK_THAT(seed.what(), Contains("seed is 2 against 1"));
  const Error shards = Refusal([&] { RunAll(FakeCampaign(4), folder / "c", {0, 2}); });
  CHECK(shards.kind() == ErrorKind::kCannotCreate);
  CHECK_THAT(shards.what(), Contains("is split into 1 shards"));
  CHECK(ReadFile(folder / "c/shard-00000-of-00001.jsonl") == before);
  std::ofstream(folder / "picks.jsonl") << "{}\n";
  CHECK(Refusal([&] { RunAll(other, folder.path()); }).kind() == ErrorKind::kCannotCreate);
}

TEST_CASE("two processes cannot have one shard, and a dead owner's shard is free at once") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(4);
  std::vector<std::string> notes;
  ClaimCampaignFolder(folder / "c", IdentityOf(campaign, "test"));
  const std::string mark = IdentityOf(campaign, "test").fingerprint();
  {
    const ShardWriter owner(folder / "c", {0, 2}, mark, notes);
    int code = InChild([&] { RunAll(campaign, folder / "c", {0, 2}); });
    CHECK(code == static_cast<int>(ErrorKind::kInterrupted));
    code = InChild([&] { RunAll(campaign, folder / "c", {1, 2}); });
    CHECK(code == 0);
  }
  const int killed = InChild([&] {
    ShardWriter owner(folder / "c", {0, 2}, mark, notes);
    ::raise(SIGKILL);
  });
  CHECK(killed == -SIGKILL);
  CHECK(RunAll(campaign, folder / "c", {0, 2}).end == CampaignEnd::kDone);
  CHECK(ReadShards({folder / "c"}).records.size() == 4);
}

TEST_CASE("half-written, damaged and doubled lines are dropped and their rounds run again") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(6);
  RunAll(campaign, folder / "c");
  const std::string expected = MergedBytes({folder / "c"}, folder / "m");
  const std::string file = folder / "c/shard-00000-of-00001.jsonl";
  const std::string good = ReadFile(file);
  const auto line = [&](int number) {
    std::istringstream lines(good);
    std::string text;
    for (int i = 0; i < number; ++i) std::getline(lines, text);
    return text;
  };
  const auto damaged = [&](const std::string& text, const std::string& said) {
    INFO(said);
    WriteFileAtomically(file, text);
    const Error refused = Refusal([&] { ReadShards({folder / "c"}); });
    CHECK(refused.kind() == ErrorKind::kBadData);
    CHECK_THAT(refused.what(), Contains(said));
    CHECK(RunAll(campaign, folder / "c").end == CampaignEnd::kDone);
    CHECK(MergedBytes({folder / "c"}, folder / "m") == expected);
    // Every byte that was dropped is kept.
    const std::string kept = fs::exists(file + ".damaged") ? ReadFile(file + ".damaged") : "";
    std::istringstream lines(text);
    for (std::string bad; std::getline(lines, bad);) {
      CHECK((kept + good).find(bad) != std::string::npos);
    }
    fs::remove(file + ".damaged");
  };
  damaged(good.substr(0, good.size() - 40), "jsonl:7: half-written");
  damaged(good.substr(0, good.size() - 1), "jsonl:7: half-written");
  std::string flipped = good;
  flipped[good.find("\"sim_s\"") + 2] ^= 1;
  damaged(flipped, "jsonl:2: damaged");
  damaged(good + line(4) + "\n", "stands twice");
  damaged(good.substr(good.find('\n') + 1), "jsonl:1");  // The head is gone.
  damaged("", "another campaign");
  damaged("not json at all\n" + good.substr(good.find('\n') + 1), "jsonl:1");
}

TEST_CASE("a shard that is a pipe or nests without end is refused, at once") {
  const TemporaryFolder folder;
  const std::string file = folder / "shard-00000-of-00001.jsonl";
  REQUIRE(::mkfifo(file.c_str(), 0600) == 0);
  const Error pipe = Refusal([&] { ReadShardFile(file); });
  CHECK(pipe.kind() == ErrorKind::kMissing);
  CHECK_THAT(pipe.what(), Contains(file + ": is a device, pipe or socket"));
  fs::remove(file);
  std::string body = "{\"round\":" + std::string(100000, '[');
  const std::string check = Fingerprint(body + "}");
  WriteFileAtomically(file, body + ",\"check\":\"" + check + "\"}\n");
  const ShardContent deep = ReadShardFile(file);
  REQUIRE(deep.problems.size() == 1);
  CHECK_THAT(deep.problems[0],
             Contains(file + ":1: its check fits: byte 73: lists and objects nest"));
}

TEST_CASE("a round that stands twice with different rows is an error that names both lines") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(3);
  RunAll(campaign, folder / "c");
  const std::string file = folder / "c/shard-00000-of-00001.jsonl";
  RoundRecord other = ReadShardFile(file).records[1];
  other.attempts[0].success = !*other.attempts[0].success;
  std::ofstream(file, std::ios::app) << RecordLine(other) << "\n";
  const Error refused = Refusal([&] { RunAll(campaign, folder / "c"); });
  CHECK(refused.kind() == ErrorKind::kBadData);
  CHECK_THAT(refused.what(), Contains("jsonl:5") && Contains("stands already in line 3") &&
                                 Contains("differs: row 1: success"));
}

TEST_CASE("damaged lines of several resumes are kept one after another, a link is not followed") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(3);
  RunAll(campaign, folder / "c");
  const std::string file = folder / "c/shard-00000-of-00001.jsonl", kept = file + ".damaged";
  for (const char* half : {"{\"first", "{\"second"}) {
    std::ofstream(file, std::ios::app) << half;
    RunAll(campaign, folder / "c");
  }
  CHECK(ReadFile(kept) == "{\"first\n{\"second\n");
  fs::remove(kept);
  WriteFileAtomically(folder / "precious", "mine");
  fs::create_symlink("../precious", kept);
  std::ofstream(file, std::ios::app) << "{\"third";
  RunAll(campaign, folder / "c");
  CHECK(ReadFile(folder / "precious") == "mine");
  CHECK(ReadFile(kept) == "{\"third\n");
}

TEST_CASE("a campaign.json that a power cut emptied is kept and written anew, its rounds go on") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(4);
  RunAll(campaign, folder / "c", {0, 2});
  const std::string expected = ReadFile(folder / "c/campaign.json");
  for (const std::string& left : {std::string(), expected.substr(0, 100)}) {
    WriteFileAtomically(folder / "c/campaign.json", left);
    const Error refused = Refusal([&] { ReadShards({folder / "c"}); });
    CHECK(refused.kind() == ErrorKind::kBadData);
    CHECK(RunAll(campaign, folder / "c", {0, 2}).progress.done == 2);
    CHECK(ReadFile(folder / "c/campaign.json") == expected);
    CHECK(ReadFile(folder / "c/campaign.json.damaged") == left);
  }
  // The heads of shards still tell whose they are.
  WriteFileAtomically(folder / "c/campaign.json", "");
  CHECK_THAT(Refusal([&] {
               RunAll(FakeCampaign(4, 1, 2), folder / "c", {0, 2});
             }).what(),
             Contains("holds rounds of another campaign"));
}

TEST_CASE("a folder that is removed or renamed while its shard runs ends it with 74") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(40);
  const std::function<void()> kinds[] = {
      [&] { fs::remove_all(folder / "c"); },
      [&] { fs::rename(folder / "c", folder / "e"); },
      [&] { fs::remove(folder / "c/shard-00000-of-00001.jsonl"); },
  };
  for (const auto& take_away : kinds) {
    CampaignRunOptions options = Options(folder / "c");
    bool taken = false;
    int done = 0;
    options.progress = [&](const ShardProgress& progress) {
      done = progress.done;
      if (taken || done < 3) return;
      taken = true;
      take_away();
    };
    const Error refused = Refusal([&] { RunCampaign(campaign, Rounds(campaign), options); });
    CHECK(taken);
    CHECK(refused.kind() == ErrorKind::kIo);
    CHECK_THAT(refused.what(), Contains("removed or renamed"));
    CHECK(done < 40);
    if (!fs::exists(folder / "c/campaign.json")) CHECK_FALSE(fs::exists(folder / "c"));
    if (fs::exists(folder / "e")) {
      RunAll(campaign, folder / "e");
      CHECK(ReadShards({folder / "e"}).records.size() == 40);
    }
    fs::remove_all(folder / "c");
    fs::remove_all(folder / "e");
  }
}

TEST_CASE(
    "another build neither goes on with a campaign nor is merged with it, and says what to do") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(4);
  RunAll(campaign, folder / "a", {0, 2});
  RunAll(campaign, folder / "b", {1, 2});
  CHECK(ReadShards({folder / "a", folder / "b"}).records.size() == 4);
  Json identity = ReadJsonFile(folder / "b/campaign.json");
  CHECK(identity["build"] == BuildId());
  identity["build"] = "0123456789abcdef";
  WriteJsonFile(identity, folder / "b/campaign.json");
  const Error resumed = Refusal([&] { RunAll(campaign, folder / "b", {1, 2}); });
  CHECK(resumed.kind() == ErrorKind::kCannotCreate);
  CHECK_THAT(resumed.what(),
             Contains("build is " + BuildId() + " against 0123456789abcdef there") &&
                 Contains("go on with that build") && Contains("another --out"));
  const Error merged = Refusal([&] { ReadShards({folder / "a", folder / "b"}); });
  CHECK(merged.kind() == ErrorKind::kBadData);
  CHECK_THAT(merged.what(), Contains("build is " + BuildId() + " against 0123456789abcdef") &&
                                Contains("run all shards with one build"));
  // A folder of before says no build.
  identity.erase("build");
  WriteJsonFile(identity, folder / "b/campaign.json");
  CHECK_THAT(Refusal([&] {
               RunAll(campaign, folder / "b", {1, 2});
             }).what(),
             Contains(" against ? there"));
  // What was asked for comes first.
  CHECK_THAT(Refusal([&] {
               RunAll(FakeCampaign(4, 1, 2), folder / "b", {1, 2});
             }).what(),
             Contains("holds another campaign: seed is 2 against 1"));
}

TEST_CASE("a folder with files of a round or a result that are no campaign's is refused and kept") {
  for (const char* name : {"picks.jsonl", "timings.jsonl", "rounds.jsonl", "summary.json",
                           "manifest.json", "config.resolved.toml"}) {
    const TemporaryFolder folder;
    std::ofstream(folder / name) << "mine";
    const Error refused = Refusal([&] { RunAll(FakeCampaign(2), folder.path()); });
    CHECK(refused.kind() == ErrorKind::kCannotCreate);
    CHECK_THAT(refused.what(), Contains(name));
    CHECK(ReadFile(folder / name) == "mine");
  }
}

TEST_CASE("a lock that is a link to somebody's file ends with 73 and leaves the file") {
  for (const char* lock : {"campaign.lock", "shard-00000-of-00001.jsonl.lock"}) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "o");
    WriteFileAtomically(folder / "v", "PRECIOUS");
    fs::create_symlink("../v", folder / ("o/" + std::string(lock)));
    const Error refused = Refusal([&] { RunAll(FakeCampaign(2), folder / "o"); });
    CHECK(refused.kind() == ErrorKind::kCannotCreate);
    CHECK_THAT(refused.what(), Contains(lock) && Contains("symbolic link"));
    CHECK(ReadFile(folder / "v") == "PRECIOUS");
  }
}

TEST_CASE("EIO in a round is the machine's and makes no row") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(3);
  const Error refused = Refusal([&] {
    RunCampaign(
        campaign,
        [&](const RoundTask& task) -> RoundOutput {
          if (task.round < 1) return FakeRound(campaign, task);
          throw fs::filesystem_error("cannot", "work/x", std::make_error_code(std::errc::io_error));
        },
        Options(folder / "c"));
  });
  CHECK(refused.kind() == ErrorKind::kIo);
  CHECK_THAT(refused.what(), Contains("work/x: Input/output error"));
  CHECK(ReadShardFile(folder / "c/shard-00000-of-00001.jsonl").records.size() <= 1);
}

TEST_CASE("a full disk ends the run with 74 and keeps every round before it") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(40);
  const int code = InChild([&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{20000, 20000};  // Bytes that any file may grow to.
    ::setrlimit(RLIMIT_FSIZE, &limit);
    RunAll(campaign, folder / "c");
  });
  CHECK(code == static_cast<int>(ErrorKind::kIo));
  const ShardContent content = ReadShardFile(folder / "c/shard-00000-of-00001.jsonl");
  CHECK(content.problems.empty());
  CHECK(content.records.size() > 1);
  CHECK(content.records.size() < 40);
  RunAll(campaign, folder / "c");
  RunAll(campaign, folder / "whole");
  CHECK(MergedBytes({folder / "c"}, folder / "m1") ==
        MergedBytes({folder / "whole"}, folder / "m2"));
}

TEST_CASE("a disk that is full for a round's folder stops the run and makes no row") {
  const TemporaryFolder folder;
  const Campaign campaign = FakeCampaign(6);
  const Error refused = Refusal([&] {
    RunCampaign(
        campaign,
        [&](const RoundTask& task) {
          if (task.round == 3) throw Error(ErrorKind::kIo, "failures/x: No space left on device");
          return FakeRound(campaign, task);
        },
        Options(folder / "c"));
  });
  CHECK(refused.kind() == ErrorKind::kIo);
  for (const RoundRecord& record : ReadShardFile(folder / "c/shard-00000-of-00001.jsonl").records) {
    CHECK(record.round != 3);
  }
}

TEST_CASE("a folder that cannot be written ends with 73") {
  const TemporaryFolder folder;
  fs::create_directories(folder / "c");
  fs::permissions(folder / "c", fs::perms::owner_read | fs::perms::owner_exec |
                                    fs::perms::others_read | fs::perms::others_exec);
  fs::permissions(folder.path(), fs::perms::all);
  const int code = InChild([&] {
    constexpr uid_t kNobody = 65534;
    if (::getuid() == 0 && ::setuid(kNobody) != 0) ::_exit(98);  // Root may write everywhere.
    RunAll(FakeCampaign(2), folder / "c");
  });
  CHECK(code == static_cast<int>(ErrorKind::kCannotCreate));
  fs::permissions(folder / "c", fs::perms::all);
}

}  // namespace tubetwin
