#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "twin/round/records/attempt_record.h"
#include "twin/round/records/round_summary.h"

namespace tubetwin {

/// What one round left: the unit that is run, saved, merged, resampled and reported. A round on its
/// own is round 0 of variant 0.
struct RoundRecord {
  int variant = 0;
  int round = 0;
  std::int64_t seed = 0;
  RoundSummary summary;
  std::vector<AttemptRecord> attempts;
  /// One for each attempt, then one of what came after the last; or none where nobody kept them.
  /// Earlier versions kept none of what came after.
  std::vector<AttemptTiming> timings;
};

/// "variant 0 round 5", as messages name it.
std::string NameOf(const RoundRecord& record);

/// What a summary tells of its attempts, counted from their rows.
struct AttemptCounts {
  int attempts = 0;
  int dropped = 0;
  Counts success;        ///< As RoundSummary's, where truth is known.
  Counts first_attempt;  ///< As RoundSummary's.
};
AttemptCounts CountAttempts(const std::vector<AttemptRecord>& attempts);

/// Throws Error(kBadData) naming `source` and the round when its summary does not tell what its
/// attempts tell: a row was lost or changed.
void RequireConsistent(const RoundRecord& record, const std::string& source);

/// What stands for a round whose process left nothing: one attempt with outcome "fault" and no
/// success, nothing placed, no end. Overwrites all but variant, round and seed.
void SetCrashed(int tubes_start, const std::string& reason, double wall_s, RoundRecord& record);

}  // namespace tubetwin
