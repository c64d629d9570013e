#include "hw_bridge/recording/replay_cell.h"

#include <fstream>

#include "hw_bridge/recording/cell_recorder.h"
#include "models/base/files.h"
#include "tests/recording/random_events.h"
#include "tests/recording/restless_cell.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

constexpr int kRounds = 6;

CheckedTrajectory Move(double by_rad) {
  TrajectoryPoint from, to;
  to.q = by_rad * JointVector::Ones();
  to.time_s = 1.0;
  return std::get<CheckedTrajectory>(CheckTrajectory(PaperCell().arm, {{from, to}}));
}

/// An exercised cell's recording and what was heard of it.
struct Take {
  std::string path, heard;
};

Take RecordedTake(const TemporaryFolder& folder, bool finish = true) {
  Take take{folder / "cell.rec.zst", ""};
  test::RestlessCell cell(8);
  CellRecorder recorder(cell.cell(), {}, take.path);
  recorder.Caption("exercising");
  take.heard = test::Exercise(recorder.cell(), kRounds);
  recorder.Result("42");
  if (finish) recorder.Finish("over");
  return take;
}

TEST_CASE("A replayed cell answers everything as it was answered", "[unit]") {
  const TemporaryFolder folder;
  const Take take = RecordedTake(folder);
  ReplayCell replay{CellRecording(take.path)};
  CHECK(test::Exercise(replay.cell(), kRounds) == take.heard);
  replay.Result("42");
  replay.Finish();
  const ReplayTally& tally = replay.tally();
  CHECK_FALSE(tally.difference.has_value());
  CHECK_FALSE(tally.ran_out);
  CHECK(tally.more_reads == 0);
  CHECK(tally.missing_reads == 0);
  std::uint64_t commands = 0, reads = 0;
  CellRecording recording(take.path);
  while (const auto event = recording.Next()) {
    if (IsRead(*event)) {
      ++reads;
    } else if (!std::holds_alternative<PipelineNote>(*event)) {
      ++commands;
    }
  }
  CHECK(tally.reads == reads);
  CHECK(tally.commands == commands + 1);
}

TEST_CASE("Whichever command differs is the first difference, and nothing goes on after it",
          "[unit]") {
  const TemporaryFolder folder;
  const Take take = RecordedTake(folder);
  std::vector<std::string> kinds;
  for (int planted = 0; planted < 7 * kRounds; ++planted) {
    CAPTURE(planted);
    ReplayCell replay{CellRecording(take.path)};
    replay.Caption("step " + std::to_string(planted));
    CHECK_THROWS_AS(test::ExerciseWithPlant(replay.cell(), kRounds, planted), ReplayOver);
    REQUIRE(replay.tally().difference);
    const ReplayDifference difference = *replay.tally().difference;
    CHECK(difference.recorded != difference.asked);
    CHECK(difference.after == "step " + std::to_string(planted));
    CHECK(difference.command == replay.tally().commands);
    if (planted < 7) kinds.push_back(difference.kind + ": " + difference.field);
    CHECK_THROWS_AS(replay.cell().arm.State(), ReplayOver);
    CHECK_THROWS_AS(replay.cell().clock.AdvanceTo(TimeNs(1)), ReplayOver);
    replay.Finish();
    CHECK(replay.tally().difference->command == difference.command);
  }
  CHECK(kinds == std::vector<std::string>{"arm start: trajectory point 2 of 2, q of joint 1",
                                          "arm start: trajectory point 2 of 2, q of joint 1",
                                          "arm append: trajectory point 2 of 2, q of joint 1",
                                          "gripper command: opening_m", "payload: mass_kg",
                                          "arm stop: kind of stop", "advance: to"});
}

TEST_CASE("A difference says what was recorded, what was asked, when and after what", "[unit]") {
  const TemporaryFolder folder;
  const std::string path = folder / "cell.rec.zst";
  {
    test::RestlessCell cell(8);
    CellRecorder recorder(cell.cell(), {}, path);
    recorder.cell().clock.AdvanceTo(std::chrono::milliseconds(1500));
    recorder.cell().gripper.Command({0.02, 0.1, 60.0});
    recorder.Finish("");
  }
  ReplayCell replay{CellRecording(path)};
  replay.cell().clock.AdvanceTo(std::chrono::milliseconds(1500));
  replay.Caption("closing");
  CHECK_THROWS_AS(replay.cell().gripper.Command({0.03, 0.1, 60.0}), ReplayOver);
  CHECK(ToString(*replay.tally().difference) ==
        "at 1.5 s (closing), after 1 commands that agreed: gripper command, opening_m: "
        "recorded 0.02, asked 0.03");
  ReplayCell other{CellRecording(path)};
  CHECK_THROWS_AS(other.cell().arm.Stop(StopKind::kFast), ReplayOver);
  CHECK(other.tally().difference->field == "kind");
  CHECK(other.tally().difference->recorded == "advance to 1500 ms");
  CHECK(other.tally().difference->asked == "arm stop fast");
}

TEST_CASE("Less than was recorded and more than was recorded are differences", "[unit]") {
  const TemporaryFolder folder;
  const Take take = RecordedTake(folder);
  ReplayCell less{CellRecording(take.path)};
  test::Exercise(less.cell(), kRounds - 1);
  less.Finish();
  REQUIRE(less.tally().difference);
  CHECK(less.tally().difference->asked == "the end of the round");
  CHECK_THAT(less.tally().difference->recorded, Catch::Contains("arm start of 2 points"));
  ReplayCell more{CellRecording(take.path)};
  test::Exercise(more.cell(), kRounds);
  more.Result("42");
  CHECK_THROWS_AS(more.cell().arm.Stop(StopKind::kOnPath), ReplayOver);
  CHECK(more.tally().difference->recorded == "the end of the round");
}

