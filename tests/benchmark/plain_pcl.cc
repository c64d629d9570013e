#include "tests/benchmark/plain_pcl.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include <pcl/common/transforms.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/crop_box.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/filters/random_sample.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/region_growing.h>
#include <pcl/segmentation/sac_segmentation.h>

#include "perception/leao2020/depth_image.h"
#include "perception/leao2020/tubes.h"

namespace tubetwin {
namespace {

using Point = pcl::PointXYZ;
using Points = pcl::PointCloud<Point>;
using Normals = pcl::PointCloud<pcl::Normal>;

constexpr float kSurface_m = 0.003f;  // Floor and walls end here.
constexpr double kNormalRadius_m = 0.003;

Points::Ptr RawCloud(const OrganizedCloud& cloud) {
  Points::Ptr raw(new Points);
  raw->reserve(cloud.size());
  for (const Eigen::Vector3f& p : cloud.p_SP) {
    if (IsValid(p)) raw->emplace_back(p.x(), p.y(), p.z());
  }
  const Eigen::Matrix4f X_NS = cloud.X_NS.matrix().cast<float>();
  pcl::transformPointCloud(*raw, *raw, X_NS);
  return raw;
}

// Inside the walls, or over them where tubes stick out.
Points::Ptr FilterTubes(const Points::Ptr& raw, const Bin& bin) {
  const auto crop = [&](float x, float y, float z_low) {
    pcl::CropBox<Point> box;
    box.setMin({-x, -y, z_low, 1});
    box.setMax({x, y, 0.4f, 1});
    box.setInputCloud(raw);
    Points kept;
    box.filter(kept);
    return kept;
  };
  const auto x = static_cast<float>(bin.half_x_m()), y = static_cast<float>(bin.half_y_m());
  const auto wall = static_cast<float>(bin.wall_m());
  Points::Ptr tubes(new Points(crop(x - kSurface_m, y - kSurface_m, kSurface_m)));
  pcl::CropBox<Point> inner;
  inner.setMin({-x + kSurface_m, -y + kSurface_m, -1, 1});
  inner.setMax({x - kSurface_m, y - kSurface_m, 1, 1});
  inner.setNegative(true);
  inner.setInputCloud(Points::Ptr(new Points(crop(x + 0.3f, y + 0.3f, wall + kSurface_m))));
  Points over;
  inner.filter(over);
  *tubes += over;
  pcl::RandomSample<Point> sample;
  sample.setSample(100000);
  sample.setSeed(1);
  sample.setInputCloud(tubes);
  Points::Ptr chosen(new Points);
  sample.filter(*chosen);
  return chosen;
}

Normals::Ptr FindNormals(const Points::Ptr& points, const Points::Ptr& raw,
                         const Eigen::Vector3f& eye, int threads) {
  pcl::NormalEstimationOMP<Point, pcl::Normal> estimation(static_cast<unsigned>(threads));
  estimation.setInputCloud(points);
  estimation.setSearchSurface(raw);
  estimation.setSearchMethod(pcl::search::KdTree<Point>::Ptr(new pcl::search::KdTree<Point>));
  estimation.setRadiusSearch(kNormalRadius_m);
  estimation.setViewPoint(eye.x(), eye.y(), eye.z());
  Normals::Ptr normals(new Normals);
  estimation.compute(*normals);
  return normals;
}

std::vector<pcl::PointIndices> Segment(const Points::Ptr& points, const Normals::Ptr& normals) {
  pcl::RegionGrowing<Point, pcl::Normal> growing;
  growing.setMinClusterSize(200);
  growing.setSearchMethod(pcl::search::KdTree<Point>::Ptr(new pcl::search::KdTree<Point>));
  growing.setNumberOfNeighbours(30);
  growing.setSmoothnessThreshold(static_cast<float>(Radians(12)));
  growing.setCurvatureThreshold(0.05f);
  growing.setInputCloud(points);
  growing.setInputNormals(normals);
  std::vector<pcl::PointIndices> segments;
  growing.extract(segments);
  return segments;
}

LeaoCylinder MakeCylinder(const Points& points, const pcl::PointIndices& inliers,
                          const pcl::ModelCoefficients& model, int segment) {
  const Vector3 p(model.values[0], model.values[1], model.values[2]);
  const Vector3 axis = Vector3(model.values[3], model.values[4], model.values[5]).normalized();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const int i : inliers.indices) {
    const double s = (points[i].getVector3fMap().cast<double>() - p).dot(axis);
    low = std::min(low, s);
    high = std::max(high, s);
  }
  LeaoCylinder cylinder;
  cylinder.end_N = {p + low * axis, p + high * axis};
  cylinder.segment = segment;
  cylinder.points = static_cast<int>(inliers.indices.size());
  return cylinder;
}

void FitCylindersOf(const pcl::PointIndices& segment, int number, const Points::Ptr& points,
                    const Normals::Ptr& normals, double radius_m, std::vector<LeaoCylinder>& out) {
  Points::Ptr left(new Points(*points, segment.indices));
  Normals::Ptr left_normals(new Normals(*normals, segment.indices));
  const std::size_t least = std::max<std::size_t>(200, segment.indices.size() / 50);
  while (left->size() >= least) {
    pcl::SACSegmentationFromNormals<Point, pcl::Normal> ransac;
    ransac.setModelType(pcl::SACMODEL_CYLINDER);
    ransac.setMethodType(pcl::SAC_RANSAC);
    ransac.setNormalDistanceWeight(0.01);  // Radians against metres.
    ransac.setMaxIterations(1000);
    ransac.setDistanceThreshold(0.002);
    ransac.setRadiusLimits(radius_m - 0.0005, radius_m + 0.0005);
    ransac.setOptimizeCoefficients(true);
    ransac.setInputCloud(left);
    ransac.setInputNormals(left_normals);
    pcl::PointIndices::Ptr inliers(new pcl::PointIndices);
    pcl::ModelCoefficients model;
    ransac.segment(*inliers, model);
    if (inliers->indices.size() < least) break;
    out.push_back(MakeCylinder(*left, *inliers, model, number));
    pcl::ExtractIndices<Point> rest;
    rest.setInputCloud(left);
    rest.setIndices(inliers);
    rest.setNegative(true);
    Points::Ptr next(new Points);
    rest.filter(*next);
    pcl::ExtractIndices<pcl::Normal> rest_normals;
    rest_normals.setInputCloud(left_normals);
    rest_normals.setIndices(inliers);
    rest_normals.setNegative(true);
    Normals::Ptr next_normals(new Normals);
    rest_normals.filter(*next_normals);
    left = next;
    left_normals = next_normals;
  }
}

double Lap(std::chrono::steady_clock::time_point& last) {
  const auto now = std::chrono::steady_clock::now();
  const double ms = std::chrono::duration<double, std::milli>(now - last).count();
  last = now;
  return ms;
}

}  // namespace

