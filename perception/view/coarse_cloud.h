#pragma once

#include <string>

#include "models/base/cloud/cloud.h"
#include "models/base/parallel.h"
#include "perception/view/view_raster.h"

namespace tubetwin {

/// How fine a view is, measured from its points.
struct CloudGrain {
  double spacing_m = 0.0;  ///< Of neighbouring pixels at the median depth.
  double noise_m = 0.0;    ///< rms of a pixel's depth about the smooth surface around it.
};

/// Noise where the view is smooth: of its flattest windows of 5 x 5 pixels, about the best surface
/// of second order. 0 without any whole window.
CloudGrain MeasureGrain(const ViewRaster& raster);

/// Whether normals cannot be taken from blocks of this view as they are: its noise, averaged in
/// blocks, is more than a tube of this radius bulges over the window of a normal.
bool IsCoarse(const CloudGrain& grain, const ViewRaster& raster, double radius_m);

/// Why not even smoothing helps; empty when it may: noise and spacing must stay well below the
/// radius.
std::string TooCoarse(const CloudGrain& grain, double radius_m);

/// The view as a finer one would see it: an organised cloud of about 1.3 mm pitch, every pixel by
/// a local surface of second order through the points within about a radius, those of other
/// surfaces left out. Pose as the raster's. Results do not depend on the thread count.
OrganizedCloud SmoothCoarse(const ViewRaster& raster, const CloudGrain& grain, double radius_m,
                            Parallelism parallelism);

}  // namespace tubetwin
