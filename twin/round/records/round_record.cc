#include "twin/round/records/round_record.h"

#include "models/base/error.h"

namespace tubetwin {

std::string NameOf(const RoundRecord& record) {
  return "variant " + std::to_string(record.variant) + " round " + std::to_string(record.round);
}

AttemptCounts CountAttempts(const std::vector<AttemptRecord>& attempts) {
  AttemptCounts out;
  out.attempts = out.success.n = static_cast<int>(attempts.size());
  for (const AttemptRecord& attempt : attempts) {
    if (attempt.success.value_or(attempt.outcome == AttemptOutcome::kPlaced)) {
      ++out.first_attempt.n;
      if (attempt.attempt == 1) ++out.first_attempt.k;
      ++out.success.k;
    }
    if (attempt.outcome == AttemptOutcome::kDropped) ++out.dropped;
  }
  return out;
}

void RequireConsistent(const RoundRecord& record, const std::string& source) {
  const AttemptCounts rows = CountAttempts(record.attempts);
  const RoundSummary& summary = record.summary;
  const auto require = [&](const char* what, int found, int told) {
    if (found == told) return;
    throw Error(ErrorKind::kBadData, source + ": " + NameOf(record) + ": its rows tell of " +
                                         std::to_string(found) + " " + what + ", its summary of " +
                                         std::to_string(told) +
                                         ": rows were lost or changed; merge or run it again");
  };
  require("attempts", rows.attempts, summary.attempts);
  if (summary.success) require("successes", rows.success.k, summary.success->k);
  require("first attempts that placed", rows.first_attempt.k, summary.first_attempt.k);
  require("placed tubes", rows.first_attempt.n, summary.first_attempt.n);
  require("dropped tubes", rows.dropped, summary.dropped);
}

void SetCrashed(int tubes_start, const std::string& reason, double wall_s, RoundRecord& record) {
  AttemptRecord attempt;
  attempt.outcome = AttemptOutcome::kFault;
  attempt.reason = reason;
  attempt.success = attempt.in_tolerance = false;
  record.attempts = {attempt};
  record.timings = {{1, std::nullopt, wall_s}};
  record.summary = RoundSummary();
  record.summary.tubes_start = tubes_start;
  record.summary.attempts = 1;
  record.summary.success = Counts{0, 1};
  record.summary.end_detail = reason;
}

}  // namespace tubetwin
