#pragma once

#include <optional>
#include <string>
#include <vector>

#include "perception/fragment/fragments.h"

namespace tubetwin {

/// Share by which the part's radius may differ from what the points say without a warning.
inline constexpr double kRadiusTolerance = 0.05;

/// Radius of the tubes, estimated from their points: the distance by which the points of a slice
/// must be moved back along their normals to meet best on one axis; the median over the fragments,
/// weighted by length. Good to a few per cent when it is within 25 % of the radius that the
/// fragments were found with. Nothing when too little was seen.
std::optional<double> EstimateRadius(const std::vector<Fragment>& fragments);

/// For scenes in which no tube of the part's radius was found: the radius for which the surface
/// points, moved back along their normals by it, fill the fewest voxels. Nothing when no tube of
/// that radius is found either.
std::optional<double> SearchRadius(std::vector<SurfacePoint> points, Parallelism parallelism);

/// What to tell a user whose part says `part_radius_m`; empty when the two agree within
/// kRadiusTolerance.
std::string RadiusWarning(double part_radius_m, double estimate_m);

}  // namespace tubetwin
