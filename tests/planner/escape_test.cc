#include "planner/extraction/generators.h"

#include "tests/support/catch.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

// Crossings are found on samples 1 mm apart; the hidden stretch is walked in steps of 2 mm.
constexpr double kSampling = 0.004;

const CandidateMotion& Named(const MotionSet& set, const std::string& name) {
  for (const CandidateMotion& motion : set.motions) {
    if (motion.name == name) return motion;
  }
  FAIL("no motion " << name);
  return set.motions.front();
}

TEST_CASE("A free tube can only go straight up", "[unit]") {
  const TubeScene scene = Cross();
  const MotionSet set = MotionsOf(kPaperKinds, scene, scene.tubes[1]);
  REQUIRE(set.motions.size() == 1);
  CHECK(set.motions[0].name == "up");
  REQUIRE(set.motions[0].waypoints_N.size() == 2);
  CHECK(set.motions[0].waypoints_N[0].isZero());
  CHECK(set.motions[0].waypoints_N[1].isApprox(Vector3(0, 0, 0.40)));
  CHECK(set.motions[0].forbidden_from_m > set.motions[0].forbidden_to_m);
}

TEST_CASE("A covered tube slides out along its hidden stretch to both sides", "[unit]") {
  Bin wide;
  wide.size_m = {2.0, 2.0, 0.09};
  const TubeScene scene = Cross();
  REQUIRE(scene.tubes[0].tube_class == TubeClass::kWeak);
  const MotionSet set = MotionsOf(kPaperKinds, scene, scene.tubes[0], wide);
  REQUIRE(set.motions.size() == 3);
  CHECK(set.rejections.empty());

  // Forward: the 0.30 m before the crossing, less half the hidden stretch, must pass under.
  const CandidateMotion& forward = Named(set, "escape+");
  REQUIRE(forward.waypoints_N.size() == 4);
  CHECK(forward.waypoints_N[1].isApprox(Vector3(0, 0, 0.05)));
  const Vector3 slide = forward.waypoints_N[2] - forward.waypoints_N[1];
  CHECK(slide.normalized().isApprox(Vector3::UnitX()));
  CHECK(slide.norm() == Approx(0.30 - kRadius + 0.0375).margin(kSampling));
  CHECK((forward.waypoints_N[3] - forward.waypoints_N[2]).isApprox(Vector3(0, 0, 0.40)));
  CHECK(forward.forbidden_from_m == 0.0);
  CHECK(forward.forbidden_to_m == Approx(0.30 + kRadius).margin(kSampling));

  const CandidateMotion& back = Named(set, "escape-");
  const Vector3 back_slide = back.waypoints_N[2] - back.waypoints_N[1];
  CHECK(back_slide.normalized().isApprox(-Vector3::UnitX()));
  CHECK(back_slide.norm() == Approx(0.20 - kRadius + 0.0375).margin(kSampling));
  CHECK(back.forbidden_from_m == Approx(0.30 - kRadius).margin(kSampling));
  CHECK(back.forbidden_to_m == Approx(0.50));
}

TEST_CASE("Escapes of the paper's profile follow the occluded joint, not the crossing", "[unit]") {
  TubeScene scene = Cross();
  PerceivedTube& tube = scene.tubes[0];
  ExtractionConfig config;
  config.escape_along_joints = true;
  CHECK(MotionsOf(kPaperKinds, scene, tube, Bin{}, config).motions.size() ==
        1);  // All of it was seen.
  const std::size_t middle = tube.node_visible.size() / 2;
  for (std::size_t k = middle - 1; k <= middle + 1; ++k) tube.node_visible[k] = 0;
  const std::vector<double> arc = ArcLengths(tube.centerline_N);
  const std::vector<HiddenStretch> joints = OccludedJoints(tube);
  REQUIRE(joints.size() == 1);
  CHECK(joints[0].from_m == Approx(arc[middle - 2]));
  CHECK(joints[0].to_m == Approx(arc[middle + 2]));
  Bin wide;
  wide.size_m = {2.0, 2.0, 0.09};
  const MotionSet set = MotionsOf(kPaperKinds, scene, tube, wide, config);
  REQUIRE(set.motions.size() == 3);
  const Vector3 slide = Named(set, "escape+").waypoints_N[2] - Vector3(0, 0, 0.05);
  CHECK(slide.norm() == Approx(joints[0].from_m + 0.0375));
}

