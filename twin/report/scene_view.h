#pragma once

#include <optional>

#include "models/base/json_fwd.h"
#include "twin/render/cell_track.h"
#include "twin/render/recording.h"

namespace tubetwin {

/// One attempt for the page's 3-D view (report/viewer.js reads it): shapes, poses of bodies where
/// they changed, path of the gripper, the load at the wrist, what was perceived and the scanner's
/// points; frame B. Numbers are 16-bit integers in base 64: positions in 0.1 mm, quaternions in
/// 1/32767, forces in 0.01 N. `from`: the frame of the recording at which `track` begins.
Json AttemptScene(const Recording& recording, const CellTrack& track, int from, int stride);

/// The last look into the bin (not stale, not empty) among the frames [from, to); null when there
/// is none.
const Recording::Overlay* LookDuring(const Recording& recording, int from, int to);

}  // namespace tubetwin
