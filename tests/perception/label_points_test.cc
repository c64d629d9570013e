#include "perception/label_points.h"

#include "tests/support/catch.h"
#include "tests/support/toy_scanner.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

TEST_CASE("Every point gets the tube that it lies on, floor and walls get none", "[unit]") {
  ToyScene toy;
  const double r = toy.radius_m;
  toy.tubes_N = {StraightLine({-0.2, 0, r}, {0.2, 0, r}),
                 StraightLine({0, -0.2, 3 * r}, {0, 0.2, 3 * r}),
                 StraightLine({-0.3, 0.29 - r, r}, {0.1, 0.29 - r, r})};
  ToyCamera camera;
  camera.width = 480;
  camera.height = 300;
  camera.focal_px = 340.0;
  const OrganizedCloud cloud =
      ToyScan(toy, camera, MakeTransform(RotX(kPi), Vector3(0, 0, 1.1)), RandomStream(2, 0, "n"));
  const TubeScene scene = PerfectScene(toy.tubes_N, r);
  const auto label = LabelPoints(cloud, scene, toy.bin, {1});
  CHECK((LabelPoints(cloud, scene, toy.bin, {2}) == label));
  int right = 0, tube_points = 0, cell_called_tube = 0, cell_points = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!IsValid(cloud.p_SP[i])) {
      CHECK(label[i] == kLabelNone);
    } else if (cloud.label[i] >= kLabelFirstTube) {
      ++tube_points;
      right += label[i] == cloud.label[i];
    } else {
      ++cell_points;
      cell_called_tube += label[i] >= kLabelFirstTube;
    }
  }
  // The strips within 3 mm of the floor and 2.5 mm of the wall are nobody's.
  CHECK(right > 0.95 * tube_points);
  CHECK(cell_called_tube < 0.001 * cell_points);
}

TEST_CASE("Without tubes all returns belong to the cell", "[unit]") {
  OrganizedCloud cloud;
  cloud.width = 2;
  cloud.height = 1;
  cloud.p_SP = {Eigen::Vector3f(0.1f, 0.1f, 0.5f), InvalidPoint()};
  const auto label = LabelPoints(cloud, TubeScene(), Bin(), {1});
  CHECK((label == std::vector<std::uint32_t>{kLabelCell, kLabelNone}));
}

}  // namespace
}  // namespace tubetwin
