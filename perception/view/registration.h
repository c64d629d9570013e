#pragma once

#include <string>
#include <vector>

#include "models/base/parallel.h"
#include "models/bin.h"
#include "perception/view/view_raster.h"

namespace tubetwin {

/// How far the believed poses of some views are off, judged by the floor and walls of the bin.
struct Registration {
  /// Per view: pose of the true S in the believed S (errors of the hand-eye calibration and of the
  /// arm). Identity when too little of floor and walls is seen, or when no pose error explains it.
  std::vector<RigidTransform> X_SbelievedS;
  double before_m = 0.0;  ///< rms distance of the floor and wall points from floor and walls.
  double after_m = 0.0;   ///< The same with the corrections.
  int points = 0;         ///< Floor and wall points that were used; 0: nothing was corrected.
};

/// Corrects the poses so that points of the bin's floor and inner walls, found by place and normal,
/// lie on these known planes. Estimated are one correction that all views share (the scanner is
/// bolted to the flange) and a small one for each view: least squares with robust weights and, as
/// prior, the usual errors of a hand-eye calibration, so that a direction that no plane fixes is
/// left as it was. Results do not depend on the thread count.
Registration RegisterViews(const std::vector<ViewRaster>& views, const Bin& bin,
                           Parallelism parallelism);

/// A warning for the user when the poses are further off than those of a calibrated scanner; else
/// empty.
std::string RegistrationWarning(const Registration& registration);

}  // namespace tubetwin
