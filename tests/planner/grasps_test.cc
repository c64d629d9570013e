#include "planner/grasp/grasps.h"

#include "models/base/random.h"
#include "models/gripper_spec.h"
#include "planner/grasp/gripper_boxes.h"
#include "planner/scene_query/box_distance.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

GraspSites Sites(const TubeScene& scene, int index,
                 const std::vector<Vector3>& points_N = kNoPoints) {
  return FindGraspSites({scene, points_N, Bin{}, FirstGripper(), GraspConfig{}},
                        scene.tubes[index]);
}

GraspSet Ranked(const TubeScene& scene, const CandidateMotion& motion, double top_m) {
  return RankGrasps({scene, kNoPoints, Bin{}, FirstGripper(), GraspConfig{}}, Sites(scene, 0),
                    scene.tubes[0], motion, 0.0, top_m);
}

CandidateMotion Up() {
  CandidateMotion motion;
  motion.tube = 1;
  motion.name = "up";
  motion.waypoints_N = {Vector3::Zero(), Vector3(0, 0, 0.4)};
  return motion;
}

bool AnyReason(const std::vector<Rejection>& rejections, const std::string& text) {
  for (const Rejection& rejection : rejections) {
    if (rejection.reason.find(text) != std::string::npos) return true;
  }
  return false;
}

TEST_CASE("The distance of a segment to a box equals the best of a fine grid", "[unit]") {
  RandomStream stream(1, 0, "boxes");
  for (int trial = 0; trial < 500; ++trial) {
    const auto point = [&] {
      return Vector3(stream.Uniform(-1, 1), stream.Uniform(-1, 1), stream.Uniform(-1, 1));
    };
    OrientedBox box;
    box.X_AB = MakeTransform(RotZ(stream.Uniform(0, 6)) * RotX(stream.Uniform(0, 6)), point());
    box.half_m = 0.3 * point().cwiseAbs();
    const Vector3 p = point(), q = point();
    double best = 1e9;
    constexpr int kSteps = 2000;
    for (int k = 0; k <= kSteps; ++k) {
      const Vector3 x = box.X_AB.inverse() * (p + (q - p) * k / double(kSteps));
      best = std::min(best, (x.cwiseAbs() - box.half_m).cwiseMax(0.0).norm());
    }
    const double exact = SegmentBoxDistance(p, q, box);
    CHECK(exact <= best + 1e-12);
    CHECK(exact > best - 3.5 / kSteps);  // The segment is at most 3.5 long: one grid step.
    CHECK(LineBoxDistance({p, 0.5 * (p + q), q}, box, 10.0) == Approx(exact).margin(1e-12));
  }
}

TEST_CASE("A lone tube is grasped across its axis, above it, from near end to near end", "[unit]") {
  const double yaw = 0.7;
  const Vector3 along = RotZ(yaw) * Vector3::UnitX();
  const TubeScene scene = PerfectScene(
      {StraightLine(Vector3(0, 0, kRadius) - 0.25 * along, Vector3(0, 0, kRadius) + 0.25 * along)},
      kRadius);
  const GraspSites sites = Sites(scene, 0);
  CHECK(sites.rejections.empty());
  REQUIRE(sites.sites.size() == 47);  // 0.02 to 0.48 m in steps of 0.01 m.
  for (const GraspSite& site : sites.sites) {
    const RigidTransform& X_NG = site.grasp.X_NG;
    CHECK(std::abs(X_NG.linear().col(0).dot(along)) == Approx(1.0));
    CHECK(X_NG.linear().col(2).isApprox(-Vector3::UnitZ()));
    CHECK(X_NG.linear().determinant() == Approx(1.0));
    CHECK(X_NG.translation().z() ==
          Approx(kRadius + GraspHeightOverAxis(kRadius, PaperCell().gripper)));
    CHECK(site.grasp.opening_m == Approx(2 * (kRadius + 0.020)));  // All the room it wants.
    // Of the two equal yaws the one along B's x.
    CHECK((Bin{}.X_BN.linear() * X_NG.linear().col(0)).x() >= 0.0);
  }
  CHECK(sites.sites.front().grasp.at_m == Approx(0.02));
}

TEST_CASE("A neighbour narrows the opening, and a nearer one forbids the grasp", "[unit]") {
  const Polyline line = StraightLine({-0.25, 0, kRadius}, {0.25, 0, kRadius});
  const auto opening_beside = [&](double axis_distance) {
    const TubeScene scene =
        PerfectScene({line, Shifted(line, Vector3(0, axis_distance, 0))}, kRadius);
    const GraspSites sites = Sites(scene, 0);
    return sites.sites.empty() ? 0.0 : sites.sites.front().grasp.opening_m;
  };
  // Pad, finger, clearance and the neighbour itself need 12.5 + side + 13 + 2 + 12.5 mm.
  CHECK(opening_beside(0.080) == Approx(0.065));
  CHECK(opening_beside(0.050) < 0.045);
  CHECK(opening_beside(0.050) > 0.030);
  CHECK(opening_beside(0.042) == 0.0);
}

