#include "hw_bridge/mcap/mcap_file.h"

#include <algorithm>
#include <limits>

#include "hw_bridge/recording/byte_stream.h"
#include "hw_bridge/recording/crc32.h"
#include "models/base/cloud/zstd_frame.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

// Opcodes of records.
constexpr std::uint8_t kHeader = 0x01, kFooter = 0x02, kSchema = 0x03, kChannel = 0x04,
                       kMessage = 0x05, kChunk = 0x06, kMessageIndex = 0x07, kChunkIndex = 0x08,
                       kAttachment = 0x09, kAttachmentIndex = 0x0A, kStatistics = 0x0B,
                       kMetadata = 0x0C, kMetadataIndex = 0x0D, kSummaryOffset = 0x0E,
                       kDataEnd = 0x0F;
constexpr std::uint64_t kRecordHead = 9;  ///< Opcode and length.

/// Content of a record; strings and maps as MCAP has them.
class Content {
 public:
  Content& U8(std::uint8_t v) { return out_.U8(v), *this; }
  Content& U16(std::uint16_t v) { return out_.U16(v), *this; }
  Content& U32(std::uint32_t v) { return out_.U32(v), *this; }
  Content& U64(std::uint64_t v) { return out_.U64(v), *this; }
  Content& Raw(std::string_view bytes) { return out_.Raw(bytes.data(), bytes.size()), *this; }
  Content& Text(std::string_view text) {
    return U32(static_cast<std::uint32_t>(text.size())).Raw(text);
  }
  Content& Texts(const std::map<std::string, std::string>& values) {
    Content inner;
    for (const auto& [key, value] : values) inner.Text(key).Text(value);
    return Text(inner.bytes());
  }
  Content& Numbers(const std::map<std::uint16_t, std::uint64_t>& values) {
    U32(static_cast<std::uint32_t>(10 * values.size()));
    for (const auto& [key, value] : values) U16(key).U64(value);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  ByteWriter out_{bytes_};
};

std::string RecordBytes(std::uint8_t opcode, std::string_view content) {
  Content out;
  out.U8(opcode).U64(content.size()).Raw(content);
  return out.bytes();
}

}  // namespace

McapWriter::McapWriter(OutputFile& out, const std::string& library) : out_(out) {
  Write(kMagic);
  Record(kHeader, Content().Text("").Text(library).bytes());
}

std::uint16_t McapWriter::AddChannel(const std::string& topic, const std::string& schema_name,
                                     const std::string& json_schema) {
  TT_CHECK(chunks_.empty() && records_.empty());
  const auto number = static_cast<std::uint16_t>(channels_.size() + 1);
  schemas_.push_back(
      Content().U16(number).Text(schema_name).Text("jsonschema").Text(json_schema).bytes());
  channels_.push_back(Content().U16(number).U16(number).Text(topic).Text("json").Texts({}).bytes());
  Record(kSchema, schemas_.back());
  Record(kChannel, channels_.back());
  counts_[number] = 0;
  return number;
}

void McapWriter::AddMessage(std::uint16_t channel, TimeNs time, std::string_view json) {
  TT_CHECK(counts_.count(channel) == 1);
  const auto log_time = static_cast<std::uint64_t>(std::max<std::int64_t>(0, time.count()));
  Content head;
  head.U16(channel).U32(static_cast<std::uint32_t>(counts_[channel]++)).U64(log_time).U64(log_time);
  places_[channel].emplace_back(log_time, records_.size());
  ByteWriter out(records_);
  out.U8(kMessage);
  out.U64(head.bytes().size() + json.size());
  out.Raw(head.bytes().data(), head.bytes().size());
  out.Raw(json.data(), json.size());
  if (records_.size() >= kChunkBytes) WriteChunk();
}

void McapWriter::AddMetadata(const std::string& name,
                             const std::map<std::string, std::string>& values) {
  const std::string content = Content().Text(name).Texts(values).bytes();
  metadata_.push_back({at_, kRecordHead + content.size(), Content().Text(name).bytes()});
  Record(kMetadata, content);
}

void McapWriter::AddAttachment(const std::string& name, const std::string& media_type,
                               std::string_view data) {
  Content content;
  content.U64(0).U64(0).Text(name).Text(media_type).U64(data.size()).Raw(data);
  content.U32(Crc32(content.bytes()));
  attachments_.push_back(
      {at_, kRecordHead + content.bytes().size(),
       Content().U64(0).U64(0).U64(data.size()).Text(name).Text(media_type).bytes()});
  Record(kAttachment, content.bytes());
}

