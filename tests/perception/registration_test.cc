#include "perception/view/registration.h"

#include "perception/perceive.h"
#include "tests/support/catch.h"
#include "tests/support/toy_scanner.h"
#include "tests/support/tube_metrics.h"

namespace tubetwin {
namespace {

/// A hundred points per plane with noise of 0.1 mm, and what each view may be off by on its own.
constexpr double kShift_m = 0.00006;
const double kTurn_rad = Radians(0.012);

/// Floor, walls and three tubes from the cell's eight poses; the poses that are believed miss the
/// true ones by X_SbelievedS, the same for all.
struct SceneInViews {
  ToyScene scene;
  std::vector<OrganizedCloud> clouds;
  std::vector<RigidTransform> X_NS_true;
};

SceneInViews LookWith(const RigidTransform& X_SbelievedS) {
  SceneInViews out;
  out.scene.tubes_N = {{{-0.3, -0.1, 0.0125}, {0.15, 0.1, 0.0125}},
                       {{-0.2, 0.15, 0.0125}, {0.2, -0.15, 0.0375}},
                       {{0.1, 0.2, 0.0125}, {0.3, -0.2, 0.0125}}};
  ToyCamera camera;
  camera.width = 516;
  camera.height = 386;
  camera.focal_px = 633.5;
  const RandomStream stream(21, 0, "registration");
  for (const RigidTransform& X_NS : EightPoses()) {
    out.clouds.push_back(ToyScan(out.scene, camera, X_NS, stream.Fork("noise", out.clouds.size())));
    out.clouds.back().X_NS = X_NS * X_SbelievedS.inverse();
    out.X_NS_true.push_back(X_NS);
  }
  return out;
}

std::vector<ViewRaster> RastersOf(const std::vector<OrganizedCloud>& clouds) {
  std::vector<ViewRaster> out;
  for (const OrganizedCloud& cloud : clouds) out.push_back(MakeViewRaster(cloud, 0.0007));
  return out;
}

double Turn(const RigidTransform& X) { return Eigen::AngleAxisd(X.linear()).angle(); }

const RigidTransform kHandEye =
    MakeTransform(RotX(Radians(0.06)) * RotY(Radians(-0.09)) * RotZ(Radians(0.05)),
                  Vector3(0.0003, -0.0004, 0.0002));

TEST_CASE("Floor and walls tell the hand-eye error of eight views", "[unit]") {
  for (const RigidTransform& X_SbelievedS :
       {RigidTransform(RigidTransform::Identity()), kHandEye}) {
    const SceneInViews look = LookWith(X_SbelievedS);
    const Registration found = RegisterViews(RastersOf(look.clouds), look.scene.bin, {2});
    REQUIRE(found.points > 1000);
    CHECK(found.after_m < 0.00012);
    for (const RigidTransform& X : found.X_SbelievedS) {
      const RigidTransform rest = X_SbelievedS.inverse() * X;
      CHECK(rest.translation().norm() < kShift_m);
      CHECK(Turn(rest) < kTurn_rad);
    }
  }
}

TEST_CASE("Registration takes a hand-eye error out of the centerlines and harms none without",
          "[unit]") {
  Part part;
  part.length_m = 0.50;
  const auto median_m = [&part](const SceneInViews& look, bool register_views) {
    PerceptionConfig config;
    config.register_views = register_views;
    const TubeScene seen = Perceive(look.clouds, part, look.scene.bin, config, Parallelism{2});
    return ScoreTubes(seen, look.scene.tubes_N, TubePointsOf(look.clouds, look.X_NS_true, 17),
                      look.scene.radius_m)
        .centerline_median_m;
  };
  const SceneInViews exact = LookWith(RigidTransform::Identity());
  CHECK(median_m(exact, true) < median_m(exact, false) + 0.00002);
  const SceneInViews off = LookWith(kHandEye);
  CHECK(median_m(off, false) > 0.0003);
  CHECK(median_m(off, true) < 0.00008);
}

TEST_CASE("What nothing in the views shows stays as it is believed", "[unit]") {
  ToyScene scene;
  ToyCamera camera;
  camera.width = 400;
  camera.height = 300;
  camera.focal_px = 800.0;
  const RigidTransform X_NS = LookDown({0, 0, 0.5});  // Sees nothing but floor.
  std::vector<OrganizedCloud> clouds = {
      ToyScan(scene, camera, X_NS, RandomStream(22, 0, "registration"))};
  clouds[0].X_NS =
      MakeTransform(X_NS.linear(), X_NS.translation() + Vector3(0.0005, 0.0005, 0.0008));
  const Registration found = RegisterViews(RastersOf(clouds), scene.bin, {1});
  REQUIRE(found.points > 0);
  const RigidTransform X_NS_found = clouds[0].X_NS * found.X_SbelievedS[0];
  CHECK(X_NS_found.translation().z() == Approx(0.5).margin(kShift_m));
  CHECK((X_NS_found.translation() - clouds[0].X_NS.translation()).head<2>().norm() < 0.00002);
}

TEST_CASE("Views without floor and walls, or with a floor out of reach, are not corrected",
          "[unit]") {
  const SceneInViews look = LookWith(RigidTransform::Identity());
  std::vector<OrganizedCloud> clouds = look.clouds;
  for (OrganizedCloud& cloud : clouds) cloud.X_NS.translation().z() += 0.05;
  const Registration far = RegisterViews(RastersOf(clouds), look.scene.bin, {2});
  for (OrganizedCloud& cloud : clouds) {
    std::fill(cloud.p_SP.begin(), cloud.p_SP.end(), InvalidPoint());
  }
  const Registration blind = RegisterViews(RastersOf(clouds), look.scene.bin, {2});
  for (const Registration& r : {far, blind}) {
    CHECK(r.points == 0);
    for (const RigidTransform& X : r.X_SbelievedS) CHECK(X.isApprox(RigidTransform::Identity()));
  }
}

}  // namespace
}  // namespace tubetwin
