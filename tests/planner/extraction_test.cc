#include "planner/extraction/generators.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "tests/support/catch.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

constexpr double kStep_m = 0.020;  // Of the ways that are tried.

// Tube 1 along x on the floor from -0.20 to 0.20, tube 2 over it along y at x = 0.10.
TubeScene ShortCross() {
  return PerfectScene({StraightLine({-0.20, 0, kRadius}, {0.20, 0, kRadius}),
                       StraightLine({0.10, -0.2, 3 * kRadius}, {0.10, 0.2, 3 * kRadius})},
                      kRadius);
}

const CandidateMotion* Find(const MotionSet& set, const std::string& name) {
  for (const CandidateMotion& motion : set.motions) {
    if (motion.name == name) return &motion;
  }
  return nullptr;
}

TEST_CASE("A free tube needs no way out", "[unit]") {
  const TubeScene scene = ShortCross();
  const MotionSet set = MotionsOf(kWaysOut, scene, scene.tubes[1]);
  CHECK(set.motions.empty());
  CHECK(set.rejections.empty());
}

TEST_CASE("A drawer's way ends where nothing covers the tube any more", "[unit]") {
  const TubeScene scene = ShortCross();
  const MotionSet set = MotionsOf(kWaysOut, scene, scene.tubes[0]);
  const CandidateMotion* back = Find(set, "slide-");
  REQUIRE(back != nullptr);
  REQUIRE(back->waypoints_N.size() == 3);
  const Vector3 slide = back->waypoints_N[1];
  CHECK(slide.normalized().isApprox(-Vector3::UnitX()));
  // Its front end at 0.20 must come before 0.10 less both radii.
  CHECK(slide.norm() >= 0.10 + 2 * kRadius);
  CHECK(slide.norm() <= 0.10 + 2 * kRadius + kStep_m + kRadius + 1e-9);
  CHECK((back->waypoints_N[2] - slide).isApprox(Vector3(0, 0, 0.40)));
  // Whatever slides under tube 2 cannot be held; the far end can.
  const auto blocked = [&](double at_m) {
    for (const auto& [from, to] : back->blocked_m) {
      if (from <= at_m && at_m <= to) return true;
    }
    return false;
  };
  CHECK(blocked(0.38));
  CHECK_FALSE(blocked(0.10));
}

TEST_CASE("The best way out is never longer than a drawer's, and ends uncovered", "[unit]") {
  const TubeScene scene = ShortCross();
  const MotionSet set = MotionsOf(kWaysOut, scene, scene.tubes[0]);
  const CandidateMotion *away = Find(set, "escape_away"), *back = Find(set, "slide-");
  REQUIRE(away != nullptr);
  REQUIRE(back != nullptr);
  CHECK(away->waypoints_N[1].norm() <= back->waypoints_N[1].norm() + 1e-9);
  const Polyline moved =
      Transformed(Translation(away->waypoints_N[1]), scene.tubes[0].centerline_N);
  for (const Vector3& p : moved) {
    const Vector3 level(p.x(), p.y(), scene.tubes[1].centerline_N.front().z());
    CHECK(Closest(scene.tubes[1].centerline_N, level).distance_m >= 2 * kRadius);
  }
}

TEST_CASE("A way out that the wall ends too early is refused with the reason", "[unit]") {
  Bin narrow;
  narrow.size_m = {0.46, 0.44, 0.09};
  const TubeScene scene = ShortCross();
  const MotionSet set = MotionsOf(kWaysOut, scene, scene.tubes[0], narrow);
  CHECK(Find(set, "slide-") == nullptr);
  REQUIRE_FALSE(set.rejections.empty());
  CHECK(set.rejections[0].reason.find("still covered where the bin's wall ends the slide") == 0);
}

TEST_CASE("Separations have the published shapes and keep off the walls", "[unit]") {
  const TubeScene scene = ShortCross();
  const ExtractionConfig config;
  const MotionSet set = MotionsOf(kSeparations, scene, scene.tubes[0], Bin{}, config);
  CHECK(set.motions.size() == 1 + 1 + 16 + 4);
  std::set<std::string> names;
  for (const CandidateMotion& motion : set.motions) names.insert(motion.name);
  CHECK(names.size() == set.motions.size());
  for (int k = 1; k <= 16; ++k) {
    const CandidateMotion* to = Find(set, "hemisphere" + std::to_string(k));
    REQUIRE(to != nullptr);
    CHECK(to->waypoints_N[1].norm() == Approx(0.15));
  }
  const CandidateMotion *half = Find(set, "helix_half+"), *full = Find(set, "helix_full-");
  REQUIRE(half != nullptr);
  REQUIRE(full != nullptr);
  // Half a turn ends across the circle, a whole one over its start.
  CHECK(half->waypoints_N[4].head<2>().norm() == Approx(0.10));
  CHECK(full->waypoints_N[8].head<2>().norm() == Approx(0.0).margin(1e-12));
  CHECK(full->waypoints_N[8].z() == Approx(0.25));

  Bin narrow;
  narrow.size_m = {0.46, 0.44, 0.09};
  for (const CandidateMotion& motion :
       MotionsOf(kSeparations, scene, scene.tubes[0], narrow, config).motions) {
    for (const Vector3& p : motion.waypoints_N) {
      CHECK(0.20 + kRadius + std::abs(p.x()) <= 0.23 - config.wall_safety_m + 1e-9);
    }
  }
}

