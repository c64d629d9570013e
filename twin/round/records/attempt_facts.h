#pragma once

#include <string>
#include <vector>

#include "twin/round/records/round_record.h"

namespace tubetwin {

/// What truth says of one attempt of a round.
struct AttemptFacts {
  const AttemptRecord* attempt = nullptr;  ///< Lives as long as its record.
  const AttemptTiming* timing = nullptr;   ///< Likewise; null: nobody kept it.
  bool first = false;                      ///< The first attempt since a tube was placed.
  bool success = false;                    ///< Exactly one new tube on the tray, nothing outside.
  /// Success with so small an error at most, and a yaw within its round's tolerance; false where
  /// the rows do not say.
  bool Within(double error_mm) const;
  std::optional<double> yaw_limit_deg;  ///< Of its round; nothing: not known.
  int tubes_left = 0;  ///< In the bin before it: at the start, less placed and outside.
  int placed = 0;      ///< Tubes that came to count as placed; one for a success.
  int outside = 0;     ///< Tubes that it lost outside.
  /// Why it is no success: "crashed", "outside", "several_placed", "placed_none" (believed placed),
  /// "placed_unnoticed", else the pipeline's own outcome ("nothing_held", "dropped", "put_back",
  /// "no_plan", "fault"). Empty for a success.
  std::string failure;

  /// Success, or what the pipeline believes where nobody knows the truth.
  bool PlacedOne() const { return failure.empty(); }
};

/// A round with the facts of its attempts, in order: what metrics and reports look at. Refers to
/// the record, which must outlive it.
struct RoundFacts {
  const RoundRecord* record = nullptr;
  std::vector<AttemptFacts> attempts;
};
RoundFacts FactsOf(const RoundRecord& record);
std::vector<RoundFacts> FactsOf(const std::vector<const RoundRecord*>& records);

}  // namespace tubetwin
