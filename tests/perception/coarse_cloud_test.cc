#include "perception/view/coarse_cloud.h"

#include "models/base/error.h"
#include "perception/perceive.h"
#include "tests/support/catch.h"
#include "tests/support/toy_scanner.h"
#include "tests/support/tube_metrics.h"

namespace tubetwin {
namespace {

constexpr double kHeight_m = 0.9;

/// As a stereo camera over the bin: points 3 mm apart on its floor unless another pitch is asked
/// for.
ToyCamera CameraOf(double pitch_m, double sigma_m) {
  ToyCamera camera;
  camera.width = static_cast<int>(0.96 / pitch_m);
  camera.height = static_cast<int>(0.72 / pitch_m);
  camera.focal_px = kHeight_m / pitch_m;
  camera.sigma_m = sigma_m;
  return camera;
}

RigidTransform Above() { return MakeTransform(RotX(kPi), Vector3(0, 0, kHeight_m)); }

/// Eight straight pipes, three of them over the others.
ToyScene EightPipes() {
  ToyScene scene;
  scene.radius_m = 0.020;
  for (int i = 0; i < 5; ++i) {
    const double x = -0.28 + 0.14 * i;
    scene.tubes_N.push_back({{x, -0.2, 0.02}, {x + 0.02 * i, 0.2, 0.02}});
  }
  for (int i = 0; i < 3; ++i) {
    const double y = -0.15 + 0.15 * i;
    scene.tubes_N.push_back({{-0.2, y, 0.06}, {0.2, y + 0.02, 0.06}});
  }
  return scene;
}

Part PipeOf(double radius_m) {
  Part part;
  part.radius_m = radius_m;
  part.length_m = 0.4;
  return part;
}

TEST_CASE("Noise and spacing of a view are measured", "[unit]") {
  for (const double sigma_m : {0.0001, 0.001, 0.002}) {
    for (const double pitch_m : {0.001, 0.003}) {
      const OrganizedCloud cloud =
          ToyScan(EightPipes(), CameraOf(pitch_m, sigma_m), Above(), RandomStream(1, 0, "grain"));
      const ViewRaster raster = MakeViewRaster(cloud, 0.0007);
      const CloudGrain grain = MeasureGrain(raster);
      INFO(sigma_m << " " << pitch_m);
      CHECK(grain.spacing_m == Approx(pitch_m).epsilon(0.1));
      // The smoothest windows have a little less than all.
      CHECK(grain.noise_m < 1.05 * sigma_m);
      CHECK(grain.noise_m > 0.65 * sigma_m);
      CHECK(IsCoarse(grain, raster, 0.02) == (sigma_m >= 0.001));
    }
  }
}

TEST_CASE("Pipes are found in a stereo camera's cloud", "[unit]") {
  const ToyScene scene = EightPipes();
  for (const double sigma_m : {0.001, 0.002}) {
    const OrganizedCloud cloud =
        ToyScan(scene, CameraOf(0.003, sigma_m), Above(), RandomStream(2, 0, "stereo"));
    const TubeScene seen =
        Perceive({cloud}, PipeOf(scene.radius_m), scene.bin, PerceptionConfig{}, Parallelism{2});
    const TubeScore score =
        ScoreTubes(seen, scene.tubes_N, TubePointsOf({cloud}, {Above()}, 1), scene.radius_m);
    INFO(sigma_m << ": " << seen.tubes.size() << " tubes, " << score.found << " found, median "
                 << score.centerline_median_m);
    CHECK(score.found >= 7);
    CHECK(seen.tubes.size() <= 10);
    CHECK(score.centerline_median_m < 0.0015);
    REQUIRE_FALSE(seen.warnings.empty());
    CHECK_THAT(seen.warnings.back(), Catch::Contains("of noise were smoothed before modelling"));
  }
}

TEST_CASE("Smoothing keeps the surface and does not depend on the threads", "[unit]") {
  const OrganizedCloud cloud =
      ToyScan(EightPipes(), CameraOf(0.003, 0.0015), Above(), RandomStream(3, 0, "smooth"));
  const ViewRaster raster = MakeViewRaster(cloud, 0.0007);
  const CloudGrain grain = MeasureGrain(raster);
  const OrganizedCloud one = SmoothCoarse(raster, grain, 0.02, Parallelism{1});
  const OrganizedCloud two = SmoothCoarse(raster, grain, 0.02, Parallelism{2});
  REQUIRE(one.size() == two.size());
  CHECK(one.width >= 2 * cloud.width);
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const bool same =
        one.p_SP[i] == two.p_SP[i] || (!IsValid(one.p_SP[i]) && !IsValid(two.p_SP[i]));
    if (!same) FAIL("pixel " << i << " depends on the threads");
    if (!IsValid(one.p_SP[i])) continue;
    const Vector3 p_N = one.X_NS * one.p_SP[i].cast<double>();
    // The floor, away from pipes and walls.
    if (p_N.x() > -0.36 && p_N.x() < -0.31 && std::abs(p_N.y()) < 0.25) {
      squares += p_N.z() * p_N.z();
      ++count;
    }
  }
  REQUIRE(count > 1000);
  CHECK(std::sqrt(squares / count) < 0.0007);  // Of 1.5 mm.
}

TEST_CASE("A cloud too coarse for the tubes is refused with what would do", "[unit]") {
  const ToyScene scene = EightPipes();
  const OrganizedCloud cloud =
      ToyScan(scene, CameraOf(0.003, 0.002), Above(), RandomStream(4, 0, "coarse"));
  PerceptionConfig config;
  CHECK_THROWS_WITH(Perceive({cloud}, PipeOf(0.006), scene.bin, config, Parallelism{2}),
                    Catch::Contains("are too coarse for tubes of 6.0 mm radius: the profile best "
                                    "needs 2.4 mm and 1.2 mm; use --profile leao2020"));
  config.profile = "leao2020";
  CHECK_NOTHROW(Perceive({cloud}, PipeOf(0.006), scene.bin, config, Parallelism{2}));
}

}  // namespace
}  // namespace tubetwin