TEST_CASE("Results are compared, captions are not", "[unit]") {
  const TemporaryFolder folder;
  const Take take = RecordedTake(folder);
  ReplayCell replay{CellRecording(take.path)};
  replay.Caption("exercising otherwise");
  test::Exercise(replay.cell(), kRounds);
  CHECK_THROWS_AS(replay.Result("43"), ReplayOver);
  CHECK(replay.tally().difference->kind == "result");
  CHECK(replay.tally().difference->recorded == "42");
}

TEST_CASE("Reads that were not recorded get the newest answer and are counted, likewise left ones",
          "[unit]") {
  const TemporaryFolder folder;
  const std::string path = folder / "cell.rec.zst";
  test::RestlessCell cell(8);
  WrenchSample first, second;
  {
    CellRecorder recorder(cell.cell(), {}, path);
    Cell& c = recorder.cell();
    first = c.wrist.Read();
    c.clock.AdvanceTo(kControlPeriod);
    second = c.wrist.Read();
    c.gripper.State();
    c.clock.AdvanceTo(2 * kControlPeriod);
    recorder.Finish("");
  }
  ReplayCell replay{CellRecording(path)};
  Cell& c = replay.cell();
  CHECK(c.wrist.Read().wrench_K.force_N == first.wrench_K.force_N);
  CHECK(c.wrist.Read().wrench_K.force_N == first.wrench_K.force_N);
  c.clock.AdvanceTo(kControlPeriod);
  CHECK(c.clock.Now() == kControlPeriod);
  CHECK(c.wrist.Read().wrench_K.force_N == second.wrench_K.force_N);
  c.clock.AdvanceTo(2 * kControlPeriod);
  replay.Finish();
  CHECK_FALSE(replay.tally().difference);
  CHECK(replay.tally().reads == 2);
  CHECK(replay.tally().more_reads == 2);
  CHECK(replay.tally().missing_reads == 1);
}

TEST_CASE("A read of a device that was never read is a difference", "[unit]") {
  const TemporaryFolder folder;
  const std::string path = folder / "cell.rec.zst";
  {
    test::RestlessCell cell(8);
    CellRecorder recorder(cell.cell(), {}, path);
    recorder.cell().clock.AdvanceTo(kControlPeriod);
    recorder.Finish("");
  }
  ReplayCell replay{CellRecording(path)};
  CHECK_THROWS_AS(replay.cell().gripper.State(), ReplayOver);
  CHECK(replay.tally().difference->kind == "gripper state");
}

TEST_CASE("A recording that was cut short agrees up to where it ends", "[unit]") {
  const TemporaryFolder folder;
  const Take take = RecordedTake(folder, false);
  ReplayCell replay{CellRecording(take.path)};
  CHECK_FALSE(CellRecording(take.path).complete());
  test::Exercise(replay.cell(), kRounds);
  replay.Result("42");
  CHECK_THROWS_AS(replay.cell().arm.Start(Move(0.1)), ReplayOver);
  CHECK(replay.tally().ran_out);
  CHECK_FALSE(replay.tally().difference);
}

TEST_CASE("The time can always be asked for; damage that it meets is thrown by the next call",
          "[unit]") {
  const TemporaryFolder folder;
  const Take take = RecordedTake(folder);
  std::string bytes = ReadFile(take.path);
  CellRecording whole(take.path);
  const RecordingBlock& block = whole.blocks()[1];
  bytes[block.byte + block.packed / 2 + 60] ^= 1;
  std::ofstream(folder / "damaged", std::ios::binary) << bytes;
  ReplayCell replay{CellRecording(folder / "damaged")};
  CHECK(replay.cell().clock.Now() == TimeNs(0));
  CHECK(replay.cell().clock.Now() == TimeNs(0));
  CHECK_THROWS_WITH(replay.cell().arm.State(), Catch::Contains("block 1 (events"));
  CHECK_THROWS_AS(replay.cell().arm.Stop(StopKind::kFast), Error);

  ReplayCell over{CellRecording(take.path)};
  CHECK_THROWS_AS(over.cell().arm.Stop(StopKind::kFast), ReplayOver);
  CHECK(over.cell().clock.Now() == TimeNs(0));
}

TEST_CASE("Recording a replay gives the same recording", "[unit]") {
  const TemporaryFolder folder;
  const Take take = RecordedTake(folder);
  {
    ReplayCell replay{CellRecording(take.path)};
    CellRecorder recorder(replay.cell(), replay.header(), folder / "again");
    recorder.Caption("exercising");
    test::Exercise(recorder.cell(), kRounds);
  }
  CellRecording first(take.path), again(folder / "again");
  for (;;) {
    const auto a = again.Next();
    if (!a) break;
    const auto b = first.Next();
    REQUIRE(b);
    // The recorder asks for the time of each command, which the replay only knows from reads.
    REQUIRE(a->index() == b->index());
    if (IsRead(*a)) REQUIRE(test::Bits(*a) == test::Bits(*b));
  }
}

}  // namespace
}  // namespace tubetwin
