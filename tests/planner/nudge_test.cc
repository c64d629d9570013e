#include "planner/pick/nudge.h"

#include "models/arm/arm.h"
#include "models/base/json.h"
#include "models/base/random.h"
#include "models/gripper_spec.h"
#include "planner/grasp/grasps.h"
#include "planner/grasp/gripper_boxes.h"
#include "planner/pick/make_path.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

constexpr double kHalfX = 0.385, kHalfY = 0.29;  // Of the default bin.
constexpr double kLeast_m = 0.002;               // PlannerConfig::finger_clearance_m.

std::optional<std::string> AnyGrasp(const Grasp&, const CandidateMotion&) { return std::nullopt; }
std::optional<std::string> AnyNudge(const Nudge&) { return std::nullopt; }

NudgeResult Plan(const TubeScene& scene, const FeasibilityFunction& grasp = AnyGrasp,
                 const NudgeFeasibility& feasible = AnyNudge) {
  const PlannerConfig config;
  const Part part;
  const Bin bin;
  return PlanNudge({scene, kNoPoints, part, bin, FirstGripper(), config, {}}, grasp, feasible);
}

GraspSites Sites(const TubeScene& scene) {
  return FindGraspSites({scene, kNoPoints, Bin{}, FirstGripper(), GraspConfig{}}, scene.tubes[0]);
}

bool AnyReason(const NudgeResult& result, int tube, const std::string& text) {
  for (const Rejection& rejection : result.rejections) {
    if (rejection.tube == tube && rejection.motion == "nudge" &&
        rejection.reason.find(text) != std::string::npos) {
      return true;
    }
  }
  return false;
}

double FingerTravel(const Nudge& nudge) {
  double sum = 0.0;
  for (const NudgeStroke& stroke : nudge.strokes) sum += stroke.travel_N.norm();
  return sum;
}

TEST_CASE("A straight tube at a wall is rolled inward as far as a finger needs beside it",
          "[unit]") {
  for (const double gap : {0.0, 0.004, 0.010}) {
    const double y = kHalfY - kRadius - gap;
    const TubeScene scene =
        PerfectScene({StraightLine({-0.25, y, kRadius}, {0.25, y, kRadius})}, kRadius);
    REQUIRE(Sites(scene).sites.empty());
    const NudgeResult result = Plan(scene);
    REQUIRE(result.nudge);
    const Nudge& nudge = *result.nudge;
    CHECK(nudge.tube == 1);
    CHECK(nudge.direction_N.isApprox(Vector3(0, -1, 0)));
    CHECK(nudge.at_m == Approx(0.25));  // The centre of mass.
    CHECK(nudge.rolls);
    // Room, finger and clearance need 4.5 + 13 + 2 mm: the next 5 mm, and 8 mm more.
    CHECK(nudge.travel_m == Approx(0.005 * std::ceil((0.0195 - gap) / 0.005) + 0.008));
    CHECK(FingerTravel(nudge) == Approx(2.0 * nudge.travel_m));
    // The fingers' lower edge ends 4 mm below the crown.
    const double z = 2 * kRadius - 0.004 + 0.5 * PaperCell().gripper.pad_height_m;
    for (const NudgeStroke& stroke : nudge.strokes) {
      CHECK(stroke.X_NE.translation().z() == Approx(z));
      CHECK(stroke.X_NE.linear().col(2).isApprox(-Vector3::UnitZ()));
    }
  }
}

TEST_CASE("In a corner a tube is brought away from the wall that it lies along", "[unit]") {
  const double x = kHalfX - kRadius;
  const TubeScene scene = PerfectScene(
      {StraightLine({x, kHalfY - kRadius - 0.5, kRadius}, {x, kHalfY - kRadius, kRadius})},
      kRadius);
  const NudgeResult result = Plan(scene);
  REQUIRE(result.nudge);
  CHECK(result.nudge->direction_N.x() < -0.7);
  CHECK(result.nudge->direction_N.y() <= 0.0);
}

TEST_CASE("A bent tube slides with the fingers in one stroke", "[unit]") {
  const double y = kHalfY - kRadius;
  const TubeScene scene = PerfectScene(
      {{{-0.2, y - 0.1, kRadius}, {-0.1, y, kRadius}, {0.1, y, kRadius}, {0.2, y - 0.1, kRadius}}},
      kRadius);
  // No arm gets near the wall with a tube here.
  const NudgeResult result =
      Plan(scene, [&](const Grasp& grasp, const CandidateMotion&) -> std::optional<std::string> {
        const Vector3 before = PointAt(scene.tubes[0].centerline_N, grasp.at_m);
        if (grasp.X_NG.translation().y() < before.y() - 0.022) return std::nullopt;
        return "too near";
      });
  REQUIRE(result.nudge);
  CHECK_FALSE(result.nudge->rolls);
  REQUIRE(result.nudge->strokes.size() == 1);
  CHECK(result.nudge->strokes[0].travel_N.isApprox(result.nudge->travel_m *
                                                   result.nudge->direction_N));
  CHECK(result.nudge->travel_m == Approx(0.025 + 0.008));
}

