#pragma once

#include <optional>
#include <vector>

#include "models/base/json_fwd.h"
#include "twin/cell/truth.h"
#include "twin/round/records/round_record.h"

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

/// Angle between the first principal axis of a tube's centerline and the yaw that its slot wants,
/// the tray's y, seen from above: degrees, 0 to 90, as both ends are equal. `centerline_T`: two
/// points or more. Of a bend whose two largest axes are equal it is as good as random.
double YawErrorDeg(const Polyline& centerline_T);

/// What the scoring of attempts to come depends on, and a stored round goes on with.
struct ScorerState {
  TrayCount tray;
  std::vector<int> outside_ids;
};
Json ToJson(const ScorerState& state);
/// Throws Error(kBadData).
ScorerState ScorerStateFromJson(const JsonView& view);

/// Scores attempts while a round runs: by truth, or, of a cell without truth, by what the pipeline
/// believes; `success` and `truth` of its records are empty then. The one place, with the round
/// itself, that sees truth.
class RoundScorer {
 public:
  RoundScorer(const TwinCell& cell, const CellLayout& layout, int tubes_start,
              const PlacementTolerance& tolerance);
  RoundScorer() = default;  ///< Of a cell without truth.

  const ScorerState& state() const { return now_; }
  /// Goes on where a stored round was.
  void Restore(const ScorerState& state);

  /// At the decision how many tubes hang in the fingers.
  void AtDetection();
  /// What the pipeline says of an attempt that has just ended: its record without truth.
  AttemptRecord Believed(const AttemptReport& report);
  /// Adds the truth, once what was let go of has come to rest. Looks come in the order of the
  /// attempts. Only with truth.
  void AddTruth(const AttemptReport& report, AttemptRecord& record);
  bool sees_truth() const { return truth_.has_value(); }
  /// After the last attempt. `attempts`: all of the round's.
  RoundSummary Summary(const RoundReport& report, const std::vector<AttemptRecord>& attempts,
                       double sim_s) const;

 private:
  std::optional<Truth> truth_;
  RigidTransform X_TB_ = RigidTransform::Identity();
  std::optional<PlacementTolerance> tolerance_;  ///< Only with truth.
  std::optional<int> tubes_start_;               ///< Without truth: what the first look found.
  int held_at_detection_ = 0;
  ScorerState before_;  ///< When the round began.
  ScorerState now_;
};

}  // namespace tubetwin
