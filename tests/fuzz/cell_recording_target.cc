// cell.rec.zst: the file, and the contents of its blocks, which its check sums keep damage from.

#include "hw_bridge/recording/cell_recording.h"
#include "hw_bridge/recording/cloud_packing.h"
#include "hw_bridge/recording/event_codec.h"
#include "hw_bridge/recording/recording_header.h"
#include "models/base/files.h"
#include "tests/fuzz/byte_target.h"
#include "tests/fuzz/memory_file.h"
#include "tests/recording/random_events.h"
#include "tests/support/paper_cell.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

CellRecordingHeader SomeHeader() {
  CellRecordingHeader header;
  header.versions = {{"program", "1.2.3"}};
  header.seed = 17;
  header.model = PaperCell();
  header.config_toml = "seed = 17\n";
  header.fingerprint = "0";
  header.part = LoadPart("hose_b");
  return header;
}

}  // namespace

void TryBytes(std::string_view bytes) {
  static MemoryFile file("cell_recording");
  file.Fill(bytes);
  TryReader("cell recording", file.path(), [] {
    CellRecording recording(file.path());
    while (recording.Next()) {
    }
  });
  const std::string text(bytes);
  TryReader("decoder of events", "events", [&] {
    EventDecoder decoder(text, TimeNs(0), "events");
    while (decoder.Next()) {
    }
  });
  TryReader("decoder of clouds", "cloud", [&] { UnpackCloud(text, "cloud"); });
  // Of the model files that it holds a bad one is bad configuration.
  TryReader("head of a recording", "", [&] { HeaderFromText(text, "header"); },
            {ErrorKind::kBadData, ErrorKind::kConfig, ErrorKind::kMissing});
}

std::vector<std::string> ByteCorpus() {
  const TemporaryFolder folder;
  std::vector<std::string> out = {HeaderToText(SomeHeader())};
  RandomStream stream(3, 0, "cell recording corpus");
  EventEncoder encoder;
  std::string events;
  encoder.Reset();
  {
    CellRecordingWriter writer(folder / "whole", SomeHeader());
    for (int i = 0; i < 40; ++i) {
      const CellEvent event = test::RandomEvent(stream);
      writer.Add(event);
      encoder.Encode(event, events);
    }
    writer.Finish("over");
  }
  out.push_back(ReadFile(folder / "whole"));
  out.push_back(events);
  out.push_back(PackCloud(test::RandomCloud(stream, 6, 4, true)));
  out.push_back(PackCloud(test::RandomCloud(stream, 6, 4, false)));
  return out;
}

}  // namespace tubetwin
