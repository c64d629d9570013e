// What must hold for any scene, tried on random ones; each says its seed when it fails.

#include <algorithm>

#include "models/base/random.h"
#include "planner/pick/pick_planner.h"
#include "planner/pick/tool_path.h"
#include "tests/support/catch.h"
#include "tests/support/fake_round.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

using test::FakeMotion;
using test::FakeRound;
using test::FakeWorld;
using test::MotionKind;
using test::TwoTubes;

/// Straight tubes anywhere in the small bin, in layers, so that they cross without meeting.
std::vector<Polyline> Pile(RandomStream& stream, int count) {
  std::vector<Polyline> out;
  for (int k = 0; k < count; ++k) {
    const double yaw = stream.Uniform(0.0, kPi);
    const Vector3 half = 0.12 * Vector3(std::cos(yaw), std::sin(yaw), 0.0);
    const Vector3 centre(stream.Uniform(-0.12, 0.12), stream.Uniform(-0.05, 0.05),
                         kRadius + 2.1 * kRadius * k);
    out.push_back(StraightLine(centre - half, centre + half));
  }
  return out;
}

std::optional<std::string> Any(const Grasp&, const CandidateMotion&) { return std::nullopt; }

PlanResult PlanOf(const TubeScene& scene, const PlannerConfig& config = {}) {
  const std::vector<Vector3> no_points;
  const Part part = FakeWorld::ShortTube();
  const Bin bin = FakeWorld::SmallBin();
  return PlanPicks(
      {scene, no_points, part, bin, FirstGripper(), config, ExtractionMotionsOf(config)},
      FakeRound::Harmless, Any);
}

TEST_CASE("A plan does not change with the order in which perception lists the tubes", "[unit]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    RandomStream stream(seed, 0, "order");
    const TubeScene scene = PerfectScene(Pile(stream, 4), kRadius);
    TubeScene turned = scene;
    std::reverse(turned.tubes.begin(), turned.tubes.end());
    std::reverse(turned.crossings.begin(), turned.crossings.end());
    const PlanResult a = PlanOf(scene), b = PlanOf(turned);
    REQUIRE_FALSE(a.plans.empty());
    REQUIRE_FALSE(b.plans.empty());
    CHECK(a.plans[0].target == b.plans[0].target);
    CHECK(a.plans[0].motion.name == b.plans[0].motion.name);
    CHECK(a.plans[0].grasp.X_NG.isApprox(b.plans[0].grasp.X_NG, 1e-12));
  }
}

TEST_CASE("In the bin's frame a plan does not change with where the bin stands", "[unit]") {
  const std::vector<RigidTransform> poses = {
      DefaultBinPose(), MakeTransform(RotZ(kPi / 2), Vector3(0.63, 0.04, 0.08)),
      MakeTransform(RotZ(kPi / 2 + 0.15), Vector3(0.60, -0.03, 0.12))};
  std::optional<PickPlan> first;
  for (const RigidTransform& X_BN : poses) {
    Bin bin = FakeWorld::SmallBin();
    bin.X_BN = X_BN;
    FakeWorld world(TwoTubes(), bin);
    FakeRound round(world);
    round.Run(1);
    INFO(round.attempts_text());
    REQUIRE(round.outcome(0) == "placed");
    const PickPlan& plan = *round.attempt(0).plan;
    if (!first) first = plan;
    CHECK(plan.motion.name == first->motion.name);
    // A scan is rounded to float, so a grasp may be off by a little; jaws have two equal yaws.
    CHECK((plan.grasp.X_NG.translation() - first->grasp.X_NG.translation()).norm() < 0.001);
    CHECK(std::abs(plan.grasp.X_NG.linear().col(1).dot(first->grasp.X_NG.linear().col(1))) >
          0.9999);
    CHECK(plan.grasp.opening_m == Approx(first->grasp.opening_m));
  }
}