TubeScene PlainPcl(const OrganizedCloud& cloud, const Part& part, const Bin& bin, int threads,
                   bool keep_short) {
  TubeScene scene;
  auto last = std::chrono::steady_clock::now();
  const Points::Ptr raw = RawCloud(cloud);
  const Points::Ptr points = FilterTubes(raw, bin);
  scene.timing_ms.filter = Lap(last);
  const Eigen::Vector3f eye = cloud.X_NS.translation().cast<float>();
  const Normals::Ptr normals = FindNormals(points, raw, eye, threads);
  const std::vector<pcl::PointIndices> segments = Segment(points, normals);
  scene.timing_ms.segment = Lap(last);
  std::vector<LeaoCylinder> cylinders;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    FitCylindersOf(segments[s], static_cast<int>(s), points, normals, part.radius_m, cylinders);
  }
  scene.timing_ms.fit = Lap(last);
  Leao2020Config limits;
  if (keep_short) limits.least_share_rigid = limits.least_share_hose = 0.0;
  const std::vector<ViewImage> depth = {MakeDepthImage(cloud, 0.0007)};
  const std::vector<LeaoTube> chains =
      JoinCylinders(cylinders, depth, part.radius_m, limits.longest_share * part.length_m, limits);
  scene.tubes = MakeLeaoTubes(chains, cylinders, part, limits);
  AssignClasses(scene, part.radius_m);
  scene.timing_ms.join = Lap(last);
  TubeScene::Timing& t = scene.timing_ms;
  t.total = t.filter + t.segment + t.fit + t.join;
  scene.threads = threads;
  return scene;
}

}  // namespace tubetwin
