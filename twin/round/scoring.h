#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/json.h"
#include "planner/cycle/attempt_report.h"
#include "twin/cell/truth.h"

namespace tubetwin {

/// What lies on the tray, by truth.
struct TrayCount {
  std::vector<int> placed_ids;  ///< In the order of the tubes.
  /// Over the tray and out of the gripper's and the bin's reach: the placed ones and those that
  /// still move.
  std::vector<int> arrived_ids;
};

/// Placed is a tube that is at rest over the tray, no part over the bin or in the gripper, and one
/// that was placed before and has not left the tray: a new neighbour may make it rock.
TrayCount CountTray(const std::vector<Truth::Tube>& tubes, const TrayCount& before);

/// Scores attempts while a round runs: by truth, or, of a cell without truth, by what the pipeline
/// believes; `success` and `truth` of its rows are null then, and summaries say `scored_by`. The
/// one place, with the round itself, that sees truth.
class RoundScorer {
 public:
  RoundScorer(const TwinCell& cell, int tubes_start);
  RoundScorer() = default;  ///< Of a cell without truth.

  /// What rows to come depend on: {placed_ids, arrived_ids, outside_ids}, and back.
  Json State() const;
  void Restore(const JsonView& state);

  /// At the decision how many tubes hang in the fingers.
  void AtDetection();
  /// At the end of an attempt (at least one second after a release): its row for picks.jsonl.
  Json AttemptRow(const AttemptReport& report, int round);
  /// Row for timings.jsonl.
  static Json TimingRow(const AttemptReport& report, int round, double wall_s);
  /// Content of summary.json after the last attempt.
  Json Summary(const RoundReport& report, double sim_s) const;

 private:
  std::optional<Truth> truth_;
  int tubes_start_ = 0;                         ///< Without truth: what the first look found.
  int placed_before_ = 0, outside_before_ = 0;  ///< Of a restored round.
  int held_at_detection_ = 0;
  TrayCount tray_;
  std::vector<int> outside_ids_;
  int attempts_ = 0, successes_ = 0;
  int first_attempts_placed_ = 0;  ///< Placed by truth at attempt 1.
  int picks_placed_ = 0;           ///< Attempts that placed exactly one, by truth.
  int dropped_ = 0;
  std::vector<Json> rows_;
};

}  // namespace tubetwin
