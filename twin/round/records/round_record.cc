#include "twin/round/records/round_record.h"

namespace tubetwin {

std::string NameOf(const RoundRecord& record) {
  return "variant " + std::to_string(record.variant) + " round " + std::to_string(record.round);
}

void SetCrashed(int tubes_start, const std::string& reason, double wall_s, RoundRecord& record) {
  AttemptRecord attempt;
  attempt.outcome = AttemptOutcome::kFault;
  attempt.reason = reason;
  attempt.success = false;
  record.attempts = {attempt};
  record.timings = {{1, std::nullopt, wall_s}};
  record.summary = RoundSummary();
  record.summary.tubes_start = tubes_start;
  record.summary.attempts = 1;
  record.summary.success = Counts{0, 1};
  record.summary.end_detail = reason;
}

}  // namespace tubetwin
