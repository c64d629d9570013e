// Recording a round of the twin and replaying it, as a user does it; one small round for all.

#include <filesystem>
#include <fstream>
#include <memory>

#include "hw_bridge/recording/cell_recording.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

const char* const kRun =
    "run --record --seed 2 --threads 1 -q --set pile.count=1 --set scan.views=4 --out ";

/// A folder with a recorded round in `round`, made once.
const TemporaryFolder& Recorded() {
  static const std::unique_ptr<TemporaryFolder> folder = [] {
    auto made = std::make_unique<TemporaryFolder>();
    const Outcome ran = RunProgram(*made, std::string(kRun) + "round");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    return made;
  }();
  return *folder;
}

Json Replayed(const TemporaryFolder& folder, const std::string& arguments, int code) {
  const Outcome outcome = RunProgram(folder, "replay " + arguments + " --json -q");
  INFO(outcome.err);
  REQUIRE(outcome.code == code);
  return Json::parse(outcome.out);
}

/// The recording again with every event handed to `change`.
template <typename Change>
void Rewrite(const std::string& from, const std::string& to, Change change) {
  CellRecording recording(from);
  CellRecordingWriter writer(to, recording.header());
  while (auto event = recording.Next()) {
    change(*event);
    writer.Add(*event);
  }
  writer.Finish(recording.end_reason());
}

TEST_CASE("A recorded round replays to its end without a difference, on any number of threads",
          "[app][slow]") {
  const TemporaryFolder& folder = Recorded();
  const Json summary = ReadJsonFile(folder / "round/summary.json");
  std::uint64_t commands = 0, reads = 0;
  CellRecording recording(folder / "round/cell.rec.zst");
  CHECK(recording.complete());
  CHECK(recording.header().config_toml == ReadFile(folder / "round/config.resolved.toml"));
  CHECK(recording.header().seed == 2);
  while (const auto event = recording.Next()) {
    const auto* note = std::get_if<PipelineNote>(&*event);
    if (note != nullptr && note->kind == PipelineNote::Kind::kCaption) continue;
    ++(IsRead(*event) ? reads : commands);
  }
  CHECK(commands > 1000);
  for (const char* threads : {"1", "2"}) {
    const Json replayed =
        Replayed(folder, std::string("round/cell.rec.zst --verify --threads ") + threads, 0);
    CHECK(replayed["difference"].is_null());
    CHECK(replayed["complete"] == true);
    CHECK(replayed["placed"] == summary["placed"]);
    CHECK(replayed["attempts"] == summary["attempts"]);
    CHECK(replayed["commands"] == commands);
    CHECK(replayed["reads"] == reads);
    CHECK(replayed["reads_not_recorded"] == 0);
    CHECK(replayed["reads_not_asked"] == 0);
  }
  const Outcome text = RunProgram(folder, "replay round/cell.rec.zst --verify -q");
  CHECK_THAT(text.out, Catch::Contains("commands and " + std::to_string(reads) + " reads agree"));
}

TEST_CASE("Recording changes nothing in the other files, and the recording is the same again",
          "[app][slow]") {
  const TemporaryFolder& folder = Recorded();
  const std::string run = std::string(kRun) + "again";
  REQUIRE(RunProgram(folder, run).code == 0);
  for (const char* name : {"picks.jsonl", "summary.json", "recording.bin", "cell.rec.zst"}) {
    CHECK(ReadFile(folder / ("again/" + std::string(name))) ==
          ReadFile(folder / ("round/" + std::string(name))));
  }
  // A run without --record leaves no recording of another one.
  std::string plain = run;
  plain.replace(plain.find("--record "), 9, "");
  REQUIRE(RunProgram(folder, plain).code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "again/cell.rec.zst"));
  CHECK(ReadFile(folder / "again/picks.jsonl") == ReadFile(folder / "round/picks.jsonl"));
}

TEST_CASE("--verify finds a planted difference and ends with 1", "[app][slow]") {
  const TemporaryFolder& folder = Recorded();
  int commands = 0, planted_at = 0;
  Rewrite(folder / "round/cell.rec.zst", folder / "planted.rec.zst", [&](CellEvent& event) {
    if (auto* command = std::get_if<GripperCommanded>(&event); command != nullptr) {
      if (++commands == 2) {
        command->command.force_N += 1.0;
        planted_at = static_cast<int>(command->at / std::chrono::milliseconds(1));
      }
    }
  });
  REQUIRE(commands > 2);
  const Json difference = Replayed(folder, "planted.rec.zst --verify", 1)["difference"];
  CHECK(difference["kind"] == "gripper command");
  CHECK(difference["field"] == "force_N");
  CHECK(difference["recorded"] == "61");
  CHECK(difference["asked"] == "60");
  CHECK(difference["after"] == "closing");
  CHECK(difference["time_s"].get<double>() == Approx(1e-3 * planted_at));
  // Without --verify it is told as well.
  const Outcome told = RunProgram(folder, "replay planted.rec.zst -q");
  CHECK(told.code == 0);
  CHECK_THAT(told.out, Catch::Contains("first difference at ") &&
                           Catch::Contains("gripper command, force_N: recorded 61, asked 60"));
}

TEST_CASE("What was read otherwise makes the pipeline do otherwise, and that is found",
          "[app][slow]") {
  const TemporaryFolder& folder = Recorded();
  Rewrite(folder / "round/cell.rec.zst", folder / "shifted.rec.zst", [](CellEvent& event) {
    if (auto* taken = std::get_if<ScanTaken>(&event)) {
      taken->cloud_S.X_NS.translation().x() += 0.002;
    }
  });
  const Json replayed = Replayed(folder, "shifted.rec.zst --verify", 1);
  CHECK(replayed["difference"]["kind"] == "arm start");
}

TEST_CASE("A recording that was cut short agrees as far as it goes", "[app][slow]") {
  const TemporaryFolder& folder = Recorded();
  const std::string bytes = ReadFile(folder / "round/cell.rec.zst");
  std::ofstream(folder / "cut.rec.zst", std::ios::binary) << bytes.substr(0, bytes.size() * 9 / 10);
  const Json replayed = Replayed(folder, "cut.rec.zst --verify", 0);
  CHECK(replayed["complete"] == false);
  CHECK(replayed["difference"].is_null());
  CHECK(replayed["commands"] > 1000);
  const Outcome text = RunProgram(folder, "replay cut.rec.zst --verify -q");
  CHECK_THAT(text.out, Catch::Contains("where the recording was cut short"));
}

TEST_CASE("A missing recording ends with 66, a damaged one with 65 and the byte", "[app]") {
  const TemporaryFolder folder;
  CheckRefused(folder, "replay none.rec.zst", 66, "none.rec.zst: no such file");
  Write(folder, "text.rec.zst", "seed = 1\n");
  CheckRefused(folder, "replay text.rec.zst --verify", 65,
               "text.rec.zst: byte 0: no cell recording");
  {
    CellRecordingHeader header;
    header.model = LoadCellModel("leao2020");
    header.config_toml = "sead = 1\n";
    CellRecordingWriter writer(folder / "config.rec.zst", header);
    writer.Finish("");
  }
  CheckRefused(folder, "replay config.rec.zst", 65, "sead");
  std::string bytes = ReadFile(folder / "config.rec.zst");
  bytes[70] = static_cast<char>(bytes[70] ^ 1);
  Write(folder, "damaged.rec.zst", bytes);
  CheckRefused(folder, "replay damaged.rec.zst", 65,
               "damaged.rec.zst: byte 0: block 0 (header, from 0.000000 s): damaged");
}

}  // namespace
}  // namespace tubetwin
