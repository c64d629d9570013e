#include "models/base/error.h"
#include "models/base/json.h"
#include "perception/leao2020/modelling.h"
#include "perception/leao2020/tubes.h"
#include "perception/perceive.h"
#include "tests/support/catch.h"
#include "tests/support/toy_scanner.h"
#include "tests/support/tube_metrics.h"

namespace tubetwin {
namespace {

constexpr double kRadius_m = 0.0125;

Part Tube50() {
  Part part;
  part.radius_m = kRadius_m;
  part.length_m = 0.5;
  return part;
}

/// One view from 1 m that shows the whole bin; 1.3 mm pitch keeps the tests quick.
OrganizedCloud Overhead(const ToyScene& scene) {
  ToyCamera camera;
  camera.width = 700;
  camera.height = 540;
  camera.focal_px = 760.0;
  const RigidTransform X_NS = MakeTransform(RotX(kPi), Vector3(0, 0, 1.0));
  return ToyScan(scene, camera, X_NS, RandomStream(4, 0, "leao"));
}

PerceptionConfig Leao() {
  PerceptionConfig config;
  config.profile = "leao2020";
  config.leao2020.least_points = 60;  // The image has a tenth of the scanner's pixels.
  return config;
}

TubeScene See(const ToyScene& scene, const PerceptionConfig& config, int threads = 2) {
  return Perceive({Overhead(scene)}, Tube50(), scene.bin, config, {threads});
}

/// Two straight tubes, the second over the middle of the first.
ToyScene Cross() {
  ToyScene scene;
  scene.tubes_N = {{{-0.25, 0, kRadius_m}, {0.25, 0, kRadius_m}},
                   {{0.01, -0.25, 3 * kRadius_m}, {0.01, 0.25, 3 * kRadius_m}}};
  return scene;
}

LeaoCylinder Cylinder(const Vector3& from, const Vector3& to, int segment = 0) {
  LeaoCylinder cylinder;
  cylinder.end_N = {from, to};
  cylinder.segment = segment;
  cylinder.points = 1000;
  return cylinder;
}

/// A depth image that is everywhere nearer than any axis below 0.1 m: no gap can be seen.
std::vector<ViewImage> Blind() {
  ViewImage view;
  view.width = 100;
  view.height = 100;
  view.pitch_m = 0.01;
  view.fx = view.fy = 100;
  view.cx = view.cy = 49.5;
  view.X_NS = MakeTransform(RotX(kPi), Vector3(0, 0, 1.0));
  view.X_SN = view.X_NS.inverse();
  view.z_near.assign(10000, 0.85f);
  view.z_far = view.z_near;
  return {view};
}

std::vector<LeaoTube> Join(const std::vector<LeaoCylinder>& cylinders,
                           const std::vector<ViewImage>& views = Blind()) {
  return JoinCylinders(cylinders, views, kRadius_m, 0.5, Leao2020Config());
}

TEST_CASE("Two crossed tubes are found, the lower one joined under the upper", "[unit]") {
  const ToyScene scene = Cross();
  const TubeScene seen = See(scene, Leao());
  REQUIRE(seen.tubes.size() == 2);
  OrganizedCloud cloud = Overhead(scene);
  const TubeScore score =
      ScoreTubes(seen, scene.tubes_N, TubePointsOf({cloud}, {cloud.X_NS}, 7), kRadius_m);
  CHECK(score.found == 2);
  CHECK(score.class_right == 2);
  CHECK(score.centerline_median_m < 0.0005);  // RANSAC with 0.1 mm noise.
  for (const PerceivedTube& tube : seen.tubes) {
    REQUIRE(tube.class_paper);
    CHECK(*tube.class_paper == tube.tube_class);  // One occluded joint, one crossing.
    CHECK(tube.length_m == Approx(0.5).margin(0.02));
    CHECK((tube.visible_fraction < 1.0) == (*tube.class_paper == TubeClass::kWeak));
  }
  CHECK(seen.crossings.size() == 1);
}

TEST_CASE("A hose's bend is whole only when joints may turn more than 30 degrees", "[unit]") {
  constexpr double kBend_m = 0.05, kHose_m = 0.010;
  ToyScene scene;
  scene.radius_m = kHose_m;
  Polyline line = {{-0.15, 0, kHose_m}};
  for (int deg = 0; deg <= 150; deg += 5) {
    const double a = Radians(deg);
    line.push_back({kBend_m * std::sin(a), kBend_m * (1 - std::cos(a)), kHose_m});
  }
  line.push_back(line.back() + 0.12 * Vector3(std::cos(Radians(150)), std::sin(Radians(150)), 0));
  scene.tubes_N = {line};
  ToyCamera camera;
  camera.sigma_m = 0.0003;  // The scanner's at 0.8 m.
  const OrganizedCloud cloud =
      ToyScan(scene, camera, MakeTransform(RotX(kPi), Vector3(0, 0, 0.8)), RandomStream(4, 0, "b"));
  Part part;
  part.radius_m = kHose_m;
  part.length_m = Length(line);
  PerceptionConfig config;
  config.profile = "leao2020";
  CHECK(Perceive({cloud}, part, scene.bin, config, {2}).tubes.empty());
  config.leao2020.join_distance_m = 0.05;
  config.leao2020.join_angle_deg = 70.0;
  const TubeScene seen = Perceive({cloud}, part, scene.bin, config, {2});
  REQUIRE(seen.tubes.size() == 1);
  CHECK(seen.tubes[0].length_m == Approx(part.length_m).margin(0.03));  // Chords cut the bend.
  CHECK(seen.unexplained_N.size() < 30);
}

TEST_CASE("The paper's class survives writing and reading, and only that profile writes it",
          "[unit]") {
  const Json written = ToJson(See(Cross(), Leao()));
  int weak = 0;
  for (const Json& tube : written["tubes"]) weak += tube["class_paper"] == "weak";
  CHECK(weak == 1);
  const TubeScene again = TubeSceneFromJson(JsonView(written, "tubes.json"));
  CHECK(ToJson(again) == written);
  const Json best = ToJson(See(Cross(), PerceptionConfig()));
  REQUIRE(best["tubes"].size() == 2);
  CHECK_FALSE(best["tubes"][0].contains("class_paper"));
}

TEST_CASE("The paper's profile gives the same tubes for one and for two threads", "[unit]") {
  Json one = ToJson(See(Cross(), Leao(), 1)), two = ToJson(See(Cross(), Leao(), 2));
  for (Json* json : {&one, &two}) {
    json->erase("timing_ms");
    json->erase("threads");
  }
  CHECK(one == two);
}

TEST_CASE("An empty bin and a cloud without returns hold no tube", "[unit]") {
  CHECK(See(ToyScene(), Leao()).tubes.empty());
  OrganizedCloud cloud;
  cloud.width = 40;
  cloud.height = 30;
  cloud.p_SP.assign(1200, InvalidPoint());
  cloud.X_NS = MakeTransform(RotX(kPi), Vector3(0, 0, 1.0));
  CHECK(Perceive({cloud}, Tube50(), Bin(), Leao(), {}).tubes.empty());
  cloud.X_NS.translation().x() = std::nan("");
  CHECK_THROWS_WITH(Perceive({cloud}, Tube50(), Bin(), Leao(), {}),
                    Catch::Contains("pose is not finite"));
}

TEST_CASE("Ends are joined up to 3 cm apart, not farther", "[unit]") {
  const auto apart = [](double gap_m) {
    return Join({Cylinder({-0.2, 0, 0.02}, {0, 0, 0.02}),
                 Cylinder({gap_m, 0, 0.02}, {gap_m + 0.2, 0, 0.02})})
        .size();
  };
  CHECK(apart(0.0299) == 1);
  CHECK(apart(0.0301) == 2);
}

TEST_CASE("Ends are joined over a turn of up to 30 degrees, not more", "[unit]") {
  const auto turned = [](double angle_deg) {
    const Vector3 way(std::cos(Radians(angle_deg)), std::sin(Radians(angle_deg)), 0);
    const Vector3 start(0.02, 0, 0.02);
    return Join({Cylinder({-0.2, 0, 0.02}, {0, 0, 0.02}), Cylinder(start, start + 0.2 * way)})
        .size();
  };
  CHECK(turned(29.9) == 1);
  CHECK(turned(30.1) == 2);
}

TEST_CASE("Neighbours on a bend that overlap are joined, tubes side by side are not", "[unit]") {
  const Vector3 way(std::cos(0.3), std::sin(0.3), 0);
  CHECK(Join({Cylinder({-0.2, 0, 0.02}, {0, 0, 0.02}),
              Cylinder({-0.018, 0.002, 0.02}, Vector3(-0.018, 0.002, 0.02) + 0.2 * way)})
            .size() == 1);
  CHECK(Join({Cylinder({-0.2, 0, 0.02}, {0, 0, 0.02}),
              Cylinder({-0.01, 2 * kRadius_m, 0.02}, {0.19, 2 * kRadius_m, 0.02})})
            .size() == 2);
}

TEST_CASE("Of two possible partners the cheaper one is joined, a degree costs 2 mm", "[unit]") {
  // 4 mm farther away, but 5 degrees (10 mm) less turned.
  const Vector3 bent(std::cos(Radians(5)), std::sin(Radians(5)), 0);
  const Vector3 near(0.014, 0, 0.02);
  const std::vector<LeaoTube> tubes =
      Join({Cylinder({-0.1, 0, 0.02}, {0, 0, 0.02}), Cylinder(near, near + 0.1 * bent),
            Cylinder({0.018, 0, 0.02}, {0.12, 0, 0.02})});
  REQUIRE(tubes.size() == 2);
  CHECK(tubes[0].ends == std::vector<int>{0, 4});
  CHECK(tubes[1].ends == std::vector<int>{2});
}

TEST_CASE("A gap that the view looks through is not joined", "[unit]") {
  const std::vector<LeaoCylinder> pieces = {Cylinder({-0.2, 0, 0.02}, {0, 0, 0.02}, 0),
                                            Cylinder({0.02, 0, 0.02}, {0.2, 0, 0.02}, 1)};
  std::vector<ViewImage> views = Blind();
  CHECK(Join(pieces, views).size() == 1);
  views[0].z_near.assign(10000, 1.0f);  // The floor.
  CHECK(Join(pieces, views).size() == 2);
  views[0].z_near.assign(10000, std::nanf(""));  // No return is no proof.
  CHECK(Join(pieces, views).size() == 2);
  CHECK(Join(pieces, {Blind()[0], views[0]}).size() == 1);
}

TEST_CASE("Tubes grow no longer than their limit", "[unit]") {
  CHECK(Join({Cylinder({-0.3, 0, 0.02}, {0, 0, 0.02}), Cylinder({0.01, 0, 0.02}, {0.19, 0, 0.02})})
            .size() == 1);
  CHECK(Join({Cylinder({-0.3, 0, 0.02}, {0, 0, 0.02}), Cylinder({0.01, 0, 0.02}, {0.21, 0, 0.02})})
            .size() == 2);
}

TEST_CASE("Tubes shorter than Table 2 allows are discarded", "[unit]") {
  const auto kept = [](double length_m, const char* kind, double part_m) {
    Part part = Tube50();
    part.kind = kind;
    part.length_m = part_m;
    const std::vector<LeaoCylinder> one = {Cylinder({0, 0, 0.02}, {length_m, 0, 0.02})};
    return MakeLeaoTubes(Join(one), one, part, Leao2020Config()).size();
  };
  CHECK(kept(0.351, "rigid", 0.50) == 1);
  CHECK(kept(0.349, "rigid", 0.50) == 0);
  CHECK(kept(0.301, "hose", 0.40) == 1);
  CHECK(kept(0.299, "hose", 0.40) == 0);
}

TEST_CASE("Joints between segments are occlusions and decide the paper's class", "[unit]") {
  const auto class_of = [](const std::vector<int>& segments) {
    std::vector<LeaoCylinder> pieces;
    for (std::size_t k = 0; k < segments.size(); ++k) {
      const double x = -0.2 + 0.13 * static_cast<double>(k);
      pieces.push_back(Cylinder({x, 0, 0.02}, {x + 0.12, 0, 0.02}, segments[k]));
    }
    const std::vector<PerceivedTube> tubes =
        MakeLeaoTubes(Join(pieces), pieces, Tube50(), Leao2020Config());
    REQUIRE(tubes.size() == 1);
    return *tubes[0].class_paper;
  };
  CHECK(class_of({0, 0, 0}) == TubeClass::kFree);
  CHECK(class_of({0, 0, 1}) == TubeClass::kWeak);
  CHECK(class_of({0, 1, 2}) == TubeClass::kStrong);
  CHECK(class_of({0, 1, 0}) == TubeClass::kStrong);
}

}  // namespace
}  // namespace tubetwin
