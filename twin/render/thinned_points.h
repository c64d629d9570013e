#pragma once

#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/bin.h"

namespace tubetwin {

/// Points of all views in and over the bin (frame N) as few as a picture needs: one for each cell
/// of a grid, the first that falls into it; cells are coarser on the floor, and coarser everywhere
/// when there would be more than `most` points. Of large clouds only some rows and columns are
/// looked at. Same clouds, same points. Costs some 30 ms.
std::vector<Vector3> ThinnedPoints(const std::vector<OrganizedCloud>& views, const Bin& bin,
                                   int most = 6000);

}  // namespace tubetwin