TEST_CASE("Tubes that lie over the grasp place forbid it, tubes under it do not", "[unit]") {
  const TubeScene scene =
      PerfectScene({StraightLine({-0.25, 0, kRadius}, {0.25, 0, kRadius}),
                    StraightLine({0, -0.2, 3 * kRadius}, {0, 0.2, 3 * kRadius})},
                   kRadius);
  for (const GraspSite& site : Sites(scene, 0).sites) {
    CHECK(std::abs(site.grasp.at_m - 0.25) > 2 * kRadius);
  }
  const GraspSites upper = Sites(scene, 1);
  bool in_the_middle = false;
  for (const GraspSite& site : upper.sites) {
    if (std::abs(site.grasp.at_m - 0.20) < 1e-9) in_the_middle = true;
  }
  CHECK(in_the_middle);
  CHECK(AnyReason(Sites(scene, 0).rejections, "within two radii of a crossing"));
}

TEST_CASE("Beside a wall only the yaw with the fingers along it works", "[unit]") {
  const double y = 0.29 - 0.030;  // 30 mm from the long wall: a finger does not fit between.
  const TubeScene along =
      PerfectScene({StraightLine({-0.25, y, kRadius}, {0.25, y, kRadius})}, kRadius);
  const GraspSites none = Sites(along, 0);
  CHECK(none.sites.empty());
  CHECK(AnyReason(none.rejections, "from the bin's wall"));
  // A tube that ends at the wall is taken near the wall with the fingers parallel to it.
  const TubeScene across =
      PerfectScene({StraightLine({0, -0.2, kRadius}, {0, 0.27, kRadius})}, kRadius);
  const GraspSites some = Sites(across, 0);
  REQUIRE_FALSE(some.sites.empty());
  CHECK(some.sites.back().grasp.X_NG.translation().y() > 0.23);
}

TEST_CASE("Measured points that no tube explains block the place where they lie", "[unit]") {
  const TubeScene scene =
      PerfectScene({StraightLine({-0.25, 0, kRadius}, {0.25, 0, kRadius})}, kRadius);
  std::vector<Vector3> points;
  for (int k = 0; k < 20; ++k) points.push_back({0.001 * k - 0.01, 0.040, 0.03});
  const GraspSites sites = Sites(scene, 0, points);
  for (const GraspSite& site : sites.sites) {
    if (std::abs(site.grasp.at_m - 0.25) < 0.005) CHECK(site.grasp.opening_m < 0.065);
  }
  points.clear();
  for (int k = 0; k < 20; ++k) points.push_back({0.001 * k - 0.01, 0.0, 0.05});  // Right above.
  const GraspSites blocked = Sites(scene, 0, points);
  for (const GraspSite& site : blocked.sites) CHECK(std::abs(site.grasp.at_m - 0.25) > 0.005);
  CHECK(AnyReason(blocked.rejections, "measured points in the gripper's way, at most 6"));
}

TEST_CASE("Steep stretches are not grasped", "[unit]") {
  const TubeScene scene = PerfectScene({StraightLine({0, 0, 0.02}, {0.02, 0, 0.18})}, kRadius);
  const GraspSites sites = Sites(scene, 0);
  CHECK(sites.sites.empty());
  CHECK(AnyReason(sites.rejections, "slope 83 degrees, at most 40"));
}

TEST_CASE("The ranking prefers the true centre of mass, then high places", "[unit]") {
  // An L: its centre of mass is off the curve, and the arc's middle is not the nearest place to it.
  Polyline bent = StraightLine({0, 0, kRadius}, {0.15, 0, kRadius});
  const Polyline rest = StraightLine({0.15, 0, kRadius}, {0.15, 0.35, kRadius});
  bent.insert(bent.end(), rest.begin() + 1, rest.end());
  const TubeScene scene = PerfectScene({Shifted(bent, Vector3(-0.1, -0.15, 0))}, kRadius);
  const GraspSet set = Ranked(scene, Up(), kRadius);
  REQUIRE_FALSE(set.grasps.empty());
  const Polyline& line = scene.tubes[0].centerline_N;
  const Vector3 centre = CurveCentre(line);
  const double best = (PointAt(line, set.grasps[0].at_m) - centre).norm();
  for (const Grasp& grasp : set.grasps) {
    CHECK((PointAt(line, grasp.at_m) - centre).norm() >= best - 1e-12);
  }

  // A tube that leans: of two places equally far from the centre the higher one is cheaper.
  const TubeScene leaning = PerfectScene({StraightLine({-0.2, 0, 0.02}, {0.2, 0, 0.08})}, kRadius);
  const GraspSet ranked = Ranked(leaning, Up(), 0.08);
  double low_cost = 0.0, high_cost = 0.0;
  const double middle = 0.5 * leaning.tubes[0].length_m;
  for (const Grasp& grasp : ranked.grasps) {
    if (std::abs(grasp.at_m - (middle - 0.1)) < 1e-9) low_cost = grasp.cost;
    if (std::abs(grasp.at_m - (middle + 0.1)) < 1e-9) high_cost = grasp.cost;
  }
  CHECK(high_cost > 0.0);
  CHECK(high_cost < low_cost);
}

