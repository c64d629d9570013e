#pragma once

#include <vector>

#include "models/base/parallel.h"
#include "models/bin.h"
#include "perception/scene/tube_scene.h"
#include "perception/view/view_image.h"

namespace tubetwin {

/// Which parts of the bin no view saw.
struct Coverage {
  double unseen_floor_m2 = 0.0;  ///< Floor that no view saw (below tubes included).
  UnseenFloor unseen_floor;      ///< Its cells.
  double unseen_m3 = 0.0;        ///< Room between floor and the walls' upper edge seen by no view.
};
Coverage MeasureCoverage(const std::vector<ViewImage>& views, const Bin& bin,
                         Parallelism parallelism);

}  // namespace tubetwin
