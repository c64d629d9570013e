#include "twin/round/attempt_facts.h"

namespace tubetwin {
namespace {

std::string FailureOf(const AttemptFacts& facts, bool crashed) {
  if (facts.success) return "";
  if (crashed) return "crashed";
  if (facts.outside > 0) return "outside";
  if (facts.placed > 1) return "several_placed";
  const std::string outcome = (*facts.row)["outcome"];
  if (outcome == "placed" && (*facts.row)["success"].is_null()) return "";  // No truth to doubt it.
  if (outcome == "placed") return "placed_none";
  return facts.placed == 1 ? "placed_unnoticed" : outcome;
}

}  // namespace

std::vector<AttemptFacts> FactsOf(const RoundRecord& record) {
  std::vector<AttemptFacts> out;
  const int start = record.summary["tubes_start"];
  const bool crashed = IsFaultSummary(record.summary);
  int placed_before = record.summary.value("placed_before", 0);
  int outside_before = record.summary.value("outside_before", 0);
  for (const Json& row : record.picks) {
    AttemptFacts facts;
    facts.row = &row;
    facts.first = row["attempt"] == 1;
    facts.success = row["success"] == true;
    facts.tubes_left = start - placed_before - outside_before;
    if (row["truth"].is_object()) {
      const auto placed = static_cast<int>(row["truth"]["placed_ids"].size());
      const auto outside = static_cast<int>(row["truth"]["outside_ids"].size());
      facts.placed = facts.success ? 1 : placed - placed_before;
      facts.outside = outside - outside_before;
      placed_before = placed;
      outside_before = outside;
    } else if (row["success"].is_null() && row["tubes_in_bin"].is_number()) {
      facts.tubes_left = row["tubes_in_bin"];  // Without truth, what the pipeline saw.
    }
    facts.failure = FailureOf(facts, crashed);
    out.push_back(std::move(facts));
  }
  return out;
}

}  // namespace tubetwin