TEST_CASE("No grasp lies in the section that an escape forbids", "[unit]") {
  const TubeScene scene =
      PerfectScene({StraightLine({-0.2, 0, kRadius}, {0.2, 0, kRadius})}, kRadius);
  CandidateMotion motion = Up();
  motion.name = "escape+";
  motion.forbidden_from_m = 0.0;
  motion.forbidden_to_m = 0.25;
  const GraspSet set = Ranked(scene, motion, kRadius);
  REQUIRE_FALSE(set.grasps.empty());
  for (const Grasp& grasp : set.grasps) CHECK(grasp.at_m > 0.25);
  CHECK(AnyReason(set.rejections, "would pass under the other tube"));
}

double TiltOf(const Grasp& grasp) { return std::acos(-grasp.X_NG.linear()(2, 2)); }

TEST_CASE("A tube too steep for an upright tool is grasped square to it", "[unit]") {
  const double slope = Radians(60.0);
  const Vector3 foot(0, 0, 0.05), along(std::cos(slope), 0, std::sin(slope));
  const TubeScene scene = PerfectScene({StraightLine(foot, foot + 0.4 * along)}, kRadius);
  const GraspSites found = Sites(scene, 0);
  CHECK(AnyReason(found.rejections, "slope 60 degrees"));
  REQUIRE(!found.sites.empty());
  for (const GraspSite& site : found.sites) {
    CHECK(TiltOf(site.grasp) == Approx(Radians(35.0)));
    // Along the tube, which stays between the pads.
    CHECK(std::abs(site.grasp.X_NG.linear().col(1).dot(along)) < 1e-9);
    CHECK(std::abs(site.grasp.X_NG.linear().col(0).dot(along)) > std::cos(Radians(26.0)));
    const Vector3 axis_E =
        site.grasp.X_NG.inverse() * PointAt(scene.tubes[0].centerline_N, site.grasp.at_m);
    CHECK(axis_E.head<2>().norm() < 1e-9);
    CHECK(axis_E.z() > 0.0);
  }
}

TEST_CASE("A tube under an overhang is grasped by a tool that leans away from it", "[unit]") {
  // Higher tubes at one side leave no room for the gripper's body straight above.
  const TubeScene scene = PerfectScene({StraightLine({-0.1, 0, 0.06}, {0.1, 0, 0.06}),
                                        StraightLine({-0.25, 0.046, 0.19}, {0.25, 0.046, 0.19}),
                                        StraightLine({-0.25, 0.046, 0.165}, {0.25, 0.046, 0.165})},
                                       kRadius);
  const GraspSites found = Sites(scene, 0);
  CHECK(AnyReason(found.rejections, "chassis"));
  REQUIRE(!found.sites.empty());
  const GraspConfig config;
  for (const GraspSite& site : found.sites) {
    CHECK(TiltOf(site.grasp) > Radians(5.0));
    CHECK(TiltOf(site.grasp) <= Radians(35.0) + 1e-9);
    CHECK(-site.grasp.X_NG.linear()(1, 2) < 0.0);  // The tool comes from -y.
    CHECK(site.grasp.clearance_m >= config.finger_clearance_m);
  }
  // Upright grasps are never mixed with leaning ones, and lean costs.
  const TubeScene alone = PerfectScene({StraightLine({-0.1, 0, 0.06}, {0.1, 0, 0.06})}, kRadius);
  for (const GraspSite& site : Sites(alone, 0).sites) CHECK(TiltOf(site.grasp) < 1e-6);
}

TEST_CASE("A leaning tool keeps its fingers over the floor", "[unit]") {
  RandomStream stream(5, 0, "lean");
  int leaning = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const double height = stream.Uniform(kRadius, 0.08), room = stream.Uniform(0.035, 0.055);
    const TubeScene scene =
        PerfectScene({StraightLine({-0.1, 0, height}, {0.1, 0, height}),
                      StraightLine({-0.25, room, height + 0.12}, {0.25, room, height + 0.12}),
                      StraightLine({-0.25, room, height + 0.09}, {0.25, room, height + 0.09})},
                     kRadius);
    for (const GraspSite& site : Sites(scene, 0).sites) {
      const GripperBoxes boxes =
          MakeGripperBoxes(FirstGripper(), site.grasp.opening_m, kRadius, 0.0);
      const OrientedBox fingers = Moved(site.grasp.X_NG, boxes.fingers);
      const double low = fingers.X_AB.translation().z() -
                         fingers.X_AB.linear().row(2).cwiseAbs().dot(fingers.half_m);
      CHECK(low >= 0.002 - 1e-9);
      if (TiltOf(site.grasp) > 0.01) ++leaning;
    }
  }
  CHECK(leaning > 100);
}

}  // namespace
}  // namespace tubetwin
