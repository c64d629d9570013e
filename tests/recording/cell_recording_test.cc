#include "hw_bridge/recording/cell_recording.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include "hw_bridge/recording/cell_recorder.h"
#include "hw_bridge/recording/recording_blocks.h"
#include "models/base/files.h"
#include "tests/recording/random_events.h"
#include "tests/recording/restless_cell.h"
#include "tests/support/catch.h"
#include "tests/support/full_disk.h"
#include "tests/support/paper_cell.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using test::Bits;

CellRecordingHeader Header() {
  CellRecordingHeader header;
  header.versions = {{"program", "1.2.3"}};
  header.seed = 17;
  header.model = PaperCell();
  header.config_toml = "seed = 17\nprofile = \"best\"\n";
  header.fingerprint = Fingerprint(header.config_toml);
  header.part = LoadPart("hose_b");
  return header;
}

void WriteBytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

/// Bits of all events of a recording.
std::vector<std::string> EventsOf(CellRecording& recording) {
  std::vector<std::string> out;
  while (const auto event = recording.Next()) out.push_back(Bits(*event));
  return out;
}

std::vector<std::string> EventsOf(const std::string& path) {
  CellRecording recording(path);
  return EventsOf(recording);
}

/// Records an exercised cell; returns the path.
std::string Recorded(const TemporaryFolder& folder, int rounds, bool finish = true) {
  const std::string path = folder / "cell.rec.zst";
  test::RestlessCell cell(5);
  CellRecorder recorder(cell.cell(), Header(), path);
  recorder.Caption("exercising");
  test::Exercise(recorder.cell(), rounds);
  recorder.Result("{\"done\":true}");
  if (finish) recorder.Finish("the round is over");
  return path;
}

TEST_CASE("A file gives back what was added, in order, with header and end", "[unit]") {
  const TemporaryFolder folder;
  const std::string path = folder / "deep/cell.rec.zst";
  RandomStream stream(9, 0, "file");
  std::vector<std::string> added;
  CellRecordingHeader header = Header();
  header.model.layout.X_FS = MakeTransform(RotX(0.3) * RotZ(1.1), Vector3(0.1, 0.2, 1.0 / 3.0));
  header.bin.X_BN = MakeTransform(RotY(0.01), Vector3(0.6, 0.0, 0.1));
  header.held = "{\"attempt\":2}";
  {
    CellRecordingWriter writer(path, header);
    for (int i = 0; i < 5000; ++i) {
      CellEvent event = test::RandomEvent(stream);
      if (i % 500 == 0) {
        event = ScanTaken{TimeNs(i), test::RandomCloud(stream, 30, 20, i % 1000 == 0)};
      }
      added.push_back(Bits(event));
      writer.Add(event);
    }
    writer.Finish("enough");
    CHECK(writer.bytes_written() == std::filesystem::file_size(path));
  }
  CellRecording recording(path);
  CHECK(recording.indexed());
  CHECK(recording.complete());
  CHECK(recording.end_reason() == "enough");
  CHECK(recording.dropped_bytes() == 0);
  const CellRecordingHeader& back = recording.header();
  CHECK(back.versions == header.versions);
  CHECK(back.seed == 17);
  CHECK(back.config_toml == header.config_toml);
  CHECK(back.fingerprint == header.fingerprint);
  CHECK(back.held == header.held);
  CHECK(back.part.name == "hose_b");
  CHECK(back.part.links == header.part.links);
  CHECK(back.model.layout.X_FS.matrix() == header.model.layout.X_FS.matrix());
  CHECK(back.bin.X_BN.matrix() == header.bin.X_BN.matrix());
  CHECK(EventsOf(recording) == added);
}

TEST_CASE("A recorded cell answers as it does without a recorder, and the file is the same again",
          "[unit]") {
  const TemporaryFolder folder;
  test::RestlessCell plain(5);
  const std::string heard = test::Exercise(plain.cell(), 6);
  std::string files[2];
  for (std::string& file : files) {
    test::RestlessCell cell(5);
    CellRecorder recorder(cell.cell(), Header(), folder / "r.zst");
    CHECK(test::Exercise(recorder.cell(), 6) == heard);
    recorder.Finish("");
    file = ReadFile(folder / "r.zst");
  }
  CHECK(files[0] == files[1]);
}

TEST_CASE("Blocks are small, of few seconds, and can be read from any one on", "[unit]") {
  const TemporaryFolder folder;
  const std::string path = Recorded(folder, 30);
  CellRecording recording(path);
  const std::vector<std::string> all = EventsOf(recording);
  REQUIRE(recording.blocks().size() > 10);
  const double end_s = Seconds(recording.end_time());
  CHECK(end_s > 30.0);
  for (const RecordingBlock& block : recording.blocks()) {
    CHECK(block.first <= block.last);
    // Five seconds, and what one wait adds.
    CHECK(Seconds(block.last - block.first) < 6.0);
  }
  for (double from_s = 0.0; from_s < end_s; from_s += 3.7) {
    recording.Seek(FromSeconds(from_s));
    const std::vector<std::string> tail = EventsOf(recording);
    CAPTURE(from_s, tail.size(), all.size());
    REQUIRE_FALSE(tail.empty());
    REQUIRE(tail.size() <= all.size());
    CHECK(std::equal(tail.rbegin(), tail.rend(), all.rbegin()));
  }
  recording.Seek(recording.end_time() + TimeNs(1));
  CHECK_FALSE(recording.Next().has_value());
}

