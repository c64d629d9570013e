#pragma once

#include <optional>
#include <vector>

#include "models/base/parallel.h"
#include "models/base/polyline.h"
#include "models/mesh/mesh.h"

namespace tubetwin {

/// A plane's cut through the outer wall of a tube's mesh.
struct WallSection {
  Vector3 centre = Vector3::Zero();
  double radius_m = 0.0;
  double seen = 0.0;   ///< 0..1: share of the directions about the axis in which there is wall.
  double slope = 0.0;  ///< Mean |sine| between wall and axis: 0 for a cylinder.
};

/// Cuts a mesh that is wound outwards. Const calls are thread safe; the mesh is copied from.
class WallCutter {
 public:
  explicit WallCutter(const Mesh& mesh);

  /// The section across the unit vector `t` at `p`, near the axis: of faces within `reach_m` that
  /// look away from `p` and stand within 30 degrees along `t`. The centre is that of the circle
  /// that fits best (Kasa 1976), so no radius is assumed. Nothing where too little is cut to tell.
  std::optional<WallSection> Cut(const Vector3& p, const Vector3& t, double reach_m) const;

 private:
  struct Face {
    Vector3 corner[3], normal, middle;
    double reach_m;  ///< Of the farthest corner from the middle.
  };
  std::vector<Face> faces_;
};

/// An axis in the centres of a wall's sections.
struct SectionedAxis {
  Polyline line;
  std::vector<WallSection> sections;  ///< Those that were found, in the line's order.
};

/// Moves a rough axis (within half a radius of the true one) into the centres of the wall's
/// sections, wherever the wall is thicker or thinner than `radius_m`, and prolongs it as far as
/// there is wall. Ends: where half of the way around is wall, for rounded ends their centre.
/// `points`: of the outer surface, for the ends. Empty line where hardly any section is found.
SectionedAxis CentreInSections(const WallCutter& cutter, const std::vector<MeshPoint>& points,
                               const Polyline& rough, double radius_m, Parallelism parallelism);

}  // namespace tubetwin
