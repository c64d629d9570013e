#pragma once

#include "models/base/cloud/cloud.h"
#include "perception/view/view_image.h"

namespace tubetwin {

/// The depth image of one cloud, cells about 2 `block_m` wide. Throws as MakeViewRaster.
ViewImage MakeDepthImage(const OrganizedCloud& cloud, double block_m);

}  // namespace tubetwin
