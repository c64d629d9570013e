#pragma once

#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/bin.h"

namespace tubetwin {

/// The measured points of some views in frame N, one per cube of `cube_m` (the first seen, in the
/// order of views and pixels), within the bin's inner walls less 3 mm and from 3 mm above the floor
/// to `top_m`. Counting these does not depend on how densely the scanner sampled. Sorted by cube.
std::vector<Vector3> VoxelDownsample(const std::vector<OrganizedCloud>& views, const Bin& bin,
                                     double cube_m = 0.003, double top_m = 0.20);

}  // namespace tubetwin
