#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "models/base/json_fwd.h"
#include "perception/scene/tube_scene.h"
#include "planner/cycle/attempt_report.h"
#include "planner/grasp/detection.h"
#include "planner/pick/pick_plan.h"

namespace tubetwin {

/// Which row of a round or campaign a record stands in.
struct RowPlace {
  int round = 0;
  std::optional<int> variant;  ///< Of a campaign; nothing in a round's own folder.
};

/// What an attempt set out to do. Orientations are kept as the numbers of the file, because a
/// rotation matrix in between would change their last digits.
struct ChosenPick {
  int target = 0;
  TubeClass target_class = TubeClass::kFree;
  std::string motion;                                   ///< Its name.
  std::vector<Vector3> waypoints_N;                     ///< As ObjectPath's, metres.
  std::vector<std::array<double, 4>> rotations_N_wxyz;  ///< One a waypoint, or none: not turned.
  Vector3 pivot_N = Vector3::Zero();                    ///< Without meaning where nothing turns.
  Vector3 p_NG = Vector3::Zero();                       ///< Of the grasp, metres.
  std::array<double, 4> q_NG_wxyz{1.0, 0.0, 0.0, 0.0};
  double at_m = 0.0;       ///< Arc length of the grasp on the tube.
  double opening_m = 0.0;  ///< Of the fingers before closing.
};
ChosenPick ChosenPickOf(const PickPlan& plan);

/// What was true at the end of an attempt.
struct AttemptTruth {
  std::optional<int> held;       ///< Tubes in the fingers at the decision; nothing: none was made.
  std::vector<int> placed_ids;   ///< On the tray so far, in the whole round.
  std::vector<int> outside_ids;  ///< Lost so far, in the whole round.
  /// Of the tube that this attempt placed: its centre of mass from its slot's centre, horizontally,
  /// and its yaw from the slot's, modulo 180 degrees (YawErrorDeg).
  std::optional<double> placement_error_mm, placement_error_deg;
};

/// One attempt as a row of picks.jsonl: what was seen, chosen, felt, done and true, and nothing
/// that a clock measured.
struct AttemptRecord {
  int attempt = 1;                   ///< Counts from 1 after each placed tube.
  std::optional<int> tubes_in_bin;   ///< Perceived; nothing: the round crashed.
  std::optional<ChosenPick> chosen;  ///< Nothing: there was no plan.
  bool used_simulator = false;
  std::optional<Prediction> prediction;  ///< Of covered tubes.
  std::optional<Detection> detection;    ///< How many hang; nothing: it did not come that far.
  bool resolution_used = false;
  std::string strategy;                     ///< Of the resolution; empty: none was used.
  std::optional<HeldOutcome> held_at_last;  ///< After the resolution; nothing: none was used.
  std::vector<NudgeReport> nudges;          ///< Before the plan was found, or in vain.
  AttemptOutcome outcome = AttemptOutcome::kFault;  ///< As the pipeline believes.
  std::string reason;                               ///< Of the outcome, for people.
  std::optional<bool> success;  ///< By truth: exactly one new tube on the tray, none outside.
  /// Success, and the placed tube lies where it was meant to (PlacementTolerance); nothing: there
  /// is no `success`, or an earlier version wrote the row.
  std::optional<bool> in_tolerance;
  std::optional<AttemptReport::SimTime> sim_s;  ///< Nothing: the round crashed.
  /// The same time by what it was for; nothing: it crashed, or an earlier version wrote the row.
  std::optional<AttemptReport::Phases> phases_s;
  std::optional<AttemptTruth> truth;  ///< Nothing: a cell without truth, or crashed.
};

/// A row of picks.jsonl, and the record of one; the row's place is read by whoever looks for it.
/// Rows of earlier versions, which lack prediction, nudges, phases or tolerance, are read too.
/// Throws Error(kBadData).
Json ToJson(const AttemptRecord& attempt, const RowPlace& place);
AttemptRecord AttemptFromJson(const JsonView& row);

inline constexpr int kAfterLastAttempt = 0;

/// What an attempt took on the clocks of the machine: a row of timings.jsonl.
struct AttemptTiming {
  /// As the record's; kAfterLastAttempt: of what came after the last, the look that found nothing
  /// to do.
  int attempt = 1;
  std::optional<AttemptReport::ComputeTime> compute_s;  ///< Nothing: the round crashed.
  double wall_s = 0.0;
};
Json ToJson(const AttemptTiming& timing, const RowPlace& place);
/// Throws Error(kBadData).
AttemptTiming TimingFromJson(const JsonView& row);

}  // namespace tubetwin
