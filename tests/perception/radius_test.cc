#include "perception/fragment/radius.h"

#include "perception/perceive.h"
#include "tests/support/catch.h"
#include "tests/support/toy_scanner.h"

namespace tubetwin {
namespace {

/// Windows of 3.5 mm flatten a tube's normals at its silhouettes: two per cent, and more
/// with axis points of a wrong radius.
constexpr double kExact = 0.04;

ToyScene ThreeTubes(double radius_m) {
  ToyScene scene;
  scene.radius_m = radius_m;
  scene.tubes_N = {{{-0.2, -0.1, radius_m}, {0.15, 0.1, radius_m}},
                   {{0.1, 0.2, radius_m}, {0.3, -0.15, radius_m}},
                   {{-0.3, 0.15, radius_m}, {0.0, 0.18, radius_m}}};
  return scene;
}

TubeScene SeeAs(const ToyScene& scene, double part_radius_m, double sigma_m) {
  ToyCamera camera;
  camera.width = 1200;
  camera.height = 900;
  camera.focal_px = 1000.0;
  camera.sigma_m = sigma_m;
  const RigidTransform X_NS = MakeTransform(RotX(kPi), Vector3(0, 0, 1.0));
  Part part;
  part.radius_m = part_radius_m;
  part.length_m = 0.4;
  return Perceive({ToyScan(scene, camera, X_NS, RandomStream(31, 0, "radius"))}, part, scene.bin,
                  PerceptionConfig{}, Parallelism{2});
}

TEST_CASE("The points tell the tubes' radius whatever the part says", "[unit]") {
  for (const double radius_m : {0.010, 0.0125, 0.016}) {
    const ToyScene scene = ThreeTubes(radius_m);
    for (const double factor : {0.6, 0.85, 1.0, 1.15, 1.6}) {
      const TubeScene seen = SeeAs(scene, factor * radius_m, 0.0001);
      INFO("radius " << radius_m << " m, the part says " << factor << " of it");
      REQUIRE(seen.radius_estimate_m.has_value());
      CHECK(*seen.radius_estimate_m == Approx(radius_m).epsilon(kExact));
      CHECK(seen.warnings.size() == (factor == 1.0 ? 0 : 1));
    }
  }
}

TEST_CASE("Three times the noise moves the estimate by a few per cent at most", "[unit]") {
  const TubeScene seen = SeeAs(ThreeTubes(0.0125), 0.0125, 0.0003);
  REQUIRE(seen.radius_estimate_m.has_value());
  CHECK(*seen.radius_estimate_m == Approx(0.0125).epsilon(0.05));
  CHECK(seen.warnings.empty());
}

TEST_CASE("An empty bin and a box tell no radius", "[unit]") {
  ToyScene scene;
  CHECK_FALSE(SeeAs(scene, 0.0125, 0.0001).radius_estimate_m.has_value());
  scene.boxes = {{{-0.1, 0.05, 0.0}, {0.1, 0.15, 0.04}}};
  const TubeScene seen = SeeAs(scene, 0.0125, 0.0001);
  CHECK_FALSE(seen.radius_estimate_m.has_value());
  CHECK(seen.warnings.empty());
}

TEST_CASE("The warning names both radii and begins beyond five per cent", "[unit]") {
  CHECK(RadiusWarning(0.0125, 0.0130).empty());
  CHECK(RadiusWarning(0.0125, 0.0120).empty());
  CHECK(RadiusWarning(0.0125, 0.0140) ==
        "the part's radius is 12.50 mm, the points say 14.00 mm: check radius_m of the part");
}

}  // namespace
}  // namespace tubetwin
