#pragma once

#include <array>
#include <vector>

#include "models/base/frames.h"
#include "models/base/parallel.h"
#include "perception/leao2020/config.h"

namespace tubetwin {

/// A straight visible piece of a tube. Frame N.
struct LeaoCylinder {
  std::array<Vector3, 2> end_N = {Vector3::Zero(), Vector3::Zero()};  ///< On the axis.
  int segment = 0;  ///< The smooth region that it was fitted to.
  int points = 0;   ///< Inliers.

  double length_m() const { return (end_N[1] - end_N[0]).norm(); }
  /// Unit axis, out of the cylinder at end 0 or 1.
  Vector3 Outward(int end) const { return (end_N[end] - end_N[1 - end]).normalized(); }
};

/// Points with what the segmentation needs. Frame N.
struct LeaoCloud {
  std::vector<Eigen::Vector3f> p_N;
  std::vector<Eigen::Vector3f> n_N;  ///< Unit normals; NaN where a point has too few neighbours.
  std::vector<float> curvature;      ///< Smallest eigenvalue over the sum of the three.
};

/// Normals (covariance of the neighbours) of `points_N` among `surface_N`, turned to the place in
/// `eyes_N` that each point was seen from: `eye_of[i]` is an index into it.
LeaoCloud EstimateNormals(const std::vector<Eigen::Vector3f>& points_N,
                          const std::vector<Eigen::Vector3f>& surface_N,
                          const std::vector<int>& eye_of,
                          const std::vector<Eigen::Vector3f>& eyes_N, const Leao2020Config& config,
                          Parallelism parallelism);

/// Smooth regions, the paper's segments: indices of points, regions in the order of growing.
std::vector<std::vector<int>> GrowRegions(const LeaoCloud& cloud, const Leao2020Config& config);

/// Cylinders of known radius, again and again on what the last one left of its segment, until too
/// few points are left. Every fit draws from PCL's own generator, which starts each with the same
/// seed, so results do not depend on the thread count.
std::vector<LeaoCylinder> FitCylinders(const LeaoCloud& cloud,
                                       const std::vector<std::vector<int>>& segments,
                                       double radius_m, const Leao2020Config& config,
                                       Parallelism parallelism);

}  // namespace tubetwin
