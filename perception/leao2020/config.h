#pragma once

#include <string>

#include "models/base/config/config.h"

namespace tubetwin {

/// Config table [perception.leao2020]: the modelling of Leão et al. 2020, sections 3.1 and 3.2.
/// Three kinds of keys, told apart in each doc line: "Table 2" is printed there; "set" is a value
/// of the authors' published join data or of the common use of PCL; "not in the paper" had to be
/// chosen, because the step cannot be run without.
struct Leao2020Config {
  int points = 100000;                   ///< Table 2: random points that are left after filtering.
  std::string normals_from = "sampled";  ///< "raw": neighbours among all points, as the paper did.
  int normal_neighbours = 30;            ///< Set. Neighbours of a normal.
  double normal_radius_m = 0.0;  ///< Not in the paper: a radius instead of a count; 0: the count.
  double smoothness_deg = 12.0;  ///< Set. Region growing: angle between neighbours' normals.
  double curvature = 0.05;       ///< Set. Region growing: points above do not grow on.
  int region_neighbours = 30;    ///< Set. Region growing: neighbours of a point.
  int least_points = 200;        ///< Not in the paper: of a segment, and of a cylinder.
  double least_share = 0.02;     ///< Not in the paper: of the segment's points, of a cylinder.
  int ransac_iterations = 1000;  ///< Set. At most, for each cylinder.
  double ransac_distance_m = 0.002;    ///< Set. Inliers lie this near to the cylinder.
  double radius_tolerance_m = 0.0005;  ///< Set. Of a cylinder's radius about the known one.
  /// Not in the paper: one radian counts as so much. More takes the points of bends from every
  /// cylinder: at a radius of 50 mm normals turn by 0.2 rad within 10 mm.
  double normal_weight_m_per_rad = 0.003;
  /// Not in the paper: points per length, along a cylinder over its median, and of a cylinder over
  /// the densest of its segment.
  double least_density = 0.15;
  double cylinder_gap_m = 0.010;    ///< Not in the paper: inliers farther on are another piece.
  double least_cylinder_m = 0.010;  ///< Not in the paper: shorter cylinders are dropped.
  double join_distance_m = 0.03;    ///< Set. Between the endpoints of a joint.
  double join_angle_deg = 30.0;     ///< Set. Turn over a joint.
  double join_m_per_deg = 0.002;    ///< Set. Cost of a degree.
  double gap_window_m = 0.002;      ///< Not in the paper: half side of the depth image's window.
  double longest_share = 1.2;       ///< Not in the paper: a tube's longest length over the part's.
  double least_share_rigid = 0.70;  ///< Table 2: 35 cm of 50 cm; shorter tubes are discarded.
  double least_share_hose = 0.75;   ///< Table 2: 30 cm of 40 cm.
  int seed = 1;                     ///< Of the random choice of points.
  void Visit(ConfigVisitor& v);
};

}  // namespace tubetwin
