// recording.bin: its content, packed again so that damage gets behind the check sum, and the cell
// that it holds.

#include <algorithm>

#include "models/base/cloud/zstd_frame.h"
#include "tests/fuzz/byte_target.h"
#include "tests/fuzz/corpus_files.h"
#include "tests/fuzz/memory_file.h"
#include "twin/render/cell_track.h"
#include "twin/render/recording.h"

namespace tubetwin {
namespace {

void TryRecordingFile(const std::string& bytes) {
  static MemoryFile file("recording");
  file.Fill(bytes);
  TryReader("reader of recordings", file.path(), [] {
    const Recording recording = ReadRecording(file.path());
    const int frames = std::min(3, static_cast<int>(recording.frames.size()));
    TrackOf(recording, 0, frames, 1);
  });
}

}  // namespace

void TryBytes(std::string_view bytes) {
  TryRecordingFile(std::string(bytes));
  // A file of the corpus says where its head ends by a line break: frames stay bytes.
  std::string content(bytes);
  const std::size_t end = content.find('\n');
  if (end != std::string::npos) content[end] = '\0';
  TryRecordingFile(Compressed(content));
}

std::vector<std::string> ByteCorpus() {
  std::vector<std::string> out = CorpusFiles("recording");
  for (std::string& content : out) {
    content.resize(content.find_last_not_of('\n') + 1);
    content += '\n';
    content += std::string(2 * (12 + 4), '\0');  // Two frames of one coordinate.
  }
  return out;
}

}  // namespace tubetwin
