#pragma once

#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/bin.h"

namespace tubetwin {

/// The points of all views in and above the bin (frame N), reduced to what a picture needs: the
/// first point in each cell of a grid. The grid is coarser on the floor, and coarser everywhere as
/// long as more than `max_points` are left. Of large clouds only every so many rows and columns are
/// read. Deterministic. About 30 ms.
std::vector<Vector3> DownsampleForPicture(const std::vector<OrganizedCloud>& views, const Bin& bin,
                                          int max_points = 6000);

}  // namespace tubetwin
