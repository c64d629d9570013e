#include "twin/round/records/attempt_facts.h"

namespace tubetwin {
namespace {

std::string FailureOf(const AttemptFacts& facts, bool crashed) {
  if (facts.success) return "";
  if (crashed) return "crashed";
  if (facts.outside > 0) return "outside";
  if (facts.placed > 1) return "several_placed";
  if (facts.attempt->outcome == AttemptOutcome::kPlaced) {
    return facts.attempt->success ? "placed_none" : "";  // Without truth nobody doubts it.
  }
  return facts.placed == 1 ? "placed_unnoticed" : ToString(facts.attempt->outcome);
}

}  // namespace

bool AttemptFacts::Within(double error_mm) const {
  if (!success || !attempt->truth || !yaw_limit_deg) return false;
  const AttemptTruth& truth = *attempt->truth;
  if (!truth.placement_error_mm || !truth.placement_error_deg) return false;
  return PlacementTolerance{error_mm, *yaw_limit_deg}.Holds(*truth.placement_error_mm,
                                                            *truth.placement_error_deg);
}

RoundFacts FactsOf(const RoundRecord& record) {
  RoundFacts out{&record, {}};
  int placed_before = record.summary.placed_before;
  int outside_before = record.summary.outside_before;
  for (std::size_t i = 0; i < record.attempts.size(); ++i) {
    const AttemptRecord& attempt = record.attempts[i];
    AttemptFacts facts;
    facts.attempt = &attempt;
    if (i < record.timings.size()) facts.timing = &record.timings[i];
    facts.first = attempt.attempt == 1;
    facts.success = attempt.success == true;
    if (record.summary.tolerance) facts.yaw_limit_deg = record.summary.tolerance->yaw_deg;
    facts.tubes_left = record.summary.tubes_start - placed_before - outside_before;
    if (attempt.truth) {
      const auto placed = static_cast<int>(attempt.truth->placed_ids.size());
      const auto outside = static_cast<int>(attempt.truth->outside_ids.size());
      facts.placed = facts.success ? 1 : placed - placed_before;
      facts.outside = outside - outside_before;
      placed_before = placed;
      outside_before = outside;
    } else if (!attempt.success && attempt.tubes_in_bin) {
      facts.tubes_left = *attempt.tubes_in_bin;  // Without truth, what the pipeline saw.
    }
    facts.failure = FailureOf(facts, record.summary.crashed());
    out.attempts.push_back(std::move(facts));
  }
  return out;
}

std::vector<RoundFacts> FactsOf(const std::vector<const RoundRecord*>& records) {
  std::vector<RoundFacts> out;
  for (const RoundRecord* record : records) out.push_back(FactsOf(*record));
  return out;
}

}  // namespace tubetwin
