#include "perception/view/floor_pose.h"

#include <algorithm>
#include <string>

#include "models/base/error.h"
#include "perception/view/floor_ways.h"
#include "tests/support/catch.h"
#include "tests/support/toy_scanner.h"

namespace tubetwin {
namespace {

/// One view from above that has the whole bin in it, a fourth of the judge's resolution.
ToyCamera Camera() {
  ToyCamera camera;
  camera.width = 640;
  camera.height = 480;
  camera.focal_px = 500.0;
  return camera;
}

/// Over the bin, turned by any yaw, tilted by up to `tilt_deg`.
RigidTransform SomePose(RandomStream& stream, double tilt_deg) {
  const Vector3 axis = RotZ(stream.Uniform(0, 2 * kPi)) * Vector3::UnitX();
  const Matrix3 tilt =
      Eigen::AngleAxisd(Radians(stream.Uniform(0, tilt_deg)), axis).toRotationMatrix();
  const Matrix3 R = tilt * RotZ(stream.Uniform(0, 2 * kPi)) * RotX(kPi);
  return MakeTransform(
      R, Vector3(stream.Uniform(-0.1, 0.1), stream.Uniform(-0.1, 0.1), stream.Uniform(1.1, 1.3)));
}

ToyScene SomeScene(RandomStream& stream, std::array<double, 3> size_m, int tubes) {
  ToyScene scene;
  scene.bin.size_m = size_m;
  for (int i = 0; i < tubes; ++i) {
    const Vector3 centre(stream.Uniform(-0.1, 0.1), stream.Uniform(-0.1, 0.1), 0.0125 + 0.02 * i);
    const Vector3 half = RotZ(stream.Uniform(0, 2 * kPi)) * Vector3(0.2, 0, 0);
    scene.tubes_N.push_back({centre - half, centre + half});
  }
  return scene;
}

/// Half a turn of the bin looks the same: the pose that the fit promises.
RigidTransform Promised(RigidTransform X_NS) {
  if (X_NS.linear()(0, 0) < 0) X_NS = MakeTransform(RotZ(kPi), Vector3::Zero()) * X_NS;
  return X_NS;
}

TEST_CASE("The scanner's pose is found from floor and walls, whatever lies in the bin", "[unit]") {
  const std::array<double, 3> sizes[] = {{0.77, 0.58, 0.09}, {0.80, 0.60, 0.20}};
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    RandomStream stream(seed, 0, "floor pose test");
    const ToyScene scene = SomeScene(stream, sizes[seed % 2], static_cast<int>(seed % 6));
    const RigidTransform X_NS = SomePose(stream, 12.0);
    OrganizedCloud cloud = ToyScan(scene, Camera(), X_NS, stream.Fork("noise"));
    cloud.X_NS = RigidTransform::Identity();
    const RigidTransform fitted = FitFloorPose({cloud}, scene.bin).X_NS.front();
    const RigidTransform error = Promised(X_NS).inverse() * fitted;
    INFO("seed " << seed);
    constexpr double kShift_m = 0.002, kTurn_deg = 0.25;  // A pixel is 2.4 mm wide.
    CHECK(error.translation().norm() < kShift_m);
    CHECK(Degrees(Eigen::AngleAxisd(error.linear()).angle()) < kTurn_deg);
  }
}

TEST_CASE("The order of the points and their frame do not matter to the floor's fit", "[unit]") {
  RandomStream stream(3, 0, "floor pose test");
  const ToyScene scene = SomeScene(stream, {0.77, 0.58, 0.09}, 3);
  const RigidTransform X_NS = SomePose(stream, 5.0);
  OrganizedCloud cloud = ToyScan(scene, Camera(), X_NS, stream.Fork("noise"));
  // Upside down and far away: no sensor stands at the origin of this frame.
  const RigidTransform X_FS = MakeTransform(RotX(2.0) * RotZ(1.0), Vector3(0.4, -3.0, 2.0));
  for (auto& p : cloud.p_SP) p = (X_FS * p.cast<double>()).cast<float>();
  std::reverse(cloud.p_SP.begin(), cloud.p_SP.end());
  cloud.width = static_cast<int>(cloud.size());
  cloud.height = 1;
  cloud.X_NS = RigidTransform::Identity();
  const RigidTransform X_NF = FitFloorPose({cloud}, scene.bin).X_NS.front();
  // Either of the two poses that look the same.
  const RigidTransform error = (X_NS * X_FS.inverse()).inverse() * X_NF;
  const RigidTransform turned =
      (X_NS * X_FS.inverse()).inverse() * MakeTransform(RotZ(kPi), Vector3::Zero()) * X_NF;
  const double shift_m =
      std::min((error * (X_FS * Vector3(0, 0, 1)) - X_FS * Vector3(0, 0, 1)).norm(),
               (turned * (X_FS * Vector3(0, 0, 1)) - X_FS * Vector3(0, 0, 1)).norm());
  CHECK(shift_m < 0.003);
}

/// The refusal of a fit.
std::string WhyNot(const std::vector<OrganizedCloud>& clouds, const Bin& bin) {
  try {
    const FloorPose pose = FitFloorPose(clouds, bin);
    return "fitted to the walls " + pose.walls;
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kBadData);
    return error.what();
  }
}

