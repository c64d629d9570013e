#include "perception/view/floor_pose.h"

#include <algorithm>

#include "models/base/error.h"
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
    const RigidTransform fitted = FitFloorPose(cloud, scene.bin);
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
  const RigidTransform X_NF = FitFloorPose(cloud, scene.bin);
  // Either of the two poses that look the same.
  const RigidTransform error = (X_NS * X_FS.inverse()).inverse() * X_NF;
  const RigidTransform turned =
      (X_NS * X_FS.inverse()).inverse() * MakeTransform(RotZ(kPi), Vector3::Zero()) * X_NF;
  const double shift_m =
      std::min((error * (X_FS * Vector3(0, 0, 1)) - X_FS * Vector3(0, 0, 1)).norm(),
               (turned * (X_FS * Vector3(0, 0, 1)) - X_FS * Vector3(0, 0, 1)).norm());
  CHECK(shift_m < 0.003);
}

TEST_CASE("Without floor, or with fewer than two neighbouring walls, there is no pose", "[unit]") {
  RandomStream stream(4, 0, "floor pose test");
  const ToyScene scene = SomeScene(stream, {0.77, 0.58, 0.09}, 2);
  // The middle of the floor from near: no wall.
  const OrganizedCloud near = ToyScan(scene, Camera(), LookDown({0, 0, 0.3}), stream.Fork("near"));
  CHECK_THROWS_WITH(
      FitFloorPose(near, scene.bin),
      Catch::Contains("no floor with two neighbouring walls of a bin of 0.77 x 0.58"));
  OrganizedCloud fog;
  fog.width = 1000;
  fog.height = 1;
  for (int i = 0; i < fog.width; ++i) {
    fog.p_SP.emplace_back(stream.Uniform(-1, 1), stream.Uniform(-1, 1), stream.Uniform(0, 1));
  }
  CHECK_THROWS_AS(FitFloorPose(fog, scene.bin), Error);
  fog.p_SP.assign(1000, InvalidPoint());
  CHECK_THROWS_AS(FitFloorPose(fog, scene.bin), Error);
}

}  // namespace
}  // namespace tubetwin
