#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "models/base/disk/output_file.h"
#include "models/base/time.h"

namespace tubetwin {

/// Writes an MCAP file (https://mcap.dev/spec): JSON messages on channels with JSON schemas, in
/// chunks compressed by zstd, with indices, statistics and check sums, so that public readers and
/// viewers find everything without reading the whole. Holds one chunk. One thread.
class McapWriter {
 public:
  /// Into `out`, an empty file that must outlive it. Throws Error(kIo).
  McapWriter(OutputFile& out, const std::string& library);
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Channels come before messages. Returns the channel's number.
  std::uint16_t AddChannel(const std::string& topic, const std::string& schema_name,
                           const std::string& json_schema);
  /// A message; times need not increase. Throws Error(kIo).
  void AddMessage(std::uint16_t channel, TimeNs time, std::string_view json);
  /// Names and values about the whole file.
  void AddMetadata(const std::string& name, const std::map<std::string, std::string>& values);
  void AddAttachment(const std::string& name, const std::string& media_type,
                     std::string_view content);
  /// The rest: indices, statistics, footer. Without it the file is no whole MCAP file.
  void Finish();

  std::uint64_t messages(std::uint16_t channel) const;

 private:
  struct Chunk {
    std::uint64_t first = 0, last = 0;  ///< Log times.
    std::uint64_t byte = 0, length = 0;
    std::map<std::uint16_t, std::uint64_t> index_bytes;  ///< Of each channel's message index.
    std::uint64_t index_length = 0;
    std::uint64_t packed = 0, size = 0;
  };
  struct Placed {  ///< A record that the summary points to.
    std::uint64_t byte, length;
    std::string index;  ///< What follows in its index record.
  };

  void Record(std::uint8_t opcode, std::string_view content);
  void WriteChunk();
  std::string Statistics() const;
  std::string ChunkIndex(const Chunk& chunk) const;
  void Write(std::string_view bytes);

  OutputFile& out_;
  std::uint64_t at_ = 0;
  std::uint32_t crc_ = 0;  ///< Of the section being written.

  std::vector<std::string> schemas_, channels_;  ///< Contents of their records.
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::string records_;  ///< Of the chunk being filled.
  /// For each channel: log time and place in records_ of its messages.
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> places_;
  std::vector<Chunk> chunks_;
  std::vector<Placed> attachments_, metadata_;
};

}  // namespace tubetwin
