#pragma once

#include <vector>

#include "models/base/polyline.h"
#include "perception/fragment/axis_points.h"

namespace tubetwin {

/// How well a curve explains surface points as a tube of known radius.
struct TubeFit {
  double rms_m = 0.0;               ///< Of the distances from the tube, those within 2 mm.
  double share = 0.0;               ///< Of the points within 1 mm of the tube's surface.
  std::vector<double> node_weight;  ///< Well-fitting points per node.
  double normal_spread = 0.0;       ///< rms sine of the normals about their mean, around the axis.
  double radius_m = 0.0;       ///< At which the normals of a slice meet best; 0 without any spread.
  double radius_weight = 0.0;  ///< Sum of squared differences of the normals within slices.
};

/// Moves the nodes of `line_N` by Gauss-Newton so that the points lie `radius_m` away from the
/// curve (rounded ends included), with a weak pull to the points' own axis estimates and against
/// bending. The number of nodes stays.
TubeFit RefineCurve(Polyline& line_N, const std::vector<SurfacePoint>& points, double radius_m);

}  // namespace tubetwin
