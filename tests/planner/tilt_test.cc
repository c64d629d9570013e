#include "planner/extraction/generators.h"

#include "tests/support/catch.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

// Tube 1 along y on the floor, tube 2 over it along x: near end at 0.05, far end on the floor.
TubeScene LidScene(double near_x = 0.05) {
  return PerfectScene({StraightLine({0, -0.2, kRadius}, {0, 0.2, kRadius}),
                       StraightLine({near_x, 0, 3 * kRadius + 0.005}, {-0.30, 0, kRadius})},
                      kRadius);
}

TEST_CASE("The far contact is where the upper tube rests otherwise", "[unit]") {
  const TubeScene scene = LidScene();
  REQUIRE(scene.crossings.size() == 1);
  const Vector3 far = FarContact(scene, scene.tubes[1], scene.crossings[0].at_over_m, +1, 1);
  CHECK((far - Vector3(-0.30, 0, kRadius)).norm() < 0.005 + kExact);  // Looked for every 5 mm.
  // Another tube carries it before its end does.
  TubeScene carried = PerfectScene({StraightLine({0, -0.2, kRadius}, {0, 0.2, kRadius}),
                                    StraightLine({0.05, 0, 3 * kRadius}, {-0.30, 0, 3 * kRadius}),
                                    StraightLine({-0.2, -0.2, kRadius}, {-0.2, 0.2, kRadius})},
                                   kRadius);
  double at_m = 0.0;
  for (const Crossing& crossing : carried.crossings) {
    if (crossing.under == 1) at_m = crossing.at_over_m;
  }
  CHECK(std::abs(FarContact(carried, carried.tubes[1], at_m, +1, 1).x() + 0.2) < 0.01);
}

TEST_CASE("A tilt raises the lid about its far contact and leaves at its near end", "[unit]") {
  const TubeScene scene = LidScene();
  const MotionSet set = MotionsOf({"tilt"}, scene, scene.tubes[0]);
  REQUIRE(set.motions.size() == 1);
  const CandidateMotion& tilt = set.motions[0];
  CHECK(tilt.name == "tilt");
  REQUIRE(tilt.rotations_N.size() == tilt.waypoints_N.size());
  REQUIRE(tilt.waypoints_N.size() == 4);
  // The crossing's point of the tube rises by about 5 cm; nothing of it goes below the floor.
  const Vector3 raised = PoseAt(tilt, 1) * Vector3(0, 0, kRadius);
  CHECK(raised.z() - kRadius == Approx(0.05).margin(0.002));
  for (std::size_t k = 0; k < tilt.waypoints_N.size(); ++k) {
    for (const Vector3& p : Transformed(PoseAt(tilt, k), scene.tubes[0].centerline_N)) {
      CHECK(p.z() >= kRadius - kExact);
    }
  }
  // Out past the near end by both radii and a margin.
  const Vector3 slide = tilt.waypoints_N[2] - tilt.waypoints_N[1];
  CHECK(slide.x() == Approx(0.05 + 2 * kRadius + 0.010).margin(0.006));
  CHECK(std::abs(slide.y()) + std::abs(slide.z()) < 1e-6);
  // Upright at the end.
  CHECK(tilt.rotations_N.back().isApprox(Eigen::Quaterniond::Identity(), kExact));
  CHECK((tilt.waypoints_N[3] - tilt.waypoints_N[2]).isApprox(Vector3(0, 0, 0.40)));
}

TEST_CASE("A tilt is refused with the reason where the wall ends the slide", "[unit]") {
  Bin narrow;
  narrow.size_m = {0.14, 0.60, 0.09};
  const TubeScene scene = LidScene();
  const MotionSet set = MotionsOf({"tilt"}, scene, scene.tubes[0], narrow);
  CHECK(set.motions.empty());
  REQUIRE(set.rejections.size() == 1);
  CHECK(set.rejections[0].reason.find("the bin's wall leaves") == 0);
}

TEST_CASE("A tube that nothing covers has no lid to tilt", "[unit]") {
  const TubeScene scene = LidScene();
  CHECK(MotionsOf({"tilt"}, scene, scene.tubes[1]).motions.empty());
}

}  // namespace
}  // namespace tubetwin
