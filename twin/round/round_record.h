#pragma once

#include <string>
#include <vector>

#include "models/base/json.h"

namespace tubetwin {

/// What one round of a campaign left: the unit that is run, saved, merged and resampled.
struct RoundRecord {
  int arm = 0;
  int round = 0;
  std::int64_t seed = 0;
  Json summary;               ///< As summary.json of one round; crash rounds: FaultSummary().
  std::vector<Json> picks;    ///< Rows of picks.jsonl, with `arm` and `round`.
  std::vector<Json> timings;  ///< Rows of timings.jsonl, likewise.
};

/// Row of picks.jsonl for a round whose process left none: outcome "fault", no success, every other
/// field null. It stands for the round's first attempt.
Json FaultRow(const std::string& reason);
/// Its row of timings.jsonl.
Json FaultTimingRow(double wall_s);
/// Its summary: nothing placed, end_reason "crashed".
Json FaultSummary(int tubes_start, const std::string& reason);
bool IsFaultSummary(const Json& summary);

}  // namespace tubetwin
