// The structure of MCAP files by their specification; tests/app/mcap_reader_test.sh has a public
// reader read one.

#include "hw_bridge/mcap/mcap_file.h"

#include <map>
#include <vector>

#include "hw_bridge/mcap/mcap_export.h"
#include "hw_bridge/recording/byte_stream.h"
#include "hw_bridge/recording/crc32.h"
#include "models/base/cloud/zstd_frame.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

const std::string kMagic = "\x89MCAP0\r\n";

struct Record {
  int opcode;
  std::size_t byte, length;
  std::string content;
};

/// Records between two places of a file.
std::vector<Record> RecordsOf(std::string_view bytes, std::size_t from, std::size_t to) {
  std::vector<Record> records;
  ByteReader in(bytes.substr(0, to), "file");
  in.Take(from);
  while (!in.AtEnd()) {
    Record record;
    record.byte = in.position();
    record.opcode = in.U8();
    const std::size_t size = in.U64();
    record.content = std::string(in.Take(size), size);
    record.length = size + 9;
    records.push_back(record);
  }
  return records;
}

std::string TextOf(ByteReader& in) {
  const std::uint32_t size = in.U32();
  return std::string(in.Take(size), size);
}

struct ParsedChunk {
  std::uint64_t first, last;
  std::string records;
};

ParsedChunk ParseChunk(const std::string& content) {
  ByteReader in(content, "chunk");
  ParsedChunk chunk;
  chunk.first = in.U64();
  chunk.last = in.U64();
  const std::uint64_t size = in.U64();
  const std::uint32_t crc = in.U32();
  CHECK(TextOf(in) == "zstd");
  const std::uint64_t packed = in.U64();
  chunk.records = Decompressed(std::string_view(in.Take(packed), packed), size, "chunk");
  CHECK(Crc32(chunk.records) == crc);
  CHECK(in.AtEnd());
  return chunk;
}

TEST_CASE("The check sum is the one of IEEE 802.3, whole or in pieces", "[unit]") {
  CHECK(Crc32("123456789") == 0xcbf43926u);
  CHECK(Crc32("456789", Crc32("123")) == 0xcbf43926u);
  CHECK(Crc32("") == 0u);
}

