#include "perception/perceive.h"

#include "models/base/error.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/toy_scanner.h"
#include "tests/support/tube_metrics.h"

namespace tubetwin {
namespace {

/// Half the scanner's default resolution: 0.8 mm pitch, four times faster to cast.
ToyCamera QuickCamera() {
  ToyCamera camera;
  camera.width = 516;
  camera.height = 386;
  camera.focal_px = 633.5;
  camera.baseline_m = 0.235;
  return camera;
}

/// The camera of the public set's judge: one view from 1.1 m.
ToyCamera OverheadCamera() {
  ToyCamera camera;
  camera.width = 1920;
  camera.height = 1200;
  camera.focal_px = 1373.0;
  return camera;
}

RigidTransform OverheadPose() { return MakeTransform(RotX(kPi), Vector3(0, 0, 1.1)); }

struct Look {
  std::vector<OrganizedCloud> clouds;
  std::vector<RigidTransform> X_NS_true;
};

/// Eight views whose believed poses are off by the cell's hand-eye error.
Look EightViews(const ToyScene& scene, std::uint64_t seed) {
  Look look;
  const RandomStream stream(seed, 0, "eight views");
  for (const RigidTransform& X_NS : EightPoses()) {
    const auto k = look.clouds.size();
    look.clouds.push_back(ToyScan(scene, QuickCamera(), X_NS, stream.Fork("noise", k)));
    RandomStream error = stream.Fork("hand-eye", k);
    look.clouds.back().X_NS = Disturbed(X_NS, 0.0003, Radians(0.05), error);
    look.X_NS_true.push_back(X_NS);
  }
  return look;
}

Part TubeOf(double radius_m, double length_m) {
  Part part;
  part.radius_m = radius_m;
  part.length_m = length_m;
  return part;
}

TubeScene See(const ToyScene& scene, const Look& look, double length_m, int threads = 2) {
  return Perceive(look.clouds, TubeOf(scene.radius_m, length_m), scene.bin, PerceptionConfig{},
                  Parallelism{threads});
}

/// A bend of `angle` and radius `bend_m` in a plane turned by `tilt` about the start's x axis.
void AppendArc(Polyline& line, Vector3& heading, const Vector3& axis, double bend_m, double angle) {
  const int pieces = 16;
  for (int i = 0; i < pieces; ++i) {
    heading = Eigen::AngleAxisd(angle / pieces, axis) * heading;
    line.push_back(line.back() + bend_m * angle / pieces * heading);
  }
}

/// A hose of 0.40 m with a bend of `angle` and radius 50 mm at each end, flat in the plane z.
Polyline Hook(const Vector3& start, double yaw, double angle, double turn_sign) {
  Polyline line{start};
  Vector3 heading = RotZ(yaw) * Vector3::UnitX();
  const double arc = 0.05 * angle;
  AppendArc(line, heading, Vector3::UnitZ(), 0.05, angle);
  line.push_back(line.back() + (0.40 - 2 * arc) * heading);
  AppendArc(line, heading, turn_sign * Vector3::UnitZ(), 0.05, angle);
  return line;
}

Polyline Straight(const Vector3& centre, double yaw, double length_m) {
  const Vector3 half = RotZ(yaw) * Vector3(0.5 * length_m, 0, 0);
  return {centre - half, centre + half};
}

/// Lifts the part of a line within `reach_m` of another's foot so that it passes over it by two
/// radii: a smooth hump.
Polyline Over(const Polyline& line, const Polyline& under, double radius_m) {
  Polyline out = Resample(line, 0.005);
  for (Vector3& p : out) {
    const double d = (Closest(under, p).point - p).head<2>().norm();
    p.z() += 2.2 * radius_m * std::exp(-d * d / (2 * 0.03 * 0.03));
  }
  return out;
}

TEST_CASE("Tubes of the public piles are found from one view above", "[unit]") {
  int tubes = 0, found = 0, paired = 0, right = 0;
  for (const char* name : {"A5_2", "B5_2", "B7_2"}) {
    ToyScene scene;
    scene.tubes_N = ReadPublicPile(name);
    if (scene.tubes_N.empty()) {
      WARN("public piles are not here (../shared/data/leao2022): " << name << " is skipped");
      continue;
    }
    scene.bin.size_m = {0.80, 0.60, 0.20};
    Look look;
    look.X_NS_true.push_back(OverheadPose());
    look.clouds.push_back(
        ToyScan(scene, OverheadCamera(), OverheadPose(), RandomStream(3, 0, "noise")));
    const TubeScene seen = See(scene, look, 0.50);
    const TubeScore score =
        ScoreTubes(seen, scene.tubes_N, TubePointsOf(look.clouds, look.X_NS_true, 29), 0.0125);
    INFO(name << " found " << score.found << " of " << score.true_tubes);
    CHECK(score.micro_recall >= 0.97);
    CHECK(score.predicted == score.true_tubes);
    CHECK(score.covered_called_free == 0);
    CHECK(score.centerline_median_m < 0.0003);
    CHECK(score.centerline_p95_m < 0.003);
    tubes += score.true_tubes;
    found += score.found;
    paired += score.paired;
    right += score.class_right;
  }
  CHECK(found >= 0.9 * tubes);
  CHECK(right >= 0.95 * paired);
}

TEST_CASE("Two hooked hoses are told apart from eight views with hand-eye error", "[unit]") {
  ToyScene scene;
  scene.radius_m = 0.010;
  const Polyline first = Hook({-0.15, -0.05, 0.010}, 0.3, Radians(120), 1.0);
  const Polyline second = Hook({-0.05, -0.12, 0.010}, 1.4, Radians(100), -1.0);
  scene.tubes_N = {first, Over(second, first, 0.010)};
  const Look look = EightViews(scene, 5);
  const TubeScene seen = See(scene, look, Length(scene.tubes_N[1]));
  const TubeScore score =
      ScoreTubes(seen, scene.tubes_N, TubePointsOf(look.clouds, look.X_NS_true, 17), 0.010);
  CHECK(score.found == 2);
  CHECK(score.predicted == 2);
  CHECK(score.micro_recall >= 0.97);
  CHECK(score.class_right == 2);
  CHECK(score.centerline_p95_m < 0.003);
}

TEST_CASE("An empty bin holds no tube and nothing unexplained", "[unit]") {
  const ToyScene scene;
  const TubeScene seen = See(scene, EightViews(scene, 6), 0.50);
  CHECK(seen.tubes.empty());
  CHECK(seen.unexplained_N.empty());
  // The walls' shadows are strips of the floor.
  CHECK(seen.unseen_floor_m2 < 0.2 * 0.77 * 0.58);
  Look above;
  above.X_NS_true.push_back(OverheadPose());
  above.clouds.push_back(ToyScan(scene, OverheadCamera(), OverheadPose(), RandomStream(6, 1, "")));
  // Without a projector only the walls' own height hides some floor: up to 0.09 m times the slope.
  CHECK(See(scene, above, 0.50).unseen_floor_m2 < 0.03 * 0.77 * 0.58);
}

TEST_CASE("A cloud without any return leaves everything unseen", "[unit]") {
  OrganizedCloud cloud;
  cloud.width = 40;
  cloud.height = 30;
  cloud.p_SP.assign(1200, InvalidPoint());
  cloud.X_NS = OverheadPose();
  const Bin bin;
  const TubeScene seen = Perceive({cloud}, TubeOf(0.0125, 0.5), bin, PerceptionConfig{}, {});
  CHECK(seen.tubes.empty());
  CHECK(seen.unseen_floor_m2 == Approx(0.77 * 0.58).epsilon(0.01));
  CHECK(seen.unseen_m3 == Approx(0.77 * 0.58 * 0.09).epsilon(0.01));
}

TEST_CASE("A last tube along a wall, in a corner or on the rim is found whole", "[unit]") {
  const double r = 0.0125, hx = 0.385, hy = 0.29;
  const std::vector<std::pair<const char*, Polyline>> cases = {
      {"along the long wall", {{-0.3, hy - r, r}, {0.2, hy - r, r}}},
      {"along the short wall", {{hx - r, -0.25, r}, {hx - r, 0.25, r}}},
      {"in the corner", {{hx - r, hy - r, r}, {hx - r - 0.5, hy - r, r}}},
      {"leaning on the wall", {{0.1, hy - 0.4, r}, {0.1, hy + 0.054, 0.09 + 0.045}}}};
  for (const auto& [name, line] : cases) {
    ToyScene scene;
    scene.tubes_N = {line};
    const Look look = EightViews(scene, 7);
    const TubeScene seen = See(scene, look, Length(line));
    INFO(name);
    REQUIRE(seen.tubes.size() == 1);
    // End points of a tube that leans out of the views are completed, not measured.
    CHECK(seen.tubes[0].length_m == Approx(Length(line)).margin(0.010));
    CHECK(seen.tubes[0].tube_class == TubeClass::kFree);
    for (const Vector3& p : seen.tubes[0].centerline_N) {
      CHECK(Closest(line, p).distance_m < 0.003);
    }
  }
}

TEST_CASE("Tubes that touch side by side stay two, and a tube across both is over them", "[unit]") {
  ToyScene scene;
  const double r = 0.0125;
  scene.tubes_N = {Straight({0, 0, r}, 0.2, 0.5),
                   Straight(Vector3(0, 0, r) + RotZ(0.2) * Vector3(0.05, 2 * r, 0), 0.2, 0.5),
                   Straight({0.02, 0.01, 3 * r}, 1.4, 0.5)};
  const Look look = EightViews(scene, 8);
  const TubeScene seen = See(scene, look, 0.5);
  const TubeScore score =
      ScoreTubes(seen, scene.tubes_N, TubePointsOf(look.clouds, look.X_NS_true, 17), r);
  CHECK(score.found == 3);
  CHECK(score.predicted == 3);
  CHECK(score.class_right == 3);
  CHECK(seen.crossings.size() == 2);
}

TEST_CASE("Two tubes in line with bare floor between them are not joined", "[unit]") {
  ToyScene scene;
  const double r = 0.0125;
  // The part's length would just allow one tube from both pieces.
  scene.tubes_N = {Straight({-0.13, 0, r}, 0, 0.2), Straight({0.13, 0, r}, 0, 0.2)};
  const TubeScene seen = See(scene, EightViews(scene, 9), 0.46);
  CHECK(seen.tubes.size() == 2);
}

TEST_CASE("A straight tube beside a wall, whose shadow hides one side of it, is found", "[unit]") {
  ToyScene scene;
  const double r = scene.radius_m;
  ToyCamera camera = QuickCamera();
  camera.baseline_m = 0.26;  // The light falls over the wall: the shadow ends beyond the crown.
  for (const double gap_m : {0.0005, 0.0015}) {
    CAPTURE(gap_m);
    const Vector3 middle(0, -(scene.bin.half_y_m() - r - gap_m), r);
    scene.tubes_N = {Straight(middle, 0, 0.5)};
    Look look;
    const RandomStream stream(13, 0, "along the wall");
    for (const double x : {0.29, 0.0, -0.29}) {
      look.clouds.push_back(ToyScan(scene, camera, LookDown({x, -0.145, 0.515}),
                                    stream.Fork("noise", look.clouds.size())));
    }
    const TubeScene seen = See(scene, look, 0.5);
    REQUIRE(seen.tubes.size() == 1);
    const Polyline& line = seen.tubes[0].centerline_N;
    CHECK((PointAt(line, 0.5 * Length(line)) - middle).norm() < 0.003);
  }
}

TEST_CASE("A box and a ball pen's width of stick stay unexplained", "[unit]") {
  ToyScene scene;
  scene.tubes_N = {Straight({0, -0.1, 0.0125}, 0.1, 0.5)};
  scene.boxes = {{{-0.1, 0.05, 0.0}, {0.1, 0.15, 0.04}}, {{0.15, 0.0, 0.0}, {0.30, 0.008, 0.010}}};
  const TubeScene seen = See(scene, EightViews(scene, 10), 0.5);
  CHECK(seen.tubes.size() == 1);
  CHECK(seen.unexplained_N.size() > 100);
}

TEST_CASE("The gripper's fingers at the edge of a view are no tube", "[unit]") {
  ToyScene scene;
  scene.tubes_N = {Straight({0, 0, 0.0125}, 0.5, 0.5), {{0.1, 0.1, 0.30}, {0.1, 0.1, 0.40}}};
  const TubeScene seen = See(scene, EightViews(scene, 11), 0.5);
  REQUIRE(seen.tubes.size() == 1);
  CHECK(seen.tubes[0].centerline_N.front().z() < 0.05);
}

TEST_CASE("An unorganised cloud gives the same tubes as its image", "[unit]") {
  ToyScene scene;
  const double r = 0.0125;
  scene.tubes_N = {Straight({0, 0, r}, 0.2, 0.5), Straight({0.02, 0.01, 3 * r}, 1.4, 0.5)};
  ToyCamera camera = OverheadCamera();
  camera.width = 1200;
  Look look;
  look.X_NS_true.push_back(OverheadPose());
  look.clouds.push_back(ToyScan(scene, camera, OverheadPose(), RandomStream(12, 0, "noise")));
  OrganizedCloud& cloud = look.clouds[0];
  const auto points = TubePointsOf(look.clouds, look.X_NS_true, 17);
  // Mixed up, without the invalid ones, and in frame N itself: nothing of the camera is left.
  std::vector<Eigen::Vector3f> mixed;
  RandomStream stream(12, 0, "mix");
  for (const auto& p : cloud.p_SP) {
    if (IsValid(p)) mixed.push_back((OverheadPose() * p.cast<double>()).cast<float>());
  }
  for (std::size_t i = mixed.size() - 1; i > 0; --i) {
    std::swap(mixed[i], mixed[stream.Index(static_cast<std::uint32_t>(i + 1))]);
  }
  mixed.emplace_back(1e6f, -1e6f, 1e5f);  // A stray point far out changes nothing.
  cloud.p_SP = mixed;
  cloud.label.clear();
  cloud.height = 1;
  cloud.width = static_cast<int>(mixed.size());
  cloud.X_NS = RigidTransform::Identity();
  const TubeScore score = ScoreTubes(See(scene, look, 0.5), scene.tubes_N, points, r);
  CHECK(score.found == 2);
  CHECK(score.predicted == 2);
  CHECK(score.class_right == 2);
}

TEST_CASE("Eight views as one cloud without order give the tubes as well", "[unit]") {
  ToyScene scene;
  const double r = 0.0125;
  scene.tubes_N = {Straight({0, 0, r}, 0.2, 0.5), Straight({0.02, 0.01, 3 * r}, 1.4, 0.5)};
  Look look;
  const RandomStream stream(14, 0, "eight views");
  OrganizedCloud fused;
  for (const RigidTransform& X_NS : EightPoses()) {
    look.clouds.push_back(
        ToyScan(scene, QuickCamera(), X_NS, stream.Fork("noise", look.clouds.size())));
    look.X_NS_true.push_back(X_NS);
    for (const auto& p : look.clouds.back().p_SP) {
      if (IsValid(p)) fused.p_SP.push_back((X_NS * p.cast<double>()).cast<float>());
    }
  }
  fused.height = 1;
  fused.width = static_cast<int>(fused.p_SP.size());
  const auto points = TubePointsOf(look.clouds, look.X_NS_true, 17);
  const TubeScene seen =
      Perceive({fused}, TubeOf(r, 0.5), scene.bin, PerceptionConfig{}, Parallelism{2});
  const TubeScore score = ScoreTubes(seen, scene.tubes_N, points, r);
  CHECK(score.found == 2);
  CHECK(score.predicted == 2);
  CHECK(score.class_right == 2);
  CHECK(score.centerline_median_m < 0.0003);
}

TEST_CASE("One oblique view from any side gives the tubes", "[unit]") {
  ToyScene scene;
  const double r = 0.0125;
  scene.tubes_N = {Straight({0, 0, r}, 0.2, 0.5), Straight({0.02, 0.01, 3 * r}, 1.4, 0.5),
                   Straight({-0.2, 0.12, r}, 0.5, 0.3)};
  for (const double yaw : {0.0, 1.1, 2.5, 4.0}) {
    // 40 degrees off the vertical, turned about it and about the camera's own axis.
    const RigidTransform X_NS = MakeTransform(RotZ(yaw), Vector3::Zero()) *
                                MakeTransform(RotX(kPi + Radians(40)), Vector3(0, -0.7, 0.83)) *
                                MakeTransform(RotZ(0.6 * yaw), Vector3::Zero());
    ToyCamera camera = OverheadCamera();
    camera.height = 1440;
    Look look;
    look.X_NS_true.push_back(X_NS);
    look.clouds.push_back(ToyScan(scene, camera, X_NS, RandomStream(15, 0, "noise")));
    const TubeScene seen = See(scene, look, 0.5);
    const TubeScore score =
        ScoreTubes(seen, scene.tubes_N, TubePointsOf(look.clouds, look.X_NS_true, 29), r);
    INFO("yaw " << yaw);
    CHECK(score.found == 3);
    CHECK(score.predicted == 3);
    CHECK(score.centerline_median_m < 0.0003);
    CHECK(score.centerline_p95_m < 0.003);
  }
}

TEST_CASE("The scene does not depend on threads or labels", "[unit]") {
  ToyScene scene;
  scene.tubes_N = {Straight({0, 0, 0.0125}, 0.2, 0.5), Straight({0.02, 0.01, 0.0375}, 1.4, 0.5)};
  Look look = EightViews(scene, 13);
  auto text = [&](int threads) {
    TubeScene seen = See(scene, look, 0.5, threads);
    seen.timing_ms = {};
    seen.threads = 1;
    return ToJson(seen).dump();
  };
  const std::string one = text(1);
  CHECK(text(2) == one);
  for (OrganizedCloud& cloud : look.clouds) std::fill(cloud.label.begin(), cloud.label.end(), 7u);
  CHECK(text(1) == one);
}

TEST_CASE("A pose that is not finite and a wrong size are refused", "[unit]") {
  OrganizedCloud cloud;
  cloud.width = 2;
  cloud.height = 2;
  cloud.p_SP.assign(4, InvalidPoint());
  cloud.X_NS.translation().x() = std::nan("");
  const Bin bin;
  const Part part = TubeOf(0.0125, 0.5);
  CHECK_THROWS_WITH(Perceive({cloud}, part, bin, PerceptionConfig{}, {}),
                    "cloud: the scanner's pose is not finite");
  cloud.X_NS = RigidTransform::Identity();
  cloud.width = 3;
  CHECK_THROWS_WITH(Perceive({cloud}, part, bin, PerceptionConfig{}, {}),
                    "cloud: 4 points, 3 x 2 were announced");
  CHECK_THROWS_WITH(Perceive({}, part, bin, PerceptionConfig{}, {}),
                    "perception: no cloud was given");
}

}  // namespace
}  // namespace tubetwin