TEST_CASE("Without its index a recording reads the same", "[unit]") {
  const TemporaryFolder folder;
  const std::string path = Recorded(folder, 5);
  const std::vector<std::string> all = EventsOf(path);
  CellRecording whole(path);
  const std::string bytes = ReadFile(path);
  const RecordingBlock& last = whole.blocks().back();
  const std::size_t index = last.byte + kBlockHeadBytes + last.packed;
  for (const std::size_t size : {index, index + 1, bytes.size() - 1, bytes.size() - 12}) {
    WriteBytes(folder / "cut", bytes.substr(0, size));
    CellRecording cut(folder / "cut");
    CHECK_FALSE(cut.indexed());
    CHECK(cut.complete());
    REQUIRE(cut.blocks().size() == whole.blocks().size());
    for (std::size_t i = 0; i < cut.blocks().size(); ++i) {
      CHECK(cut.blocks()[i].byte == whole.blocks()[i].byte);
      CHECK(cut.blocks()[i].last == whole.blocks()[i].last);
    }
    CHECK(EventsOf(cut) == all);
  }
}

TEST_CASE("However much of the file is there, what is whole reads and nothing else", "[unit]") {
  const TemporaryFolder folder;
  const std::string path = Recorded(folder, 6);
  const std::string bytes = ReadFile(path);
  const std::vector<std::string> all = EventsOf(path);
  CellRecording whole(path);
  const std::uint64_t header_end = kBlockHeadBytes + whole.blocks().front().packed;
  std::size_t longest = 0;
  RandomStream stream(2, 0, "cuts");
  std::vector<std::size_t> sizes;
  for (const RecordingBlock& block : whole.blocks()) {
    // Around every border, and in the middle of each block.
    for (const std::uint64_t size : {block.byte, block.byte + 1, block.byte + kBlockHeadBytes,
                                     block.byte + kBlockHeadBytes + block.packed / 2,
                                     block.byte + kBlockHeadBytes + block.packed - 1}) {
      sizes.push_back(static_cast<std::size_t>(size));
    }
  }
  for (int i = 0; i < 200; ++i) {
    sizes.push_back(stream.Index(static_cast<std::uint32_t>(bytes.size())));
  }
  std::sort(sizes.begin(), sizes.end());
  for (const std::size_t size : sizes) {
    CAPTURE(size);
    WriteBytes(folder / "cut", bytes.substr(0, size));
    if (size < header_end) {
      CHECK_THROWS_AS(CellRecording(folder / "cut"), Error);
      continue;
    }
    CellRecording cut(folder / "cut");
    const std::vector<std::string> some = EventsOf(cut);
    REQUIRE(some.size() <= all.size());
    REQUIRE(std::equal(some.begin(), some.end(), all.begin()));
    REQUIRE(some.size() >= longest);
    longest = some.size();
    // Every block that is there is read.
    std::uint64_t lost = 0;
    for (const RecordingBlock& block : whole.blocks()) {
      if (block.byte + kBlockHeadBytes + block.packed > size) break;
      lost = size - (block.byte + kBlockHeadBytes + block.packed);
    }
    if (!cut.complete()) CHECK(cut.dropped_bytes() == lost);
  }
  CHECK(longest == all.size());
}

TEST_CASE("A program that is killed leaves a recording of all but the last seconds", "[unit]") {
  const TemporaryFolder folder;
  const std::string path = folder / "cell.rec.zst";
  test::RestlessCell cell(5);
  CellRecorder recorder(cell.cell(), Header(), path);
  test::Exercise(recorder.cell(), 20);
  // The recorder still lives: what a kill would leave is what the file holds now.
  CellRecording left(path);
  CHECK_FALSE(left.complete());
  CHECK(left.dropped_bytes() == 0);
  const std::vector<std::string> some = EventsOf(left);
  CHECK(Seconds(cell.cell().clock.Now() - left.end_time()) < 6.0);
  recorder.Finish("");
  const std::vector<std::string> all = EventsOf(path);
  CHECK(some.size() > all.size() / 2);
  CHECK(std::equal(some.begin(), some.end(), all.begin()));
}

