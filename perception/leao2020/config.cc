#include "perception/leao2020/config.h"

namespace tubetwin {

void Leao2020Config::Visit(ConfigVisitor& v) {
  v.Field("points", "Table 2: random points that are left after filtering", points,
          {100, 100000000});
  v.Choice("normals_from",
           "raw: neighbours among all filtered points, as the paper did; sampled: among the random "
           "points, as its authors did before",
           normals_from, {"raw", "sampled"});
  v.Field("normal_neighbours", "set: neighbours of a normal", normal_neighbours, {3, 1000});
  v.Field("normal_radius_m", "not in the paper: a radius instead of a count; 0: the count",
          normal_radius_m, {0, 0.1});
  v.Field("smoothness_deg", "set: angle between neighbours' normals within a segment",
          smoothness_deg, {0.1, 90});
  v.Field("curvature", "set: points of more surface variation do not grow on", curvature,
          {0, 0.34});
  v.Field("region_neighbours", "set: neighbours of a point when regions grow", region_neighbours,
          {3, 1000});
  v.Field("least_points", "not in the paper: fewest points of a segment and of a cylinder",
          least_points, {10, 1000000});
  v.Field("least_share", "not in the paper: fewest points of a cylinder over those of its segment",
          least_share, {0, 1});
  v.Field("ransac_iterations", "set: at most, for each cylinder", ransac_iterations, {1, 1000000});
  v.Field("ransac_distance_m", "set: inliers lie this near to the cylinder", ransac_distance_m,
          {1e-5, 0.05});
  v.Field("radius_tolerance_m", "set: of a cylinder's radius about the known one",
          radius_tolerance_m, {1e-5, 0.05});
  v.Field("normal_weight_m_per_rad", "not in the paper: what a radian between normals counts",
          normal_weight_m_per_rad, {0, 0.5});
  v.Field(
      "least_density",
      "not in the paper: points per length, along a cylinder over its median, and of a cylinder "
      "over the densest of its segment",
      least_density, {0, 1});
  v.Field("cylinder_gap_m", "not in the paper: inliers beyond such a gap are another piece",
          cylinder_gap_m, {0.001, 1});
  v.Field("least_cylinder_m", "not in the paper: shorter cylinders are dropped", least_cylinder_m,
          {0, 1});
  v.Field("join_distance_m", "set: farthest endpoints that are joined", join_distance_m, {0, 1});
  v.Field("join_angle_deg", "set: largest turn over a joint", join_angle_deg, {0, 360});
  v.Field("join_m_per_deg", "set: cost of a degree in metres", join_m_per_deg, {0, 1});
  v.Field("gap_window_m", "not in the paper: half side of the depth image's window", gap_window_m,
          {0, 0.05});
  v.Field("longest_share", "not in the paper: longest tube over the part's length", longest_share,
          {1, 10});
  v.Field("least_share_rigid", "Table 2: 35 cm of 50 cm, shorter tubes are discarded",
          least_share_rigid, {0, 1});
  v.Field("least_share_hose", "Table 2: 30 cm of 40 cm, shorter tubes are discarded",
          least_share_hose, {0, 1});
  v.Field("seed", "of the random choice of points", seed, {0, 2147483647});
}

}  // namespace tubetwin