// Long function: one file's bytes are read from the first to the last, and each record says where
// the next lies.
TEST_CASE("An MCAP file has the specified records, places and check sums", "[unit]") {
  const TemporaryFolder folder;
  const std::string path = folder / "f.mcap";
  constexpr int kMessages = 40000;
  {
    OutputFile file = OutputFile::Create(path);
    McapWriter out(file, "test");
    const auto a = out.AddChannel("/a", "test.A", "{\"type\":\"object\"}");
    const auto b = out.AddChannel("/b", "test.B", "{\"type\":\"object\"}");
    out.AddMetadata("about", {{"key", "value"}});
    out.AddAttachment("note.txt", "text/plain", "a note");
    for (int i = 0; i < kMessages; ++i) {
      out.AddMessage(i % 3 == 0 ? a : b, TimeNs(1000 + i),
                     "{\"number\":" + std::to_string(i) + ",\"text\":\"some words to fill\"}");
    }
    out.Finish();
    CHECK(out.messages(a) == (kMessages + 2) / 3);
  }
  const std::string bytes = ReadFile(path);
  REQUIRE(bytes.size() > 100);
  CHECK(bytes.substr(0, 8) == kMagic);
  CHECK(bytes.substr(bytes.size() - 8) == kMagic);
  const std::vector<Record> all = RecordsOf(bytes, 8, bytes.size() - 8);
  CHECK(all.front().opcode == 0x01);
  CHECK(all.back().opcode == 0x02);

  std::map<std::size_t, Record> at;
  std::size_t data_end = 0;
  for (const Record& record : all) {
    at[record.byte] = record;
    if (record.opcode == 0x0F) data_end = record.byte;
  }
  REQUIRE(data_end > 0);
  CHECK(ByteReader(at[data_end].content, "end").U32() == Crc32(bytes.substr(0, data_end)));

  ByteReader footer(all.back().content, "footer");
  const std::uint64_t summary = footer.U64(), offsets = footer.U64();
  CHECK(summary == data_end + at[data_end].length);
  CHECK(footer.U32() == Crc32(bytes.substr(summary, all.back().byte + 9 + 16 - summary)));

  // Every summary offset names a run of records of one kind; together they are the summary.
  std::size_t expected = summary;
  for (const Record& record : RecordsOf(bytes, offsets, all.back().byte)) {
    REQUIRE(record.opcode == 0x0E);
    ByteReader in(record.content, "offset");
    const int opcode = in.U8();
    const std::uint64_t start = in.U64(), length = in.U64();
    CHECK(start == expected);
    for (const Record& one : RecordsOf(bytes, start, start + length)) CHECK(one.opcode == opcode);
    expected = start + length;
  }
  CHECK(expected == offsets);

  // Each chunk index leads to its chunk, and each message index to the messages in it.
  int chunks = 0, messages = 0;
  for (const Record& record : all) {
    if (record.opcode != 0x08) continue;
    ++chunks;
    ByteReader in(record.content, "chunk index");
    const std::uint64_t first = in.U64(), last = in.U64(), start = in.U64(), length = in.U64();
    REQUIRE(at.count(start) == 1);
    CHECK(at[start].opcode == 0x06);
    CHECK(at[start].length == length);
    const ParsedChunk chunk = ParseChunk(at[start].content);
    CHECK(chunk.first == first);
    CHECK(chunk.last == last);
    for (std::uint32_t left = in.U32(); left > 0; left -= 10) {
      const int channel = in.U16();
      const std::uint64_t index_at = in.U64();
      REQUIRE(at.count(index_at) == 1);
      REQUIRE(at[index_at].opcode == 0x07);
      ByteReader index(at[index_at].content, "index");
      CHECK(index.U16() == channel);
      for (std::uint32_t rest = index.U32(); rest > 0; rest -= 16) {
        const std::uint64_t time = index.U64(), place = index.U64();
        ByteReader message(std::string_view(chunk.records).substr(place), "message");
        REQUIRE(message.U8() == 0x05);
        const std::uint64_t size = message.U64();
        REQUIRE(message.U16() == channel);
        message.U32();
        REQUIRE(message.U64() == time);
        REQUIRE(message.U64() == time);
        const std::string json(message.Take(size - 22), size - 22);
        REQUIRE(Json::parse(json)["number"] == time - 1000);
        ++messages;
      }
    }
  }
  CHECK(chunks > 2);
  CHECK(messages == kMessages);
}

TEST_CASE("An export of damage or to nowhere leaves no file", "[unit]") {
  const TemporaryFolder folder;
  {
    CellRecordingHeader header;
    header.model = PaperCell();
    CellRecordingWriter writer(folder / "r", header);
    writer.Add(TimeAdvanced{kControlPeriod, kControlPeriod});
    writer.Finish("");
  }
  std::string bytes = ReadFile(folder / "r");
  CellRecording whole(folder / "r");
  bytes[whole.blocks()[1].byte + 70] ^= 4;
  WriteFileAtomically(folder / "damaged", bytes);
  CellRecording damaged(folder / "damaged");
  CHECK_THROWS_WITH(ExportMcap(damaged, folder / "f.mcap", {}), Catch::Contains("damaged"));
  CHECK_FALSE(std::filesystem::exists(folder / "f.mcap"));
  CHECK_THROWS_AS(ExportMcap(whole, "/dev/null/f.mcap", {}), Error);
  CHECK(ExportMcap(whole, folder / "f.mcap", {}).at("/log") == 0);
  CHECK(std::filesystem::exists(folder / "f.mcap"));
}

}  // namespace
}  // namespace tubetwin