void McapWriter::WriteChunk() {
  if (records_.empty()) return;
  Chunk chunk;
  chunk.first = std::numeric_limits<std::uint64_t>::max();
  for (const auto& [channel, places] : places_) {
    for (const auto& [log_time, byte] : places) {
      chunk.first = std::min(chunk.first, log_time);
      chunk.last = std::max(chunk.last, log_time);
    }
  }
  const std::string packed = Compressed(records_);
  chunk.byte = at_;
  chunk.packed = packed.size();
  chunk.size = records_.size();
  Content content;
  content.U64(chunk.first).U64(chunk.last).U64(chunk.size).U32(Crc32(records_)).Text("zstd");
  content.U64(packed.size()).Raw(packed);
  Record(kChunk, content.bytes());
  chunk.length = at_ - chunk.byte;
  for (const auto& [channel, places] : places_) {
    chunk.index_bytes[channel] = at_;
    Content index;
    index.U16(channel).U32(static_cast<std::uint32_t>(16 * places.size()));
    for (const auto& [log_time, byte] : places) index.U64(log_time).U64(byte);
    Record(kMessageIndex, index.bytes());
  }
  chunk.index_length = at_ - chunk.byte - chunk.length;
  chunks_.push_back(std::move(chunk));
  records_.clear();
  places_.clear();
}

std::string McapWriter::ChunkIndex(const Chunk& chunk) const {
  Content content;
  content.U64(chunk.first).U64(chunk.last).U64(chunk.byte).U64(chunk.length);
  content.Numbers(chunk.index_bytes).U64(chunk.index_length).Text("zstd");
  content.U64(chunk.packed).U64(chunk.size);
  return content.bytes();
}

std::string McapWriter::Statistics() const {
  std::uint64_t all = 0, first = 0, last = 0;
  for (const auto& [channel, count] : counts_) all += count;
  for (const Chunk& chunk : chunks_) {
    first = &chunk == &chunks_.front() ? chunk.first : std::min(first, chunk.first);
    last = std::max(last, chunk.last);
  }
  Content content;
  content.U64(all).U16(static_cast<std::uint16_t>(schemas_.size()));
  content.U32(static_cast<std::uint32_t>(channels_.size()));
  content.U32(static_cast<std::uint32_t>(attachments_.size()));
  content.U32(static_cast<std::uint32_t>(metadata_.size()));
  content.U32(static_cast<std::uint32_t>(chunks_.size())).U64(first).U64(last).Numbers(counts_);
  return content.bytes();
}

void McapWriter::Finish() {
  WriteChunk();
  Record(kDataEnd, Content().U32(crc_).bytes());
  crc_ = 0;  // The summary's begins here.
  const std::uint64_t summary = at_;
  Content offsets;
  const auto group = [&](std::uint8_t opcode, const std::vector<std::string>& contents) {
    const std::uint64_t start = at_;
    for (const std::string& content : contents) Record(opcode, content);
    if (contents.empty()) return;
    const std::string offset = Content().U8(opcode).U64(start).U64(at_ - start).bytes();
    offsets.Raw(RecordBytes(kSummaryOffset, offset));
  };
  const auto indices = [](const std::vector<Placed>& records) {
    std::vector<std::string> out;
    for (const Placed& record : records) {
      out.push_back(Content().U64(record.byte).U64(record.length).Raw(record.index).bytes());
    }
    return out;
  };
  group(kSchema, schemas_);
  group(kChannel, channels_);
  group(kStatistics, {Statistics()});
  std::vector<std::string> chunks;
  for (const Chunk& chunk : chunks_) chunks.push_back(ChunkIndex(chunk));
  group(kChunkIndex, chunks);
  group(kAttachmentIndex, indices(attachments_));
  group(kMetadataIndex, indices(metadata_));
  const std::uint64_t summary_offsets = at_;
  Write(offsets.bytes());
  // The check sum covers the footer up to itself.
  Content footer;
  footer.U8(kFooter).U64(20).U64(summary).U64(summary_offsets);
  Write(footer.bytes());
  Write(Content().U32(crc_).bytes());
  Write(kMagic);
}

std::uint64_t McapWriter::messages(std::uint16_t channel) const { return counts_.at(channel); }

void McapWriter::Record(std::uint8_t opcode, std::string_view content) {
  Write(RecordBytes(opcode, content));
}

void McapWriter::Write(std::string_view bytes) {
  out_.Write(bytes);
  crc_ = Crc32(bytes, crc_);
  at_ += bytes.size();
}

}  // namespace tubetwin
