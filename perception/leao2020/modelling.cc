#include "perception/leao2020/modelling.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/random.h"
#include "models/base/step_timer.h"
#include "perception/fragment/axis_points.h"
#include "perception/leao2020/depth_image.h"
#include "perception/leao2020/tubes.h"
#include "perception/scene/bin_state.h"
#include "perception/scene/coverage.h"
#include "perception/scene/unexplained.h"

namespace tubetwin {
namespace {

/// Tubes lean out over the walls, but not by more than this share of their length.
constexpr double kOutside = 0.6;

/// What the filtering step leaves.
struct Filtered {
  std::vector<Eigen::Vector3f> all_N;     ///< Every point that is neither floor nor wall.
  std::vector<Eigen::Vector3f> chosen_N;  ///< The random ones, in the order of the scan.
  std::vector<int> view_of;               ///< Of each chosen point.
};

/// Draws `count` of the points without replacement (Knuth's selection sampling).
void Choose(const std::vector<int>& view_of_all, int count, RandomStream stream, Filtered& out) {
  std::size_t wanted = static_cast<std::size_t>(count);
  const std::size_t n = out.all_N.size();
  for (std::size_t i = 0; i < n && wanted > 0; ++i) {
    if (stream.Uniform() * static_cast<double>(n - i) >= static_cast<double>(wanted)) continue;
    out.chosen_N.push_back(out.all_N[i]);
    out.view_of.push_back(view_of_all[i]);
    --wanted;
  }
}

Filtered Filter(const std::vector<OrganizedCloud>& views, const Foreground& foreground,
                const Leao2020Config& config) {
  Filtered out;
  std::vector<int> view_of_all;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Eigen::Isometry3f X_NS = views[v].X_NS.cast<float>();
    for (const Eigen::Vector3f& p_SP : views[v].p_SP) {
      if (!IsValid(p_SP)) continue;
      const Eigen::Vector3f p_N = X_NS * p_SP;
      if (!foreground.Contains(p_N.x(), p_N.y(), p_N.z())) continue;
      out.all_N.push_back(p_N);
      view_of_all.push_back(static_cast<int>(v));
    }
  }
  Choose(view_of_all, config.points,
         RandomStream(static_cast<std::uint64_t>(config.seed), 0, "leao2020 points"), out);
  return out;
}

std::vector<ViewImage> DepthImages(const std::vector<OrganizedCloud>& clouds, double block_m,
                                   Parallelism parallelism) {
  std::vector<ViewImage> out(clouds.size());
  ParallelFor(static_cast<int>(clouds.size()), parallelism, [&](int i, int) {
    const auto k = static_cast<std::size_t>(i);
    out[k] = MakeDepthImage(clouds[k], block_m);
  });
  return out;
}

}  // namespace

TubeScene PerceiveLeao2020(const std::vector<OrganizedCloud>& views, const Part& part,
                           const Bin& bin, double block_m, const Leao2020Config& config,
                           Parallelism parallelism) {
  StepTimer timer;
  TubeScene scene;
  const std::vector<ViewImage> images = DepthImages(views, block_m, parallelism);
  const Filtered filtered = Filter(views, Foreground(bin, kOutside * part.length_m), config);
  scene.timing_ms.filter = timer.Lap();
  std::vector<Eigen::Vector3f> eyes_N;
  for (const OrganizedCloud& view : views) {
    eyes_N.push_back(view.X_NS.translation().cast<float>());
  }
  const bool raw = config.normals_from == "raw";
  const LeaoCloud cloud =
      EstimateNormals(filtered.chosen_N, raw ? filtered.all_N : filtered.chosen_N, filtered.view_of,
                      eyes_N, config, parallelism);
  const std::vector<std::vector<int>> segments = GrowRegions(cloud, config);
  scene.timing_ms.segment = timer.Lap();
  const std::vector<LeaoCylinder> cylinders =
      FitCylinders(cloud, segments, part.radius_m, config, parallelism);
  scene.timing_ms.fit = timer.Lap();
  const std::vector<LeaoTube> chains =
      JoinCylinders(cylinders, images, part.radius_m, config.longest_share * part.length_m, config);
  scene.timing_ms.join = timer.Lap();
  scene.tubes = MakeLeaoTubes(chains, cylinders, part, config);
  AssignClasses(scene, part.radius_m);
  const Coverage coverage = MeasureCoverage(images, bin, parallelism);
  scene.unseen_floor_m2 = coverage.unseen_floor_m2;
  scene.unseen_m3 = coverage.unseen_m3;
  scene.unseen_floor = coverage.unseen_floor;
  scene.unexplained_N = FindUnexplained(filtered.chosen_N, scene.tubes, part.radius_m);
  JudgeBinContent(scene, images, part, bin);
  scene.timing_ms.crossings = timer.Lap();
  TubeScene::Timing& t = scene.timing_ms;
  t.total = t.filter + t.segment + t.fit + t.join + t.crossings;
  scene.threads = parallelism.threads;
  return scene;
}

}  // namespace tubetwin
