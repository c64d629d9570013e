#pragma once

#include <optional>
#include <string>
#include <vector>

#include "perception/fragment/fragments.h"

namespace tubetwin {

/// Share by which the part's radius may differ from what the points say without a warning.
inline constexpr double kRadiusTolerance = 0.05;

/// Radius of the tubes from their points: the distance that best carries the points of a slice back
/// along their normals onto one axis; the median over the fragments, long ones counting more.
/// Exact within some per cent up to a quarter above or below the radius that the fragments were
/// found with. Nothing when too little was seen.
std::optional<double> EstimateRadius(const std::vector<Fragment>& fragments);

/// For when no tube was found: tries the radius at which the surface points, carried back along
/// their normals, crowd into the fewest places. Nothing when they form no tube of that radius
/// either.
std::optional<double> SearchRadius(std::vector<SurfacePoint> points, Parallelism parallelism);

/// What to tell a user whose part says `part_radius_m`; empty when the two agree within
/// kRadiusTolerance.
std::string RadiusWarning(double part_radius_m, double estimate_m);

}  // namespace tubetwin
