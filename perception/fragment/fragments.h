#pragma once

#include <array>
#include <vector>

#include "models/base/parallel.h"
#include "models/base/polyline.h"
#include "perception/fragment/axis_space.h"

namespace tubetwin {

/// Distance of a fragment's nodes.
inline constexpr double kNodeStep_m = 0.005;

struct FragmentEnd {
  Vector3 p_N = Vector3::Zero();
  Vector3 outward_N = Vector3::UnitX();  ///< Unit tangent, out of the fragment.
  /// 0..1: how much of a closed end (points whose normal looks outward) is seen.
  double cap = 0.0;
  /// How far the surface goes on beyond p_N: up to one radius where a round end is seen, nothing
  /// where the tube is cut off or goes on unseen.
  double tip_m = 0.0;
  Vector3 bend_N = Vector3::Zero();  ///< Curvature vector (1/m) of the curve, going outward.
};

/// A piece of one tube that was seen without interruption.
struct Fragment {
  Polyline line_N;  ///< Nodes about kNodeStep_m apart.
  double length_m = 0.0;
  double rms_m = 0.0;  ///< Of the surface points' distance from the tube, those within 2 mm.
  double fit = 0.0;    ///< 0..1, share of the surface points within 1 mm of the tube.
  double normal_spread = 0.0;  ///< rms sine of the normals about their mean, around the axis.
  double radius_m = 0.0, radius_weight = 0.0;  ///< As in TubeFit.
  std::array<FragmentEnd, 2> ends;             ///< At the first and the last node.
};

/// Makes a curve of every component and refines it: its nodes are moved until the surface points
/// lie one radius away from it. Components that do not fit a tube of this radius (too short, flat,
/// large residuals) are left out.
std::vector<Fragment> FindFragments(const AxisSpace& space, const std::vector<SurfacePoint>& points,
                                    double radius_m, Parallelism parallelism);

}  // namespace tubetwin
