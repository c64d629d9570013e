#pragma once

#include <optional>
#include <string>

#include "models/base/json_fwd.h"
#include "planner/cycle/attempt_report.h"
#include "twin/round/records/tolerance.h"
#include "twin/statistics/statistics.h"

namespace tubetwin {

/// What a round came to: summary.json of its folder. A crashed round is one without an end.
struct RoundSummary {
  int tubes_start = 0;
  /// Where a round that began in the middle stood at its beginning.
  int placed_before = 0, outside_before = 0;
  int placed = 0;  ///< Tubes on the tray; by truth, or believed where there is none.
  int attempts = 0;
  /// Attempts that placed exactly one tube by truth; nothing: nobody knows the cell's truth, and
  /// everything here is what the pipeline believes.
  std::optional<Counts> success;
  Counts first_attempt;  ///< Of the placed tubes, those that took one attempt.
  /// What `in_tolerance` of its rows means; nothing: a cell without truth, crashed, or of an
  /// earlier version.
  std::optional<PlacementTolerance> tolerance;
  bool emptied = false;
  std::optional<RoundEnd> end;  ///< Nothing: its process crashed, nobody was left to say it.
  std::string end_detail;       ///< Why it ended, for people.
  int placed_believed = 0;      ///< By the pipeline.
  int outside = 0;              ///< Tubes lost, by truth.
  int dropped = 0;              ///< Attempts that let a carried tube fall.
  std::optional<double> sim_s;  ///< Simulated time of the round; nothing: it crashed.

  bool crashed() const { return !end; }
  /// As files call its end: "empty", "no_plan", ..., "crashed".
  std::string EndName() const;
  /// Simulated seconds for each tube that an attempt placed.
  std::optional<double> SecondsPerPick() const;
};

/// Content of summary.json. Reading throws Error(kBadData).
Json ToJson(const RoundSummary& summary);
RoundSummary SummaryFromJson(const JsonView& view);

}  // namespace tubetwin