TEST_CASE("A tip turns the tube steeply over the bin's middle, to either side", "[unit]") {
  const TubeScene scene =
      PerfectScene({StraightLine({0.1, -0.2, kRadius}, {0.1, 0.2, kRadius})}, kRadius);
  const MotionSet set = MotionsOf({"tilt_and_shed"}, scene, scene.tubes[0]);
  const Vector3 along = Vector3::UnitY(), pivot(0.1, 0.0, kRadius);
  std::multiset<std::string> names;
  for (const CandidateMotion& tip : set.motions) {
    names.insert(tip.name);
    REQUIRE(tip.rotations_N.size() == tip.waypoints_N.size());
    CHECK(PoseAt(tip, 0).isApprox(RigidTransform::Identity()));
    CHECK(tip.pivot_N.isApprox(pivot));
    // Half of it, the wall and a little more.
    const double height_m = 0.09 + 0.2 * std::sin(Radians(75.0)) + kRadius + 0.01;
    CHECK((tip.waypoints_N[1] - Vector3(0, 0, height_m)).norm() < 1e-12);
    double most_deg = 0.0, least_deg = 0.0;
    for (std::size_t k = 2; k < tip.waypoints_N.size(); ++k) {
      CHECK((PoseAt(tip, k) * pivot).head<2>().norm() < 1e-12);
      const Matrix3 R = PoseAt(tip, k).linear();
      const double along_deg = Degrees(std::asin((R * along).z()));
      const double across_deg = Degrees(std::asin((R * Vector3::UnitX()).z()));
      CHECK(std::abs(tip.name == "roll" ? along_deg : across_deg) < 1e-6);
      const double turned_deg = tip.name == "roll" ? across_deg : along_deg;
      most_deg = std::max(most_deg, turned_deg);
      least_deg = std::min(least_deg, turned_deg);
    }
    CHECK(most_deg == Approx(75.0));
    CHECK(least_deg == Approx(-75.0));
    CHECK(PoseAt(tip, tip.waypoints_N.size() - 1).linear()(2, 2) == Approx(1.0));
    CHECK(tip.waypoints_N.back().z() == Approx(0.40));
    CHECK(ShedsByTilting(tip));
  }
  CHECK(names == std::multiset<std::string>{"pitch", "pitch", "pitch", "roll", "roll", "roll"});

  ExtractionConfig low;
  low.lift_m = 0.1;
  for (const CandidateMotion& tip :
       MotionsOf({"tilt_and_shed"}, scene, scene.tubes[0], Bin{}, low).motions) {
    REQUIRE(tip.rotations_N.size() == tip.waypoints_N.size());
    CHECK(tip.waypoints_N.back().z() > 0.3);
  }
  CHECK_FALSE(ShedsByTilting(MotionsOf(kSeparations, scene, scene.tubes[0]).motions.front()));
}

TEST_CASE("Round a corner goes what would push others on every straight way", "[unit]") {
  // Tube 1 lies under tube 2 at one end, between walls of tubes with one gap.
  const auto on_floor = [](double x0, double y0, double x1, double y1) {
    return StraightLine({x0, y0, kRadius}, {x1, y1, kRadius});
  };
  const TubeScene scene = PerfectScene(
      {on_floor(0, 0, 0.2, 0), StraightLine({0.15, -0.2, 3 * kRadius}, {0.15, 0.2, 3 * kRadius}),
       on_floor(-0.05, -0.2, -0.05, 0.032), on_floor(0.26, -0.2, 0.26, 0.2),
       on_floor(0, 0.10, 0.2, 0.10), on_floor(0, -0.06, 0.2, -0.06)},
      kRadius);
  const MotionSet set = MotionsOf(kWaysOut, scene, scene.tubes[0]);
  const CandidateMotion* corner = Find(set, "escape_corner");
  REQUIRE(corner != nullptr);
  REQUIRE(corner->waypoints_N.size() == 4);
  CHECK(corner->waypoints_N[1].isApprox(Vector3(0, 0.06, 0), 1e-6));
  const Vector3 second = corner->waypoints_N[2] - corner->waypoints_N[1];
  CHECK(second.normalized().isApprox(-Vector3::UnitX(), 1e-6));
  CHECK(-second.x() >= 0.05 + 2 * kRadius);
  // Where a straight way pushes nobody there is no need.
  CHECK(Find(MotionsOf(kWaysOut, ShortCross(), ShortCross().tubes[0]), "escape_corner") == nullptr);
}

}  // namespace
}  // namespace tubetwin