TEST_CASE("A damaged block is named by its byte, and nothing wrong is read", "[unit]") {
  const TemporaryFolder folder;
  const std::string path = Recorded(folder, 4);
  const std::string bytes = ReadFile(path);
  const std::vector<std::string> all = EventsOf(path);
  CellRecording whole(path);
  RandomStream stream(4, 0, "damage");
  for (const RecordingBlock& block : whole.blocks()) {
    for (int i = 0; i < 6; ++i) {
      const auto at = static_cast<std::size_t>(
          block.byte + stream.Index(static_cast<std::uint32_t>(kBlockHeadBytes + block.packed)));
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << stream.Index(8)));
      WriteBytes(folder / "damaged", damaged);
      CAPTURE(at, block.byte, ToString(block.kind));
      std::vector<std::string> some;
      try {
        CellRecording recording(folder / "damaged");
        while (const auto event = recording.Next()) some.push_back(Bits(*event));
        FAIL("the damage was not seen");
      } catch (const Error& e) {
        REQUIRE(e.kind() == ErrorKind::kBadData);
        REQUIRE_THAT(e.what(), Catch::StartsWith(folder / "damaged"));
        REQUIRE_THAT(e.what(), Catch::Contains("byte " + std::to_string(block.byte) + ":"));
      }
      REQUIRE(std::equal(some.begin(), some.end(), all.begin()));
    }
  }
}

TEST_CASE("Files that are no cell recordings are refused by name", "[unit]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& bytes) {
    WriteBytes(folder / "f", bytes);
    CHECK_THROWS_WITH(CellRecording(folder / "f"),
                      Catch::StartsWith(folder / "f: byte 0: no cell recording"));
  };
  refused("");
  refused("seed = 1\n");
  refused(std::string(1000, '\0'));
  try {
    CellRecording(folder / "none");
    FAIL("nothing was thrown");
  } catch (const Error& e) {
    CHECK(e.kind() == ErrorKind::kMissing);
    CHECK(e.what() == (folder / "none: no such file"));
  }
  CHECK_THROWS_WITH(CellRecording(folder.path()), Catch::Contains("no regular file"));
}

TEST_CASE("A disk that fills leaves what was recorded before, and the cell goes on", "[unit]") {
  const TemporaryFolder folder;
  const auto record = [&](const std::string& path, rlim_t bytes) {
    const FullDisk full(bytes);
    test::RestlessCell cell(5);
    CellRecorder recorder(cell.cell(), Header(), path);
    test::Exercise(recorder.cell(), 100);
    const std::optional<Error> failure = recorder.failure();
    if (failure) {
      CHECK_THROWS_WITH(recorder.Finish("over"), failure->what());
    } else {
      recorder.Finish("over");
    }
    return failure;
  };
  REQUIRE_FALSE(record(folder / "whole.rec.zst", RLIM_INFINITY).has_value());
  const std::vector<std::string> all = EventsOf(folder / "whole.rec.zst");
  const std::uintmax_t size = fs::file_size(folder / "whole.rec.zst");
  std::size_t longest = 0;
  for (int part = 2; part < 10; ++part) {
    const std::string path = folder / ("cut" + std::to_string(part) + ".rec.zst");
    const std::optional<Error> failure = record(path, size * part / 10);
    REQUIRE(failure.has_value());
    CHECK(failure->kind() == ErrorKind::kIo);
    CHECK_THAT(failure->what(), Catch::StartsWith(path + ": cannot be written at byte ") &&
                                    Catch::Contains("File too large"));
    CellRecording recording(path);
    CHECK_FALSE(recording.complete());
    CHECK(recording.dropped_bytes() == 0);
    const std::vector<std::string> some = EventsOf(recording);
    CHECK(some.size() >= longest);
    longest = some.size();
    CHECK(std::equal(some.begin(), some.end(), all.begin()));
  }
  CHECK(longest > all.size() / 2);
}

TEST_CASE("A folder that cannot be made is told by name", "[unit]") {
  for (const char* path : {"/dev/full", "/dev/null/cell.rec.zst"}) {
    try {
      CellRecordingWriter(path, Header());
      FAIL_CHECK(path);
    } catch (const Error& e) {
      CHECK(e.kind() == ErrorKind::kCannotCreate);
      CHECK_THAT(e.what(), Catch::Contains("/dev/full") || Catch::Contains("/dev/null"));
    }
  }
}

TEST_CASE("A recording holds one block in memory, not the round", "[unit]") {
  const TemporaryFolder folder;
  CellRecordingWriter writer(folder / "long", Header());
  TimeNs now{0};
  ArmState state;
  std::uint64_t largest = 0;
  for (int i = 0; i < 300000; ++i) {
    now += kControlPeriod;
    state.time = now;
    state.q[i % 6] += 1e-5 * (i % 7);
    writer.Add(TimeAdvanced{now, now});
    writer.Add(ArmRead{state});
  }
  writer.Finish("");
  CellRecording recording(folder / "long");
  for (const RecordingBlock& block : recording.blocks()) largest = std::max(largest, block.size);
  CHECK(largest < (300u << 10));
  CHECK(Seconds(recording.end_time()) == 300.0);
}

}  // namespace
}  // namespace tubetwin
