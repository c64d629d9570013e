#pragma once

#include <optional>
#include <string>

#include "twin/render/cell_track.h"
#include "twin/render/recording.h"

namespace tubetwin {

/// The load below the wrist sensor over the frames [from, to) of a recording as inline SVG:
/// seconds from the first frame, newtons; the weighing shaded; a mark where the pipeline decided
/// (`decided_s` after the first frame). Rare knocks are cut off. Empty without frames.
std::string ForceTraceSvg(const Recording& recording, int from, int to,
                          std::optional<double> decided_s);

/// The bin from above as inline SVG: the tubes as they truly lie at `sample` of `track`, in grey,
/// and what was perceived in the colours of the classes, the chosen tube bold. `overlay` may be
/// null.
std::string PlanViewSvg(const Recording& recording, const CellTrack& track, int sample,
                        const Recording::Overlay* overlay);

}  // namespace tubetwin
