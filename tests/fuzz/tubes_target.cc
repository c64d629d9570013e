// tubes.json, and what every verb that reads one does with it first.

#include "models/base/json.h"
#include "perception/scene/tube_scene.h"
#include "tests/fuzz/byte_target.h"
#include "tests/fuzz/corpus_files.h"
#include "tests/fuzz/memory_file.h"

namespace tubetwin {

void TryBytes(std::string_view bytes) {
  constexpr const char* kReader = "reader of tubes.json";
  constexpr double kStep_m = 0.002;
  static MemoryFile file("tubes");
  file.Fill(bytes);
  TryReader(kReader, file.path(), [&] {
    const Json json = ReadJsonFile(file.path());
    TubeScene scene = TubeSceneFromJson(JsonView(json, file.path()));
    for (const PerceivedTube& tube : scene.tubes) {
      if (Resample(tube.centerline_N, kStep_m).size() > 6000) DieOf(kReader, "a line without end");
    }
    const Json again = ToJson(scene);
    if (TubeSceneFromJson(JsonView(again, "again")).tubes.size() != scene.tubes.size()) {
      DieOf(kReader, "a scene that comes back as another");
    }
  });
}

std::vector<std::string> ByteCorpus() { return CorpusFiles("tubes"); }

}  // namespace tubetwin