TEST_CASE("The two parts of a lift lead where the whole motion leads, wherever it is cut",
          "[unit]") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    RandomStream stream(seed, 0, "lift");
    FakeWorld world(TwoTubes());
    FakeRound round(world);
    round.setup.cycle.first_lift_m = stream.Uniform(0.01, 0.15);
    round.setup.planner.lift_m = stream.Uniform(0.25, 0.42);
    round.Run(1);
    INFO(round.attempts_text());
    const std::vector<FakeMotion> lifts = world.MotionsOf(MotionKind::kLift);
    REQUIRE(lifts.size() == 2);
    CHECK(lifts[0].trajectory.points.back().q == lifts[1].trajectory.points.front().q);
    const double whole_m = (lifts[1].X_BE_to.translation() - lifts[0].X_BE_from.translation()).z();
    CHECK(whole_m == Approx(round.setup.planner.lift_m).margin(1e-3));
    const double first_m = (lifts[0].X_BE_to.translation() - lifts[0].X_BE_from.translation()).z();
    CHECK(first_m == Approx(round.setup.cycle.first_lift_m).margin(1e-3));
  }
}

TEST_CASE("Parts of a split path rejoin: nothing is left out, nothing is added", "[unit]") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    RandomStream stream(seed, 0, "split");
    RigidTransform from = MakeTransform(RotX(kPi), Vector3(0.1, 0.2, 0.02));
    std::vector<RigidTransform> path;
    RigidTransform pose = from;
    for (int k = 0; k < 4; ++k) {
      pose.translation() +=
          Vector3(stream.Uniform(-0.1, 0.1), stream.Uniform(-0.1, 0.1), stream.Uniform(0.0, 0.1));
      if (stream.Uniform() < 0.3) pose.linear() = RotY(stream.Uniform(-0.5, 0.5)) * pose.linear();
      path.push_back(pose);
    }
    path.push_back(Upright(pose));
    const double cut_m = stream.Uniform(0.001, 0.3);
    const SplitPath parts = SplitAt(path, from, cut_m);
    REQUIRE_FALSE(parts.first.empty());
    // Weighed is with the tool pointing down, or at the end.
    CHECK(parts.first.back().linear().col(2).isApprox(-Vector3::UnitZ(), 0.02));
    std::vector<RigidTransform> joined = parts.first;
    joined.insert(joined.end(), parts.rest.begin(), parts.rest.end());
    std::size_t next = 0;
    RigidTransform before = from;
    double gone_m = 0.0;
    for (const RigidTransform& at : joined) {
      gone_m += (at.translation() - before.translation()).norm();
      before = at;
      while (next < path.size() && at.isApprox(path[next], 1e-9)) ++next;
    }
    CHECK(next == path.size());  // Every pose of the whole comes, in its order.
    double whole_m = 0.0;
    before = from;
    for (const RigidTransform& at : path) {
      whole_m += (at.translation() - before.translation()).norm();
      before = at;
    }
    CHECK(gone_m == Approx(whole_m));  // On straight ways between them.
  }
}

TEST_CASE("No motion that is offered takes its tube through the walls", "[unit]") {
  const Bin bin = FakeWorld::SmallBin();
  int slides = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    RandomStream stream(seed, 0, "walls");
    const TubeScene scene = PerfectScene(Pile(stream, 5), kRadius);
    PlannerConfig config;
    config.exclude_free = true;  // Only covered tubes are slid.
    const PlanResult result = PlanOf(scene, config);
    for (const CandidateMotion& motion : result.candidates) {
      if (motion.turns()) continue;  // Tips turn tubes over the walls.
      CAPTURE(motion.name, motion.tube);
      const PerceivedTube& tube =
          *std::find_if(scene.tubes.begin(), scene.tubes.end(),
                        [&](const PerceivedTube& t) { return t.id == motion.tube; });
      double worst_start_m = 1.0, worst_m = 1.0;  // Room to the walls.
      for (std::size_t k = 0; k < motion.waypoints_N.size(); ++k) {
        for (const Vector3& p_N : tube.centerline_N) {
          const Vector3 at_N = p_N + motion.waypoints_N[k];
          const double room_m =
              std::min(bin.half_x_m() - std::abs(at_N.x()), bin.half_y_m() - std::abs(at_N.y())) -
              kRadius;
          (k == 0 ? worst_start_m : worst_m) = std::min(k == 0 ? worst_start_m : worst_m, room_m);
        }
        if (k > 0 && motion.waypoints_N[k].head<2>().norm() > 0.005) ++slides;
      }
      // A tube that is nearer already may come 2 mm nearer still.
      CHECK(worst_m > std::min(config.wall_safety_m, worst_start_m - 0.002) - 1e-6);
    }
  }
  CHECK(slides > 100);
}

}  // namespace
}  // namespace tubetwin
