#pragma once

#include <vector>

#include "hw_bridge/cell/devices.h"
#include "models/base/json_fwd.h"
#include "models/base/time.h"
#include "models/base/wrench.h"
#include "planner/cycle/attempt_report.h"

namespace tubetwin {

/// What the pick cycle knows where several tubes were found to hang in the fingers: with the state
/// of the cell at that moment enough to finish the attempt.
struct AttemptCheckpoint {
  AttemptReport report;  ///< With plan and detection; no rejections, no computing times.
  Polyline line_E;       ///< Centerline of the gripped tube relative to E.
  Wrench reference_K;    ///< Tare.
  TimeNs attempt_began{0};
  std::vector<Polyline> placed_T;  ///< Tubes on the tray, as they were laid.
  JointVector q;                   ///< Where the next motion starts.
  double opening_m = 0.0;          ///< Of the pads, for the clearance of the fingers.
};

/// All numbers come back bit by bit. Reading throws Error(kBadData).
Json ToJson(const AttemptCheckpoint& state);
AttemptCheckpoint AttemptCheckpointFromJson(const JsonView& view);

}  // namespace tubetwin