TEST_CASE("What cannot be nudged is named with a reason", "[unit]") {
  const Polyline middle = StraightLine({-0.25, 0, kRadius}, {0.25, 0, kRadius});
  CHECK(AnyReason(Plan(PerfectScene({middle}, kRadius)), 1, "no wall and no tube is near"));

  const double y = kHalfY - kRadius;
  const Polyline at_wall = StraightLine({-0.25, y, kRadius}, {0.25, y, kRadius});
  const TubeScene blocked =
      PerfectScene({at_wall, Shifted(at_wall, Vector3(0, -2 * kRadius - 0.006, 0))}, kRadius);
  const NudgeResult other = Plan(blocked);
  CHECK(AnyReason(other, 1, "it would meet another tube after"));
  REQUIRE(other.nudge);  // Its neighbour goes first.
  CHECK(other.nudge->tube == 2);
  CHECK(other.nudge->direction_N.y() < -0.99);

  const TubeScene covered = PerfectScene(
      {at_wall, StraightLine({0, y - 0.3, 3 * kRadius}, {0, y + 0.01, 3 * kRadius})}, kRadius);
  CHECK(AnyReason(Plan(covered), 1, "covered tubes are not nudged"));

  const NudgeResult refused = Plan(PerfectScene({at_wall}, kRadius), AnyGrasp,
                                   [](const Nudge&) { return std::string("elbow too low"); });
  CHECK_FALSE(refused.nudge);
  CHECK(AnyReason(refused, 1, "arm: elbow too low"));
  CHECK(ToJson(refused.nudge).is_null());
}

// Tubes along random walls, others strewn about.
TubeScene WallScene(RandomStream& stream) {
  std::vector<Polyline> lines;
  const int wall = static_cast<int>(stream.Uniform(0, 4));
  const double gap = stream.Uniform(0.0, 0.015), along = stream.Uniform(-0.1, 0.1);
  const bool on_x = wall < 2;
  const double at = (wall % 2 == 0 ? 1 : -1) * ((on_x ? kHalfX : kHalfY) - kRadius - gap);
  const double half = on_x ? 0.18 : 0.25;
  const auto point = [&](double s) {
    return on_x ? Vector3(at, along * 0.5 + s, kRadius) : Vector3(along + s, at, kRadius);
  };
  lines.push_back(StraightLine(point(-half), point(half)));
  for (int k = 0; k < 3; ++k) {
    const Vector3 p(stream.Uniform(-0.2, 0.2), stream.Uniform(-0.12, 0.12), kRadius);
    const double yaw = stream.Uniform(0, kPi);
    const Vector3 half_way(0.1 * std::cos(yaw), 0.1 * std::sin(yaw), 0);
    lines.push_back(StraightLine(p - half_way, p + half_way));
  }
  return PerfectScene(lines, kRadius);
}

TEST_CASE("Fingers keep off walls and other tubes on every nudge, and the tube ends graspable",
          "[unit]") {
  RandomStream stream(3, 0, "nudges");
  int nudged = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const TubeScene scene = WallScene(stream);
    // Only the first tube needs it.
    const NudgeResult result = Plan(scene, [&](const Grasp& grasp, const CandidateMotion&) {
      return grasp.tube == 1 ? std::nullopt : std::optional<std::string>("not this one");
    });
    if (!result.nudge) continue;
    ++nudged;
    const Nudge& nudge = *result.nudge;
    REQUIRE(nudge.tube == 1);
    for (const NudgeStroke& stroke : nudge.strokes) {
      CHECK(stroke.travel_N.normalized().isApprox(nudge.direction_N));
      for (int k = 0; k <= 20; ++k) {
        const RigidTransform X_NE = Translation(stroke.travel_N * k / 20) * stroke.X_NE;
        const GripperBoxes boxes = MakeGripperBoxes(FirstGripper(), 0.0, kRadius, 0.0);
        for (const auto& [name, box] : Parts(boxes)) {
          const OrientedBox box_N = Moved(X_NE, box);
          CHECK(WallClearance(box_N, Bin{}, 0.01) >= kLeast_m - 1e-9);
          for (std::size_t i = 1; i < scene.tubes.size(); ++i) {
            const double gap = LineBoxDistance(scene.tubes[i].centerline_N, box_N, 0.1) - kRadius;
            CHECK(gap >= kLeast_m - 0.0005);  // Between the places that were checked.
          }
        }
      }
    }
    TubeScene moved = scene;
    moved.tubes[0].centerline_N =
        Shifted(scene.tubes[0].centerline_N, nudge.travel_m * nudge.direction_N);
    CHECK_FALSE(Sites(moved).sites.empty());
  }
  CHECK(nudged > 40);
}

TEST_CASE("The arm can nudge a tube at every wall of the default bin", "[unit]") {
  const MotionPlanner motion(PaperCell(), Bin{});
  const Bin bin;
  const PathConfig paths;
  const NudgeConfig nudging;
  const FeasibilityFunction grasp = PathFeasibility(motion, bin, paths, kRadius);
  const NudgeFeasibility feasible = NudgePathFeasibility(motion, bin, paths, nudging);
  for (const double side : {1.0, -1.0}) {
    const double x = side * (kHalfX - kRadius), y = side * (kHalfY - kRadius);
    for (const Polyline& line : {StraightLine({x, -0.25, kRadius}, {x, 0.25, kRadius}),
                                 StraightLine({-0.13, y, kRadius}, {0.37, y, kRadius})}) {
      const NudgeResult result = Plan(PerfectScene({line}, kRadius), grasp, feasible);
      REQUIRE(result.nudge);
      CHECK_FALSE(feasible(*result.nudge));
      const Json json = ToJson(result.nudge);
      CHECK(json["strokes"].size() == result.nudge->strokes.size());
    }
  }
}

}  // namespace
}  // namespace tubetwin