TEST_CASE("An escape stops where the tube's bounding box would leave the safety zone", "[unit]") {
  const TubeScene scene = Cross();
  const MotionSet set = MotionsOf(kPaperKinds, scene, scene.tubes[0]);
  const CandidateMotion& forward = Named(set, "escape+");
  const double slide = forward.waypoints_N[2].x();
  CHECK(0.25 + kRadius + slide == Approx(0.5 * 0.77 - 0.01));
}

TEST_CASE("An escape into a wall is rejected and says how much room there is", "[unit]") {
  const double x = 0.5 * 0.77 - kRadius - 0.015;  // 5 mm to the safety zone.
  const TubeScene scene =
      PerfectScene({StraightLine({x - 0.5, 0, kRadius}, {x, 0, kRadius}),
                    StraightLine({0.05, -0.2, 3 * kRadius}, {0.05, 0.2, 3 * kRadius})},
                   kRadius);
  const MotionSet set = MotionsOf(kPaperKinds, scene, scene.tubes[0]);
  REQUIRE(set.motions.size() == 2);
  CHECK(set.motions[1].name == "escape-");
  REQUIRE(set.rejections.size() == 1);
  CHECK(set.rejections[0].motion == "escape+");
  CHECK_THAT(set.rejections[0].reason, Catch::Contains("wall leaves 5 mm"));
}

TEST_CASE("Every crossing of a strongly covered tube gives two escapes", "[unit]") {
  const TubeScene scene =
      PerfectScene({StraightLine({-0.25, 0, kRadius}, {0.25, 0, kRadius}),
                    StraightLine({0.10, -0.2, 3 * kRadius}, {0.10, 0.2, 3 * kRadius}),
                    StraightLine({-0.10, -0.2, 3 * kRadius}, {-0.10, 0.2, 3 * kRadius})},
                   kRadius);
  REQUIRE(scene.tubes[0].tube_class == TubeClass::kStrong);
  Bin wide;
  wide.size_m = {2.0, 2.0, 0.09};
  const MotionSet set = MotionsOf(kPaperKinds, scene, scene.tubes[0], wide);
  REQUIRE(set.motions.size() == 5);
  // In the order of arc length: the crossing with tube 3 comes first.
  CHECK(Named(set, "escape+").forbidden_to_m < Named(set, "escape+2").forbidden_to_m);
}

TEST_CASE("Two crossings that a wall turns into the same slide give it once", "[unit]") {
  const double x = 0.5 * 0.77 - kRadius - 0.040;  // 30 mm to the safety zone: both are cut to that.
  const TubeScene scene =
      PerfectScene({StraightLine({x - 0.5, 0, kRadius}, {x, 0, kRadius}),
                    StraightLine({0.10, -0.2, 3 * kRadius}, {0.10, 0.2, 3 * kRadius}),
                    StraightLine({-0.05, -0.2, 3 * kRadius}, {-0.05, 0.2, 3 * kRadius})},
                   kRadius);
  const MotionSet set = MotionsOf(kPaperKinds, scene, scene.tubes[0]);
  int forward = 0;
  for (const CandidateMotion& motion : set.motions) {
    if (motion.name.rfind("escape+", 0) == 0) ++forward;
  }
  CHECK(forward == 1);
  CHECK(Named(set, "escape+").forbidden_to_m ==
        Approx(0.10 - (x - 0.5) + kRadius).margin(kSampling));
}

TEST_CASE("Unseen nodes beside a crossing belong to its hidden stretch", "[unit]") {
  TubeScene scene = Cross();
  REQUIRE(scene.crossings.size() == 1);
  for (std::size_t k = 31; k < 35; ++k) scene.tubes[0].node_visible[k] = 0;  // 0.31 to 0.34 m
  const HiddenStretch hidden =
      FindHiddenStretch(scene.tubes[1], scene.tubes[0], scene.crossings[0]);
  CHECK(hidden.from_m == Approx(0.30 - kRadius).margin(kSampling));
  CHECK(hidden.to_m == Approx(0.34).margin(kSampling));
}

}  // namespace
}  // namespace tubetwin
