// The steps that PCL does: normals, region growing, RANSAC cylinders. The only file of this room
// that sees its headers.

#include "perception/leao2020/cylinders.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <pcl/console/print.h>
#include <pcl/features/normal_3d.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/region_growing.h>
#include <pcl/segmentation/sac_segmentation.h>

#include "models/base/cloud/cloud.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

using Points = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;

Points::Ptr ToPcl(const std::vector<Eigen::Vector3f>& points) {
  Points::Ptr out(new Points);
  out->reserve(points.size());
  for (const Eigen::Vector3f& p : points) out->emplace_back(p.x(), p.y(), p.z());
  return out;
}

Normals::Ptr NormalsToPcl(const LeaoCloud& cloud) {
  Normals::Ptr out(new Normals);
  out->reserve(cloud.n_N.size());
  for (std::size_t i = 0; i < cloud.n_N.size(); ++i) {
    const Eigen::Vector3f& n = cloud.n_N[i];
    out->emplace_back(n.x(), n.y(), n.z(), cloud.curvature[i]);
  }
  return out;
}

/// The library says on stderr what is an outcome here (two equal sample points, for example).
void KeepPclQuiet() {
  static const bool once = [] {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
    return true;
  }();
  (void)once;
}

/// Inliers of one cylinder that follow one another along its axis.
struct Run {
  std::vector<int> points;
  double from_m = 0.0, to_m = 0.0;  ///< Along the axis from its reference point.
};

/// The longest stretch of the axis over which inliers are about as dense as on most of it. Where a
/// tube bends away, only a thin strip of it still lies on the cylinder: that belongs to the next.
Run LongestRun(const Points& points, const std::vector<int>& inliers, const Eigen::Vector3f& p_N,
               const Eigen::Vector3f& axis_N, const Leao2020Config& config) {
  constexpr float kSlice_m = 0.002f;
  std::vector<std::pair<float, int>> along;
  along.reserve(inliers.size());
  for (const int i : inliers) {
    along.emplace_back((points[i].getVector3fMap() - p_N).dot(axis_N), i);
  }
  std::sort(along.begin(), along.end());
  Run run;
  if (along.empty()) return run;
  const float from = along.front().first;
  const auto slice_of = [&](float s) { return static_cast<std::size_t>((s - from) / kSlice_m); };
  std::vector<int> count(slice_of(along.back().first) + 1, 0);
  for (const auto& [s, i] : along) ++count[slice_of(s)];
  std::vector<int> filled;
  std::copy_if(count.begin(), count.end(), std::back_inserter(filled), [](int c) { return c > 0; });
  std::nth_element(filled.begin(), filled.begin() + filled.size() / 2, filled.end());
  const double min_count = config.least_density * filled[filled.size() / 2];
  const auto gap = static_cast<std::size_t>(config.cylinder_gap_m / kSlice_m);
  std::size_t best = 0, best_end = 0, begin = 0, end = 0;  // Slices [begin, end).
  for (std::size_t k = 0; k < count.size(); ++k) {
    if (count[k] == 0 || count[k] < min_count) continue;
    if (end == begin || k > end + gap) begin = k;
    end = k + 1;
    if (end - begin > best_end - best) {
      best = begin;
      best_end = end;
    }
  }
  for (const auto& [s, i] : along) {
    if (slice_of(s) < best || slice_of(s) >= best_end) continue;
    if (run.points.empty()) run.from_m = s;
    run.to_m = s;
    run.points.push_back(i);
  }
  return run;
}

/// RANSAC on what is left of one segment.
struct Fit {
  std::vector<int> inliers;
  Eigen::Vector3f p_N = Eigen::Vector3f::Zero(), axis_N = Eigen::Vector3f::UnitX();
  bool found = false;
};

