#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "models/base/json.h"
#include "planner/cycle/attempt_checkpoint.h"
#include "scenes/pile.h"
#include "twin/round/scenario.h"
#include "twin/round/scoring.h"

namespace tubetwin {

/// A round stored where several tubes hang in the fingers: a pile.json (the pile at the round's
/// start, which the cell is built from) with one more key, `held`: {seed, cell, cycle, scorer}.
struct RoundCheckpoint {
  std::int64_t seed = 0;  ///< Of the stored round; physics and noise are drawn from it.
  AttemptCheckpoint cycle;
  ScorerState scorer;
  std::string file;  ///< For messages.
  Json document;     ///< The whole file; the cell reads its own state from it.

  JsonView cell() const { return JsonView(document, file).Field("held").Field("cell"); }
};

/// Writes such a file.
void SaveRoundCheckpoint(const Pile& start, std::int64_t seed, const Json& cell,
                         const AttemptCheckpoint& cycle, const ScorerState& scorer,
                         const std::string& path);

/// The stored round that the scenario's pile file is, or nothing for any other pile or none.
/// Throws Error(kBadData).
std::optional<RoundCheckpoint> ReadRoundCheckpoint(const Scenario& scenario);

/// The files that rounds start from when the scenario's `pile.file` is a folder: its *.json by
/// name, round r of a campaign takes the r-th. Empty when it is no folder.
std::vector<std::string> PileFilesOf(const Scenario& scenario);

}  // namespace tubetwin
