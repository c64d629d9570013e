#include "planner/scene_query/sweep.h"

#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

TubePath Motion(int tube, std::vector<Vector3> waypoints_N) {
  TubePath motion;
  motion.tube = tube;
  motion.waypoints_N = std::move(waypoints_N);
  return motion;
}

TEST_CASE("A simplified line keeps its corners and stays within the tolerance", "[unit]") {
  Polyline arc;
  for (int k = 0; k <= 90; ++k) {
    arc.push_back({0.1 * std::cos(Radians(k)), 0.1 * std::sin(Radians(k)), 0.0});
  }
  const Polyline few = Simplified(arc, 0.001);
  CHECK(few.size() < 12);
  CHECK(few.front() == arc.front());
  CHECK(few.back() == arc.back());
  for (const Vector3& p : arc) CHECK(Closest(few, p).distance_m <= 0.001);
  CHECK(Simplified(StraightLine({0, 0, 0}, {1, 0, 0}), 1e-9).size() == 2);
}

TEST_CASE("Lifting the upper tube touches nothing, lifting the lower one meets it", "[unit]") {
  const std::vector<Vector3> up = {{0, 0, 0}, {0, 0, 0.4}};
  CHECK_FALSE(FirstTouched(Cross(), Motion(2, up)).has_value());
  CHECK(FirstTouched(Cross(), Motion(1, up)) == 2);
}

TEST_CASE("Two tubes in the same place do not part untouched", "[unit]") {
  const Polyline line = StraightLine({-0.2, 0, kRadius}, {0.2, 0, kRadius});
  const TubeScene scene = PerfectScene({line, line}, kRadius);
  CHECK(FirstTouched(scene, Motion(1, {{0, 0, 0}, {0, 0, 0.4}})) == 2);
}

TEST_CASE("A slide is stopped by what stands in its way only", "[unit]") {
  const TubeScene scene = PerfectScene({StraightLine({-0.2, 0, kRadius}, {0.2, 0, kRadius}),
                                        StraightLine({-0.2, 0.1, kRadius}, {0.2, 0.1, kRadius})},
                                       kRadius);
  CHECK(FirstTouched(scene, Motion(1, {{0, 0, 0}, {0, 0.2, 0}})) == 2);
  CHECK_FALSE(FirstTouched(scene, Motion(1, {{0, 0, 0}, {0, 0.05, 0}})).has_value());
  CHECK_FALSE(FirstTouched(scene, Motion(1, {{0, 0, 0}, {0, 0, 0.1}, {0, 0.2, 0.1}})).has_value());
  // What rests on a tube that slides is dragged; lifting the upper one first leaves the lower.
  CHECK(FirstTouched(Cross(), Motion(1, {{0, 0, 0}, {-0.01, 0, 0}})) == 2);
  // Down again behind it is fine, down onto it is not.
  CHECK(FirstTouched(scene, Motion(1, {{0, 0, 0}, {0, 0, 0.1}, {0, 0.1, 0.1}, {0, 0.1, 0}})) == 2);
}

TEST_CASE("A tube that turns on the floor meets what its end sweeps over", "[unit]") {
  const TubeScene scene =
      PerfectScene({StraightLine({-0.2, 0, kRadius}, {0.2, 0, kRadius}),
                    StraightLine({0.10, 0.06, kRadius}, {0.10, 0.26, kRadius}),
                    StraightLine({-0.10, 0.06, kRadius}, {-0.10, 0.26, kRadius})},
                   kRadius);
  TubePath motion = Motion(1, {Vector3::Zero(), Vector3::Zero(), {0, 0, 0.4}});
  const auto turn = [](double angle_deg) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(Radians(angle_deg), Vector3::UnitZ()));
  };
  motion.rotations_N = {turn(0), turn(30), turn(30)};
  CHECK(FirstTouched(scene, motion) == 2);
  motion.rotations_N = {turn(0), turn(-30), turn(-30)};
  CHECK(FirstTouched(scene, motion) == 3);
  motion.rotations_N = {turn(0), turn(10), turn(10)};
  CHECK_FALSE(FirstTouched(scene, motion).has_value());
  motion.rotations_N = {turn(0), turn(30), turn(30)};
  motion.pivot_N = Vector3(0.2, 0, 0);
  CHECK(FirstTouched(scene, motion) == std::nullopt);
}

TEST_CASE("Fingers touch what lies beside the tube that they hold unless they only rise") {
  const TubeScene scene = PerfectScene({StraightLine({-0.2, 0, 0.0125}, {0.2, 0, 0.0125}),
                                        StraightLine({-0.2, 0.06, 0.0125}, {0.2, 0.06, 0.0125})},
                                       0.0125);
  const Vector3 held(0, 0, 0.0125);
  const TubePath aside = Motion(1, {{0, 0, 0}, {0, 0.03, 0}});
  CHECK_FALSE(FirstTouched(scene, aside).has_value());
  CHECK(FirstTouchedByFingers(scene, aside, held, PaperCell().gripper) == 2);
  CHECK_FALSE(FirstTouchedByFingers(scene, Motion(1, {{0, 0, 0}, {0, -0.03, 0}}), held,
                                    PaperCell().gripper));
  CHECK_FALSE(
      FirstTouchedByFingers(scene, Motion(1, {{0, 0, 0}, {0, 0, 0.4}}), held, PaperCell().gripper));
}

}  // namespace
}  // namespace tubetwin
