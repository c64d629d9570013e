#include "twin/round/round_checkpoint.h"

#include <algorithm>
#include <filesystem>

#include "models/base/error.h"
#include "models/base/files.h"

namespace tubetwin {
namespace fs = std::filesystem;

void SaveRoundCheckpoint(const Pile& start, std::int64_t seed, const Json& cell,
                         const AttemptCheckpoint& cycle, const ScorerState& scorer,
                         const std::string& path) {
  Json document = ToJson(start);
  document["held"] =
      Json{{"seed", seed}, {"cell", cell}, {"cycle", ToJson(cycle)}, {"scorer", ToJson(scorer)}};
  WriteJsonFile(document, path);
}

std::optional<RoundCheckpoint> ReadRoundCheckpoint(const Scenario& scenario) {
  const fs::path file(scenario.pile.file);
  if (file.extension() != ".json") return std::nullopt;
  RoundCheckpoint held;
  held.file = file.string();
  held.document = ReadJsonFile(held.file);
  if (!held.document.is_object() || !held.document.contains("held")) return std::nullopt;
  const JsonView stored = JsonView(held.document, held.file).Field("held");
  held.seed = stored.Field("seed").AsInteger();
  held.cycle = AttemptCheckpointFromJson(stored.Field("cycle"));
  held.scorer = ScorerStateFromJson(stored.Field("scorer"));
  return held;
}

std::vector<std::string> PileFilesOf(const Scenario& scenario) {
  std::vector<std::string> files;
  const fs::path given(scenario.pile.file);
  std::error_code unknown;  // Then it is read as a file, which says why.
  if (given.empty() || !fs::is_directory(given, unknown)) return files;
  for (const auto& entry : fs::directory_iterator(given)) {
    if (entry.path().extension() == ".json") {
      files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace tubetwin