OrganizedCloud Stripped(OrganizedCloud cloud) {
  cloud.X_NS = RigidTransform::Identity();
  return cloud;
}

TEST_CASE("Without floor, or without neighbouring walls, there is no pose", "[unit]") {
  RandomStream stream(4, 0, "floor pose test");
  const ToyScene scene = SomeScene(stream, {0.77, 0.58, 0.09}, 2);
  const auto look = [&](const Vector3& p_NS) {
    return Stripped(ToyScan(scene, Camera(), LookDown(p_NS), stream.Fork("near")));
  };
  // The middle of the floor from near: no wall.
  CHECK_THAT(WhyNot({look({0, 0, 0.3})}, scene.bin), Catch::Contains("no wall of a bin on it"));
  CHECK_THAT(WhyNot({look({0.28, 0, 0.3})}, scene.bin), Catch::Contains("only one wall is seen"));
  OrganizedCloud fog;
  fog.width = 1000;
  fog.height = 1;
  for (int i = 0; i < fog.width; ++i) {
    fog.p_SP.emplace_back(stream.Uniform(-1, 1), stream.Uniform(-1, 1), stream.Uniform(0, 1));
  }
  CHECK_THROWS_AS(FitFloorPose({fog}, scene.bin), Error);
  fog.p_SP.assign(1000, InvalidPoint());
  CHECK_THROWS_WITH(
      FitFloorPose({fog}, scene.bin),
      Catch::Contains("no floor with two neighbouring walls of a bin of 0.77 x 0.58"));
}

TEST_CASE("A corner alone may be either of two, and is refused with both places", "[unit]") {
  RandomStream stream(5, 0, "floor pose test");
  const ToyScene scene = SomeScene(stream, {0.77, 0.58, 0.09}, 1);
  const RigidTransform X_NS = LookDown({0.25, 0.15, 0.4});
  const OrganizedCloud corner = Stripped(ToyScan(scene, Camera(), X_NS, stream.Fork("corner")));
  const std::string why = WhyNot({corner}, scene.bin);
  CHECK_THAT(why, Catch::Contains("the pose is ambiguous, the scanner may be at"));
  CHECK_THAT(why, Catch::Contains("0.25, ") && Catch::Contains("0.15, 0.40)"));
}

TEST_CASE("A wall that the image cuts off is not as long as what is seen of it", "[unit]") {
  RandomStream stream(11, 0, "floor pose test");
  const ToyScene scene = SomeScene(stream, {0.77, 0.58, 0.09}, 0);
  ToyCamera camera = Camera();
  camera.width = 300;
  // Of the long wall 0.575 m are seen, about the short side's length.
  const RigidTransform X_NS = LookDown({-0.194, 0.1, 0.8});
  const FloorWays found =
      FindFloorWays({Stripped(ToyScan(scene, camera, X_NS, stream.Fork("cut")))}, scene.bin);
  REQUIRE(found.ways.size() == 2);
  for (const FloorWay& way : found.ways) CHECK_FALSE(way.shows_size);
}

TEST_CASE("Another bin than the one given is told by what is seen of it", "[unit]") {
  RandomStream stream(6, 0, "floor pose test");
  ToyScene scene = SomeScene(stream, {0.77, 0.58, 0.12}, 2);
  const OrganizedCloud cloud =
      Stripped(ToyScan(scene, Camera(), LookDown({0, 0, 1.2}), stream.Fork("whole")));
  const auto why = [&](const std::array<double, 3>& size_m) {
    Bin given;
    given.size_m = size_m;
    return WhyNot({cloud}, given);
  };
  CHECK(why({0.77, 0.58, 0.12}) == "fitted to the walls -x, +x, -y, +y");
  CHECK_THAT(
      why({0.80, 0.60, 0.12}),
      Catch::Contains("m apart are seen; the bin given is 0.8 x 0.6 x 0.12 m: give the size"));
  CHECK_THAT(why({0.77, 0.50, 0.12}), Catch::Contains("m apart are seen"));
  CHECK_THAT(why({0.77, 0.65, 0.12}), Catch::Contains("m apart are seen"));
  CHECK_THAT(why({0.77, 0.58, 0.06}), Catch::Contains("m high; the bin given is"));
}

