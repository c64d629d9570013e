// A stored moment in which several tubes hang in the fingers, as the pick cycle goes on from it.

#include "models/base/json.h"
#include "planner/cycle/attempt_checkpoint.h"
#include "tests/fuzz/byte_target.h"
#include "tests/fuzz/corpus_files.h"
#include "tests/fuzz/memory_file.h"

namespace tubetwin {

void TryBytes(std::string_view bytes) {
  static MemoryFile file("held");
  file.Fill(bytes);
  TryReader("reader of held tubes", file.path(), [] {
    const Json json = ReadJsonFile(file.path());
    const AttemptCheckpoint state = AttemptCheckpointFromJson(JsonView(json, file.path()));
    if (!state.q.allFinite() || Length(state.line_E) > 1e6) DieOf("held tubes", "no cell's moment");
    ToJson(state);
  });
}

std::vector<std::string> ByteCorpus() { return CorpusFiles("held"); }

}  // namespace tubetwin