Fit Sample(const Points::Ptr& points, const Normals::Ptr& normals, const pcl::IndicesPtr& left,
           double radius_m, const Leao2020Config& config, bool refine) {
  pcl::SACSegmentationFromNormals<pcl::PointXYZ, pcl::Normal> ransac;
  ransac.setModelType(pcl::SACMODEL_CYLINDER);
  ransac.setMethodType(pcl::SAC_RANSAC);
  ransac.setMaxIterations(config.ransac_iterations);
  // PCL's distance is w * radians + (1 - w) * metres. Dividing it by 1 - w keeps metres metres.
  const double w = config.normal_weight_m_per_rad / (1.0 + config.normal_weight_m_per_rad);
  ransac.setNormalDistanceWeight(w);
  ransac.setDistanceThreshold((1.0 - w) * config.ransac_distance_m);
  ransac.setRadiusLimits(radius_m - config.radius_tolerance_m,
                         radius_m + config.radius_tolerance_m);
  ransac.setOptimizeCoefficients(refine);
  ransac.setInputCloud(points);
  ransac.setInputNormals(normals);
  ransac.setIndices(left);
  pcl::PointIndices inliers;
  pcl::ModelCoefficients model;
  ransac.segment(inliers, model);
  Fit fit;
  if (model.values.size() != 7 || inliers.indices.empty()) return fit;
  fit.p_N = {model.values[0], model.values[1], model.values[2]};
  fit.axis_N = Eigen::Vector3f(model.values[3], model.values[4], model.values[5]).normalized();
  fit.found = fit.p_N.allFinite() && fit.axis_N.allFinite();
  fit.inliers.assign(inliers.indices.begin(), inliers.indices.end());
  return fit;
}

Fit FitOne(const Points::Ptr& points, const Normals::Ptr& normals, const std::vector<int>& left,
           double radius_m, const Leao2020Config& config) {
  const pcl::IndicesPtr indices(new pcl::Indices(left));
  Fit fit = Sample(points, normals, indices, radius_m, config, true);
  // The refinement frees the radius and may leave the limits; then the best sample stands.
  if (!fit.found) fit = Sample(points, normals, indices, radius_m, config, false);
  return fit;
}

std::vector<LeaoCylinder> FitSegment(const Points::Ptr& points, const Normals::Ptr& normals,
                                     std::vector<int> left, double radius_m,
                                     const Leao2020Config& config) {
  std::vector<LeaoCylinder> out;
  const int min_count = std::max(
      config.least_points, static_cast<int>(config.least_share * static_cast<double>(left.size())));
  double densest = 0.0;  // Points per metre.
  while (static_cast<int>(left.size()) >= min_count) {
    const Fit fit = FitOne(points, normals, left, radius_m, config);
    if (!fit.found) break;
    const Run run = LongestRun(*points, fit.inliers, fit.p_N, fit.axis_N, config);
    if (static_cast<int>(run.points.size()) < min_count) break;
    const Vector3 p_N = fit.p_N.cast<double>(), axis_N = fit.axis_N.cast<double>();
    LeaoCylinder cylinder;
    cylinder.end_N = {p_N + run.from_m * axis_N, p_N + run.to_m * axis_N};
    cylinder.points = static_cast<int>(run.points.size());
    // Strips beside the cylinders of a bend are long but thin.
    const double density = cylinder.points / std::max(cylinder.length_m(), 1e-6);
    if (cylinder.length_m() >= config.least_cylinder_m) {
      densest = std::max(densest, density);
      if (density >= config.least_density * densest) out.push_back(cylinder);
    }
    std::vector<int> used = run.points, rest;
    std::sort(used.begin(), used.end());
    std::set_difference(left.begin(), left.end(), used.begin(), used.end(),
                        std::back_inserter(rest));
    left = std::move(rest);
  }
  return out;
}

}  // namespace