TEST_CASE("Walls that are not where the given bin has its own are told of posed views", "[unit]") {
  RandomStream stream(10, 0, "floor pose test");
  ToyScene scene = SomeScene(stream, {0.77, 0.58, 0.12}, 3);
  // A box is no wall: the bin's own are in their place.
  scene.boxes.push_back({{0.2, -0.1, 0.0}, {0.3, 0.1, 0.1}});
  const OrganizedCloud cloud = ToyScan(scene, Camera(), LookDown({0, 0, 1.2}), stream.Fork("all"));
  const auto other = [&](const std::array<double, 3>& size_m) {
    Bin given;
    given.size_m = size_m;
    return OtherBinSeen({cloud}, given);
  };
  CHECK(other({0.77, 0.58, 0.12}).empty());
  CHECK_THAT(
      other({0.80, 0.58, 0.12}),
      Catch::Contains("m apart are seen; the bin given is 0.8 x 0.58 x 0.12 m: check --bin"));
  CHECK_THAT(other({0.77, 0.50, 0.12}), Catch::Contains("two walls 0.580 m apart are seen"));
}

TEST_CASE("A square bin leaves a quarter turn open, another half a turn", "[unit]") {
  for (const double side_m : {0.60, 0.58}) {
    RandomStream stream(7, 0, "floor pose test");
    const ToyScene scene = SomeScene(stream, {0.60, side_m, 0.15}, 2);
    const RigidTransform X_NS = SomePose(stream, 8.0);
    const OrganizedCloud cloud = Stripped(ToyScan(scene, Camera(), X_NS, stream.Fork("square")));
    const FloorPose pose = FitFloorPose({cloud}, scene.bin);
    CHECK(pose.open == (side_m == 0.60 ? "a quarter turn of the bin" : "half a turn of the bin"));
    double least = 1e9;
    for (int k = 0; k < 4; k += side_m == 0.60 ? 1 : 2) {
      const RigidTransform turned =
          MakeTransform(RotZ(0.5 * kPi * k), Vector3::Zero()) * pose.X_NS.front();
      least = std::min(least, (turned.translation() - X_NS.translation()).norm());
    }
    CHECK(least < 0.002);
  }
}

TEST_CASE("Views that know their places in another frame are fitted as one", "[unit]") {
  RandomStream stream(8, 0, "floor pose test");
  const ToyScene scene = SomeScene(stream, {0.77, 0.58, 0.09}, 4);
  const RigidTransform X_BN = MakeTransform(RotZ(0.7), Vector3(0.6, -0.1, 0.3));
  std::vector<OrganizedCloud> clouds;
  std::vector<RigidTransform> X_NS;
  // No single one of them shows more than a corner.
  for (const double x : {-0.2, 0.2}) {
    for (const double y : {-0.14, 0.14}) {
      X_NS.push_back(LookDown({x, y, 0.45}));
      clouds.push_back(ToyScan(scene, Camera(), X_NS.back(), stream.Fork("view", clouds.size())));
      CHECK_THAT(WhyNot({Stripped(clouds.back())}, scene.bin), Catch::Contains("ambiguous"));
      clouds.back().X_NS = X_BN * X_NS.back();
    }
  }
  const FloorPose pose = FitFloorPose(clouds, scene.bin);
  CHECK(pose.walls == "-x, +x, -y, +y");
  // The first S's x axis lies along -y of N: of the two turns the other is promised.
  const RigidTransform turn = MakeTransform(RotZ(kPi), Vector3::Zero());
  for (std::size_t v = 0; v < X_NS.size(); ++v) {
    CHECK((pose.X_NS[v].translation() - (turn * X_NS[v]).translation()).norm() < 0.002);
  }
}

TEST_CASE("Views that know nothing are put together by the pile that they share", "[unit]") {
  RandomStream stream(9, 0, "floor pose test");
  ToyScene scene = SomeScene(stream, {0.77, 0.58, 0.09}, 5);
  std::vector<RigidTransform> X_NS;
  for (const double x : {-0.15, 0.15}) {
    X_NS.push_back(LookDown({x, 0.02, 0.85}));
    X_NS.back().linear() = X_NS.back().linear() * RotZ(x > 0 ? 2.5 : 0.4);
  }
  const auto scan = [&] {
    std::vector<OrganizedCloud> out;
    for (const RigidTransform& X : X_NS) {
      out.push_back(Stripped(ToyScan(scene, Camera(), X, stream.Fork("view", out.size()))));
    }
    return out;
  };
  const FloorPose pose = FitFloorPose(scan(), scene.bin);
  const RigidTransform between = X_NS[0].inverse() * X_NS[1];
  const RigidTransform off = between.inverse() * pose.X_NS[0].inverse() * pose.X_NS[1];
  CHECK(off.translation().norm() < 0.003);
  CHECK(Degrees(Eigen::AngleAxisd(off.linear()).angle()) < 0.3);
  // An empty bin looks the same from both ends.
  scene.tubes_N.clear();
  CHECK_THAT(WhyNot(scan(), scene.bin), Catch::Contains("too little of the pile in common"));
}

}  // namespace
}  // namespace tubetwin
