#pragma once

#include <string>
#include <vector>

#include "models/base/parallel.h"
#include "models/bin.h"
#include "perception/view/view_raster.h"

namespace tubetwin {

/// What floor and walls say about the poses that are believed of some views.
struct Registration {
  /// Per view: pose of the true S in the believed one (hand-eye error and the arm's own). Identity
  /// when the views do not show enough, or show something that no pose error explains.
  std::vector<RigidTransform> X_SbelievedS;
  double before_m = 0.0;  ///< rms distance of the floor and wall points from floor and walls.
  double after_m = 0.0;   ///< The same with the corrections.
  int points = 0;         ///< Floor and wall points that were used; 0: nothing was corrected.
};

/// Finds points of the bin's floor and inner walls by place and normal and turns and shifts the
/// views so that they lie on the known planes: one correction that all views share (the scanner is
/// bolted to the flange) and a small one of each. Least squares with robust weights and with what a
/// hand-eye calibration can be off by as prior, so that what nothing shows stays as it was. Results
/// do not depend on the thread count.
Registration RegisterViews(const std::vector<ViewRaster>& views, const Bin& bin,
                           Parallelism parallelism);

/// What to tell a user whose poses are off by more than a calibrated scanner's; else empty.
std::string RegistrationWarning(const Registration& registration);

}  // namespace tubetwin
