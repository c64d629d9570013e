#include "perception/perceive.h"

#include <cstdio>

#include "models/base/error.h"
#include "models/base/step_timer.h"
#include "perception/fragment/axis_points.h"
#include "perception/fragment/axis_space.h"
#include "perception/fragment/fragments.h"
#include "perception/fragment/radius.h"
#include "perception/joining/assemble.h"
#include "perception/joining/bridges.h"
#include "perception/joining/joining.h"
#include "perception/joining/occluded_extension.h"
#include "perception/leao2020/modelling.h"
#include "perception/scene/bin_state.h"
#include "perception/scene/coverage.h"
#include "perception/scene/unexplained.h"
#include "perception/view/coarse_cloud.h"
#include "perception/view/registration.h"
#include "perception/view/view_raster.h"

namespace tubetwin {
namespace {

/// Tubes lean out over the walls, but not by more than this share of their length.
constexpr double kOutside = 0.6;
/// Longest gap that is bridged, as a share of the tube's length.
constexpr double kLongestGap = 0.65;

struct Surface {
  std::vector<OrganizedCloud> smoothed;  ///< Of coarse views.
  std::string grain;                     ///< What a user should know of them; empty: none.
  Registration registration;
  std::vector<ViewImage> views;
  std::vector<SurfacePoint> points;
  std::vector<Eigen::Vector3f> rejected_N;
};

/// Puts a smoothed view in the place of each coarse one. Throws Error(kBadData) for one that is too
/// coarse for that.
void SmoothCoarseViews(std::vector<ViewRaster>& rasters, double radius_m, double pitch_m,
                       Parallelism parallelism, Surface& out) {
  out.smoothed.resize(rasters.size());
  for (std::size_t k = 0; k < rasters.size(); ++k) {
    const CloudGrain grain = MeasureGrain(rasters[k]);
    if (!IsCoarse(grain, rasters[k], radius_m)) continue;
    const std::string view = rasters.size() > 1 ? "view " + std::to_string(k) + ": " : "";
    const std::string why = TooCoarse(grain, radius_m);
    if (!why.empty()) throw Error(ErrorKind::kBadData, "perception: " + view + why);
    out.smoothed[k] = SmoothCoarse(rasters[k], grain, radius_m, parallelism);
    rasters[k] = MakeViewRaster(out.smoothed[k], pitch_m);
    char text[120];
    std::snprintf(text, sizeof text,
                  "points %.1f mm apart with %.1f mm of noise were smoothed before modelling",
                  1e3 * grain.spacing_m, 1e3 * grain.noise_m);
    if (out.grain.empty()) out.grain = view + text;
  }
}

Surface ExtractSurface(const std::vector<OrganizedCloud>& clouds, const Part& part, const Bin& bin,
                       const PerceptionConfig& config, Parallelism parallelism) {
  const double pitch_m = std::min(config.block_m, 0.07 * part.radius_m);
  std::vector<ViewRaster> rasters(clouds.size());
  Surface out;
  out.views.resize(clouds.size());
  ParallelFor(static_cast<int>(clouds.size()), parallelism, [&](int i, int) {
    const auto k = static_cast<std::size_t>(i);
    rasters[k] = MakeViewRaster(clouds[k], pitch_m);
  });
  SmoothCoarseViews(rasters, part.radius_m, pitch_m, parallelism, out);
  if (config.register_views) out.registration = RegisterViews(rasters, bin, parallelism);
  for (std::size_t k = 0; k < rasters.size(); ++k) {
    if (config.register_views) rasters[k].X_NS = rasters[k].X_NS * out.registration.X_SbelievedS[k];
    out.views[k] = MakeEmptyImage(rasters[k]);
  }
  std::vector<std::pair<std::size_t, int>> bands;  // View, band.
  for (std::size_t k = 0; k < rasters.size(); ++k) {
    const int rows = rasters[k].block_rows();
    for (int b = 0; b * kRowsPerBand < rows; ++b) bands.emplace_back(k, b);
  }
  const Foreground foreground(bin, kOutside * part.length_m);
  std::vector<SurfaceOfView> of_band(bands.size());
  ParallelFor(static_cast<int>(bands.size()), parallelism, [&](int i, int) {
    const auto [k, band] = bands[static_cast<std::size_t>(i)];
    of_band[static_cast<std::size_t>(i)] =
        ExtractSurfaceBand(rasters[k], foreground, part.radius_m, band, out.views[k]);
  });
  std::size_t points = 0, rejected = 0;
  for (const SurfaceOfView& s : of_band) {
    points += s.points.size();
    rejected += s.rejected_N.size();
  }
  out.points.reserve(points);
  out.rejected_N.reserve(rejected);
  for (const SurfaceOfView& s : of_band) {
    out.points.insert(out.points.end(), s.points.begin(), s.points.end());
    out.rejected_N.insert(out.rejected_N.end(), s.rejected_N.begin(), s.rejected_N.end());
  }
  return out;
}

}  // namespace

void PerceptionConfig::Visit(ConfigVisitor& v) {
  v.Choice("profile", "Method of modelling.", profile, {"best", "leao2020"});
  v.Field("block_m", "Side of the pixel blocks that are averaged first.", block_m, {0.0001, 0.005});
  v.Field("register_views", "Correct the believed poses by the floor and walls that are seen.",
          register_views);
  v.Section("leao2020", "The profile leao2020.", leao2020);
}

namespace {

/// Compares the radius and the poses that were given with what the points say.
void AddWarnings(const Surface& surface, const std::vector<Fragment>& fragments,
                 double part_radius_m, Parallelism parallelism, TubeScene& scene) {
  scene.radius_estimate_m =
      scene.tubes.empty() ? SearchRadius(surface.points, parallelism) : EstimateRadius(fragments);
  if (scene.radius_estimate_m) {
    const std::string text = RadiusWarning(part_radius_m, *scene.radius_estimate_m);
    if (!text.empty()) scene.warnings.push_back(text);
  }
  const std::string text = RegistrationWarning(surface.registration);
  if (!text.empty()) scene.warnings.push_back(text);
  if (!surface.grain.empty()) scene.warnings.push_back(surface.grain);
}

}  // namespace

TubeScene Perceive(const std::vector<OrganizedCloud>& views, const Part& part, const Bin& bin,
                   const PerceptionConfig& config, Parallelism parallelism) {
  if (views.empty()) throw Error(ErrorKind::kBadData, "perception: no cloud was given");
  if (config.profile == "leao2020") {
    return PerceiveLeao2020(views, part, bin, config.block_m, config.leao2020, parallelism);
  }
  StepTimer timer;
  TubeScene scene;
  const Surface surface = ExtractSurface(views, part, bin, config, parallelism);
  scene.timing_ms.filter = timer.Lap();
  const AxisSpace axis_space = BuildAxisSpace(surface.points, parallelism);
  scene.timing_ms.segment = timer.Lap();
  const std::vector<Fragment> fragments =
      FindFragments(axis_space, surface.points, part.radius_m, parallelism);
  scene.timing_ms.fit = timer.Lap();
  const OccludedSpace hidden(surface.views, bin, part.radius_m);
  const std::vector<Bridge> bridges = FindBridges(fragments, hidden, kLongestGap * part.length_m);
  const std::vector<double> max_extensions_m =
      MaxOccludedExtensions(fragments, hidden, part.length_m);
  const std::vector<Chain> chains =
      JoinFragments(fragments, bridges, max_extensions_m, part.length_m);
  scene.tubes = AssembleTubes(chains, fragments, bridges, hidden, bin, part.length_m);
  scene.timing_ms.join = timer.Lap();
  AssignClasses(scene, part.radius_m);
  const Coverage coverage = MeasureCoverage(surface.views, bin, parallelism);
  scene.unseen_floor_m2 = coverage.unseen_floor_m2;
  scene.unseen_m3 = coverage.unseen_m3;
  std::vector<Eigen::Vector3f> points_N;
  points_N.reserve(surface.points.size() + surface.rejected_N.size());
  for (const SurfacePoint& p : surface.points) points_N.push_back(p.p_N);
  points_N.insert(points_N.end(), surface.rejected_N.begin(), surface.rejected_N.end());
  scene.unseen_floor = coverage.unseen_floor;
  scene.unexplained_N = FindUnexplained(points_N, scene.tubes, part.radius_m);
  JudgeBinContent(scene, surface.views, part, bin);
  AddWarnings(surface, fragments, part.radius_m, parallelism, scene);
  scene.timing_ms.crossings = timer.Lap();
  TubeScene::Timing& t = scene.timing_ms;
  t.total = t.filter + t.segment + t.fit + t.join + t.crossings;
  scene.threads = parallelism.threads;
  return scene;
}

}  // namespace tubetwin