LeaoCloud EstimateNormals(const std::vector<Eigen::Vector3f>& points_N,
                          const std::vector<Eigen::Vector3f>& surface_N,
                          const std::vector<int>& eye_of,
                          const std::vector<Eigen::Vector3f>& eyes_N, const Leao2020Config& config,
                          Parallelism parallelism) {
  TT_CHECK(eye_of.size() == points_N.size());
  KeepPclQuiet();
  LeaoCloud out;
  out.p_N = points_N;
  out.n_N.assign(points_N.size(), InvalidPoint());
  out.curvature.assign(points_N.size(), std::numeric_limits<float>::quiet_NaN());
  if (surface_N.empty()) return out;
  const Points::Ptr surface = ToPcl(surface_N);
  pcl::search::KdTree<pcl::PointXYZ> tree;
  tree.setSortedResults(false);
  tree.setInputCloud(surface);
  constexpr std::size_t kChunk = 512;
  const int chunks = static_cast<int>((points_N.size() + kChunk - 1) / kChunk);
  ParallelFor(chunks, parallelism, [&](int chunk, int) {
    pcl::Indices neighbours;
    std::vector<float> squared_m2;
    const std::size_t end = std::min(points_N.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      const pcl::PointXYZ p(points_N[i].x(), points_N[i].y(), points_N[i].z());
      const int found =
          config.normal_radius_m > 0
              ? tree.radiusSearch(p, config.normal_radius_m, neighbours, squared_m2)
              : tree.nearestKSearch(p, config.normal_neighbours, neighbours, squared_m2);
      Eigen::Vector4f plane;
      if (found < 3 || !pcl::computePointNormal(*surface, neighbours, plane, out.curvature[i])) {
        continue;
      }
      const Eigen::Vector3f n = plane.head<3>();
      const bool away = n.dot(eyes_N[static_cast<std::size_t>(eye_of[i])] - points_N[i]) < 0;
      out.n_N[i] = away ? Eigen::Vector3f(-n) : n;
    }
  });
  return out;
}

std::vector<std::vector<int>> GrowRegions(const LeaoCloud& cloud, const Leao2020Config& config) {
  KeepPclQuiet();
  std::vector<std::vector<int>> out;
  pcl::IndicesPtr usable(new pcl::Indices);
  for (std::size_t i = 0; i < cloud.n_N.size(); ++i) {
    if (cloud.n_N[i].allFinite()) usable->push_back(static_cast<int>(i));
  }
  if (static_cast<int>(usable->size()) < config.least_points) return out;
  pcl::RegionGrowing<pcl::PointXYZ, pcl::Normal> growing;
  growing.setMinClusterSize(static_cast<unsigned>(config.least_points));
  growing.setNumberOfNeighbours(static_cast<unsigned>(config.region_neighbours));
  growing.setSmoothnessThreshold(static_cast<float>(Radians(config.smoothness_deg)));
  growing.setCurvatureThreshold(static_cast<float>(config.curvature));
  growing.setSearchMethod(
      pcl::search::KdTree<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
  growing.setInputCloud(ToPcl(cloud.p_N));
  growing.setInputNormals(NormalsToPcl(cloud));
  growing.setIndices(usable);
  std::vector<pcl::PointIndices> clusters;
  growing.extract(clusters);
  for (const pcl::PointIndices& cluster : clusters) {
    out.emplace_back(cluster.indices.begin(), cluster.indices.end());
    std::sort(out.back().begin(), out.back().end());
  }
  return out;
}

std::vector<LeaoCylinder> FitCylinders(const LeaoCloud& cloud,
                                       const std::vector<std::vector<int>>& segments,
                                       double radius_m, const Leao2020Config& config,
                                       Parallelism parallelism) {
  KeepPclQuiet();
  const Points::Ptr points = ToPcl(cloud.p_N);
  const Normals::Ptr normals = NormalsToPcl(cloud);
  std::vector<std::vector<LeaoCylinder>> of_segment(segments.size());
  ParallelFor(static_cast<int>(segments.size()), parallelism, [&](int s, int) {
    const auto k = static_cast<std::size_t>(s);
    of_segment[k] = FitSegment(points, normals, segments[k], radius_m, config);
  });
  std::vector<LeaoCylinder> out;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    for (LeaoCylinder& cylinder : of_segment[s]) {
      cylinder.segment = static_cast<int>(s);
      out.push_back(cylinder);
    }
  }
  return out;
}

}  // namespace tubetwin
