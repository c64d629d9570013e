#pragma once

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "models/arm/arm.h"
#include "planner/extraction/registry.h"
#include "planner/grasp/gripper_boxes.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {

/// How far results of closed forms in double precision may be off.
inline constexpr double kExact = 1e-9;

/// The gripper of the first cell.
inline const GripperGeometry& FirstGripper() {
  static const GripperGeometry gripper = MakeGripperGeometry(PaperCell());
  return gripper;
}

/// What the generators of some kinds make for a tube, in the registry's order.
inline MotionSet MotionsOf(const std::vector<std::string>& kinds, const TubeScene& scene,
                           const PerceivedTube& tube, const Bin& bin = {},
                           const ExtractionConfig& config = {}) {
  MotionSet all;
  for (const ExtractionMotion& kind : ExtractionMotions()) {
    if (std::count(kinds.begin(), kinds.end(), kind.kind) == 0) continue;
    MotionSet set = kind.make({scene, tube, bin, config});
    std::move(set.motions.begin(), set.motions.end(), std::back_inserter(all.motions));
    std::move(set.rejections.begin(), set.rejections.end(), std::back_inserter(all.rejections));
  }
  return all;
}

/// "up" and the paper's escapes.
inline const std::vector<std::string> kPaperKinds = {"up", "escape"};
/// Slides that are computed from all tubes together.
inline const std::vector<std::string> kWaysOut = {"slide", "escape_away"};
/// The last tier.
inline const std::vector<std::string> kSeparations = {"up_slow", "shake", "hemisphere", "helix"};

}  // namespace tubetwin
