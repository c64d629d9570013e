#pragma once

#include <vector>

#include "models/base/parallel.h"
#include "models/base/polyline.h"
#include "models/mesh/mesh.h"

namespace tubetwin {

/// Axes of what is a tube of about this radius (10 % off is near enough) among points of a round
/// surface whose normals look outwards, the longest first: pieces that follow one another are
/// joined, pieces shorter than one and a half radii left out. The longest reaches to its ends: as
/// far as points have their axis on it. Works in units of the radius, so for any size.
std::vector<Polyline> FindAxes(const std::vector<MeshPoint>& surface, double radius_m,
                               Parallelism parallelism);

/// How many points of a surface of `area_m2` FindAxes needs.
int PointsForAxes(double area_m2, double radius_m);

}  // namespace tubetwin
