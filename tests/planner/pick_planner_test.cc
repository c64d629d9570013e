#include "planner/pick/pick_planner.h"

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "models/base/json.h"
#include "models/part.h"
#include "planner/pick/rollout_scheduler.h"
#include "planner/scene_query/voxel_downsample.h"
#include "tests/support/catch.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

std::optional<std::string> Always(const Grasp&, const CandidateMotion&) { return std::nullopt; }

// Likes "escape-", sees "up" bring another tube along and "escape+" jam; keeps what it was asked.
struct FakeEvaluator {
  int calls = 0;
  double sim_s = 0.0;     // Of each roll-out.
  bool hopeless = false;  // Every motion brings others along.
  EvaluationRequest first, last;
  std::vector<EvaluationRequest> requests;
  EvaluateFunction Function() {
    return [this](const TubeScene&, const Part&, const Bin&, const EvaluationRequest& r) {
      if (calls++ == 0) first = r;
      last = r;
      requests.push_back(r);
      EvaluationResult result;
      for (const CandidateMotion& candidate : r.candidates) {
        CandidateScore score;
        score.tube = candidate.tube;
        score.motion = candidate.name;
        score.sim_s = sim_s * r.samples;
        const bool quiet = candidate.name == "escape-" && !hopeless;
        score.displacement_m = score.cost = quiet ? 0.01 : 0.9;
        score.extra_probability = candidate.name == "up" || hopeless ? 1.0 : 0.0;
        score.samples.assign(hopeless ? r.samples : 0, score.displacement_m);
        if (candidate.name == "escape+") score.status = CandidateScore::Status::kJammed;
        result.candidates.push_back(score);
      }
      result.best = 0;
      return result;
    };
  }
};

// Tube 1 along x under tube 2.
TubeScene LopsidedCross() {
  return PerfectScene({StraightLine({-0.15, 0, kRadius}, {0.25, 0, kRadius}),
                       StraightLine({0.05, -0.2, 3 * kRadius}, {0.05, 0.2, 3 * kRadius})},
                      kRadius);
}

PlanResult Plan(const TubeScene& scene, const PlannerConfig& config, FakeEvaluator& evaluator,
                const FeasibilityFunction& feasible = Always) {
  Part part;
  part.length_m = 0.40;
  const Bin bin;
  const std::vector<Vector3> no_points;
  return PlanPicks(
      {scene, no_points, part, bin, FirstGripper(), config, ExtractionMotionsOf(config)},
      evaluator.Function(), feasible);
}

bool AnyReason(const PlanResult& result, int tube, const std::string& text) {
  for (const Rejection& rejection : result.rejections) {
    if (rejection.tube == tube && rejection.reason.find(text) != std::string::npos) return true;
  }
  return false;
}

TEST_CASE("A free tube is picked upwards without asking the simulator", "[unit]") {
  FakeEvaluator evaluator;
  const PlanResult result = Plan(LopsidedCross(), PlannerConfig{}, evaluator);
  CHECK(evaluator.calls == 0);
  REQUIRE(result.plans.size() == 3);  // plans_per_tube, for the one free tube.
  for (const PickPlan& plan : result.plans) {
    CHECK(plan.target == 2);
    CHECK(plan.motion.name == "up");
    CHECK_FALSE(plan.used_simulator);
  }
  CHECK(result.plans[0].cost <= result.plans[1].cost);
  CHECK(std::abs(result.plans[0].grasp.at_m - result.plans[1].grasp.at_m) >= 0.0199);
  CHECK(result.plans[0].grasp.at_m == Approx(0.20));  // The centre of mass.
}

TEST_CASE("Of two free tubes the one that sets others free is picked first", "[unit]") {
  FakeEvaluator evaluator;
  TubeScene scene = LopsidedCross();
  // Tube 3 lies alone.
  scene.tubes.push_back(
      PerfectScene({StraightLine({-0.25, -0.2, kRadius}, {-0.25, 0.2, kRadius})}, kRadius)
          .tubes[0]);
  scene.tubes.back().id = 3;
  CHECK(ReleasedBy(scene, 2) == 1);
  CHECK(ReleasedBy(scene, 1) == 0);
  CHECK(ReleasedBy(scene, 3) == 0);
  PlannerConfig config;
  config.weight_height = config.weight_clearance = config.weight_centre = 0.0;
  const PlanResult result = Plan(scene, config, evaluator);
  REQUIRE_FALSE(result.plans.empty());
  CHECK(result.plans.front().target == 2);
  config.weight_release = 0.0;
  const PlanResult without = Plan(scene, config, evaluator);
  CHECK(result.plans.front().cost - without.plans.front().cost == Approx(0.1 * 2 / 3));
}

TEST_CASE("By occluded joints a strongly occluded tube is no candidate", "[unit]") {
  FakeEvaluator evaluator;
  TubeScene scene = LopsidedCross();
  scene.tubes[0].class_paper = TubeClass::kFree;  // Although a tube lies over it.
  scene.tubes[1].class_paper = TubeClass::kStrong;
  PlannerConfig config;
  config.classes = "occluded_joints";
  const PlanResult result = Plan(scene, config, evaluator);
  REQUIRE_FALSE(result.plans.empty());
  for (const PickPlan& plan : result.plans) {
    CHECK(plan.target == 1);
    CHECK(plan.target_class == TubeClass::kFree);
  }
  config.exclude_free = true;
  const PlanResult without_free = Plan(scene, config, evaluator);
  CHECK(without_free.plans.empty());
  CHECK(AnyReason(without_free, 2, "strongly occluded"));
}

TEST_CASE("With free tubes excluded the simulator decides, and a jam comes last", "[unit]") {
  FakeEvaluator evaluator;
  PlannerConfig config;
  config.exclude_free = true;
  config.plans_per_tube = 100;
  config.max_plans = 100;
  const PlanResult result = Plan(LopsidedCross(), config, evaluator);
  CHECK(evaluator.calls == 3);  // One sample of all, then two and two of the best.  // All motions
                                // once, then the best ones with all samples.
  CHECK(evaluator.first.samples == 1);
  REQUIRE(evaluator.first.candidates.size() == 3);
  REQUIRE(evaluator.first.grasp_at_m.size() == 3);
  CHECK(evaluator.last.first_sample + evaluator.last.samples == config.samples);
  REQUIRE_FALSE(result.plans.empty());
  CHECK(result.plans.front().target == 1);
  CHECK(result.plans.front().motion.name == "escape-");
  CHECK(result.plans.front().used_simulator);
  CHECK(result.plans.back().motion.name == "escape+");
  CHECK_THAT(result.plans.back().note, Catch::Contains("jammed"));
  CHECK(AnyReason(result, 2, "free tubes are excluded"));
}

TEST_CASE("Motions are rolled out as far as they may still be among the best", "[unit]") {
  // Three pairs as in Cross(), side by side: nine motions.
  std::vector<Polyline> lines_N;
  for (const double y : {-0.18, 0.0, 0.18}) {
    lines_N.push_back(StraightLine({-0.15, y, kRadius}, {0.25, y, kRadius}));
    lines_N.push_back(StraightLine({0.05, y - 0.08, 3 * kRadius}, {0.05, y + 0.08, 3 * kRadius}));
  }
  const TubeScene scene = PerfectScene(lines_N, kRadius);
  PlannerConfig config;
  config.exclude_free = true;
  config.refined = 1;
  FakeEvaluator evaluator;
  Plan(scene, config, evaluator);
  REQUIRE(evaluator.calls >= 2);
  for (const double limit_m : evaluator.requests[0].give_up_m) CHECK(std::isinf(limit_m));
  REQUIRE(evaluator.requests[1].first_sample == 0);  // More motions.
  REQUIRE_FALSE(evaluator.requests[1].give_up_m.empty());
  // The best so far displaces 1 cm; nothing else that differs between motions is worth 30 cm.
  for (const double limit_m : evaluator.requests[1].give_up_m) {
    CHECK(limit_m >= 0.0);
    CHECK(limit_m < 0.3);
  }

  FakeEvaluator slow;
  slow.sim_s = config.max_simulated_s * 3.0 * 7.0 / 6.0 / 6.0;  // Six motions of six rigid tubes.
  const PlanResult cut = Plan(scene, config, slow);
  CHECK(slow.calls == 1);
  CHECK_FALSE(cut.plans.empty());
  int left = 0;
  const std::string spent = "not rolled out: the 105 s of planner.max_simulated_s are spent";
  for (const Rejection& rejection : cut.rejections) left += rejection.reason == spent ? 1 : 0;
  CHECK(left > 0);
}

TEST_CASE("Where nothing promises a tube alone, all is asked once before anything is asked again",
          "[unit]") {
  std::vector<Polyline> lines_N;
  for (const double y : {-0.1, 0.1}) {
    lines_N.push_back(StraightLine({-0.15, y, kRadius}, {0.25, y, kRadius}));
    lines_N.push_back(StraightLine({0.05, y - 0.08, 3 * kRadius}, {0.05, y + 0.08, 3 * kRadius}));
  }
  PlannerConfig config;
  config.exclude_free = true;
  FakeEvaluator evaluator;
  evaluator.hopeless = true;
  Plan(PerfectScene(lines_N, kRadius), config, evaluator);
  std::set<int> separated;
  bool again = false;
  for (const EvaluationRequest& request : evaluator.requests) {
    if (request.first_sample > 0) again = true;
    for (const CandidateMotion& candidate : request.candidates) {
      if (candidate.name != "up_slow" || request.first_sample > 0) continue;
      separated.insert(candidate.tube);
      CHECK_FALSE(again);
    }
  }
  CHECK(separated == std::set<int>{1, 3});
  CHECK(again);
}

TEST_CASE("Of the ways of one tip the first that the arm can run is rolled out", "[unit]") {
  PlannerConfig config;
  config.exclude_free = true;
  FakeEvaluator evaluator;
  evaluator.hopeless = true;
  const auto turned_only = [](const Grasp&,
                              const CandidateMotion& motion) -> std::optional<std::string> {
    if (!motion.turns() ||
        motion.rotations_N.back().angularDistance(Eigen::Quaterniond::Identity()) > Radians(30.0)) {
      return std::nullopt;
    }
    return "the forearm is in the way";
  };
  Plan(LopsidedCross(), config, evaluator, turned_only);
  std::map<std::string, int> rolled_out;
  for (const EvaluationRequest& request : evaluator.requests) {
    if (request.first_sample > 0) continue;
    for (const CandidateMotion& motion : request.candidates) {
      ++rolled_out[motion.name];
      if (motion.name != "roll" && motion.name != "pitch") continue;
      const Vector3 x = motion.rotations_N.back() * Vector3::UnitX();
      CHECK(Degrees(std::atan2(x.y(), x.x())) == Approx(60.0));
    }
  }
  CHECK(rolled_out["roll"] == 1);
  CHECK(rolled_out["pitch"] == 1);
}

TEST_CASE("What a motion displaces foretells company, unless it tips the tube", "[unit]") {
  const Part hose = LoadPart("hose_b");
  CandidateScore score;
  score.displacement_m = 0.3;
  score.samples.assign(5, score.displacement_m);
  CHECK(ExtraProbability(score, hose) == Approx(0.5 * 2.2 * 0.25));
  score.rotations_N = {Eigen::Quaterniond::Identity(),
                       Eigen::Quaterniond(Eigen::AngleAxisd(Radians(90.0), Vector3::UnitZ())),
                       Eigen::Quaterniond(Eigen::AngleAxisd(Radians(20.0), Vector3::UnitX()))};
  CHECK(ExtraProbability(score, hose) == Approx(0.5 * 2.2 * 0.25));
  score.rotations_N.emplace_back(Eigen::AngleAxisd(Radians(-75.0), Vector3::UnitX()));
  CHECK(ExtraProbability(score, hose) == Approx(0.15 / 6));
  score.extra_probability = 1.0;
  CHECK(ExtraProbability(score, hose) == Approx((5 + 0.15) / 6));
}

TEST_CASE("What company a displacement foretells is the part's own", "[unit]") {
  Part part = LoadPart("hose_b");
  part.search = {"mine", 1.0, 0.1, 0.05, 0.6, 3.0, 0.4};
  CandidateScore score;
  score.samples.assign(3, 0.0);
  const auto at = [&](double displacement_m) {
    score.displacement_m = displacement_m;
    return ExtraProbability(score, part);
  };
  CHECK(at(0.0) == Approx(0.5 * 0.05));
  CHECK(at(0.4) == Approx(0.5 * 0.3));
  CHECK(at(2.0) == Approx(0.5 * 0.6));
  part.kind = "rigid";  // Simulated exactly: the line counts as one sample.
  CHECK(at(2.0) == Approx(0.25 * 0.6));
  score.rotations_N = {Eigen::Quaterniond::Identity(),
                       Eigen::Quaterniond(Eigen::AngleAxisd(Radians(75.0), Vector3::UnitX()))};
  CHECK(at(2.0) == Approx(0.25 * 0.4));
}

TEST_CASE("Little covered tubes are simulated first, the others only if need be", "[unit]") {
  // Tube 1 under tubes 2 and 3, tube 4 under tube 5; 2, 3 and 5 are free but excluded.
  const TubeScene scene =
      PerfectScene({StraightLine({-0.2, 0.1, kRadius}, {0.2, 0.1, kRadius}),
                    StraightLine({-0.1, 0.0, 3 * kRadius}, {-0.1, 0.2, 3 * kRadius}),
                    StraightLine({0.1, 0.0, 3 * kRadius}, {0.1, 0.2, 3 * kRadius}),
                    StraightLine({-0.2, -0.15, kRadius}, {0.2, -0.15, kRadius}),
                    StraightLine({0.0, -0.25, 3 * kRadius}, {0.0, -0.05, 3 * kRadius})},
                   kRadius);
  PlannerConfig config;
  config.exclude_free = true;
  config.max_candidates = 1;
  config.samples = 1;
  FakeEvaluator evaluator;
  const PlanResult result = Plan(scene, config, evaluator);
  CHECK(evaluator.calls == 1);
  REQUIRE_FALSE(result.plans.empty());
  for (const PickPlan& plan : result.plans) CHECK(plan.target == 4);

  FakeEvaluator again;
  const auto not_four = [](const Grasp& grasp,
                           const CandidateMotion&) -> std::optional<std::string> {
    if (grasp.tube == 4) return "too far";
    return std::nullopt;
  };
  const PlanResult other = Plan(scene, config, again, not_four);
  CHECK(again.calls == 1);  // What the arm cannot run is not simulated.
  REQUIRE_FALSE(other.plans.empty());
  CHECK(other.plans.front().target == 1);
}

TEST_CASE("A short tube comes last but comes", "[unit]") {
  FakeEvaluator evaluator;
  const TubeScene scene = PerfectScene({StraightLine({-0.2, 0.1, kRadius}, {0.2, 0.1, kRadius}),
                                        StraightLine({-0.1, -0.1, 0.05}, {0.1, -0.1, 0.05})},
                                       kRadius);
  const PlanResult result = Plan(scene, PlannerConfig{}, evaluator);
  REQUIRE(result.plans.size() == 6);
  CHECK(result.plans.front().target == 1);
  CHECK(result.plans.front().note.empty());
  CHECK(result.plans.back().target == 2);
  CHECK_THAT(result.plans.back().note, Catch::Contains("only 50 % of the part's length"));
}

TEST_CASE("Doubt about a free tube puts a covered one first", "[unit]") {
  FakeEvaluator evaluator;
  TubeScene scene = LopsidedCross();
  scene.tubes[1].confidence = 0.1;
  const PlanResult result = Plan(scene, PlannerConfig{}, evaluator);
  CHECK(evaluator.calls > 0);
  REQUIRE_FALSE(result.plans.empty());
  CHECK(result.plans.front().target == 1);
  bool doubtful = false;
  for (const PickPlan& plan : result.plans) doubtful = doubtful || plan.target == 2;
  CHECK(doubtful);
}

TEST_CASE("What the arm refuses is left out with its reason, the turned yaw is tried", "[unit]") {
  FakeEvaluator evaluator;
  const PlanResult refused =
      Plan(LopsidedCross(), PlannerConfig{}, evaluator,
           [](const Grasp&, const CandidateMotion&) { return std::string("out of reach"); });
  CHECK(refused.plans.empty());
  CHECK(AnyReason(refused, 1, "arm: out of reach"));
  CHECK(AnyReason(refused, 2, "arm: out of reach"));

  const auto wants = [](const Grasp& grasp, const CandidateMotion&) -> std::optional<std::string> {
    if ((Bin{}.X_BN.linear() * grasp.X_NG.linear().col(0)).x() < -0.5) return std::nullopt;
    return "wrist limit";
  };
  const PlanResult turned = Plan(LopsidedCross(), PlannerConfig{}, evaluator, wants);
  REQUIRE_FALSE(turned.plans.empty());
  CHECK(turned.plans[0].grasp.X_NG.linear().col(2).isApprox(-Vector3::UnitZ()));
}

TEST_CASE("A tube that the gripper cannot get at is named with a reason", "[unit]") {
  FakeEvaluator evaluator;
  const double y = 0.29 - kRadius;  // Touches the wall over its whole length.
  const TubeScene scene =
      PerfectScene({StraightLine({-0.2, y, kRadius}, {0.2, y, kRadius})}, kRadius);
  const PlanResult result = Plan(scene, PlannerConfig{}, evaluator);
  CHECK(result.plans.empty());
  CHECK(
      AnyReason(result, 1, "no place where the gripper fits, upright or leaning, for example at"));
  CHECK(AnyReason(result, 1, "from the bin's wall"));
}

TEST_CASE("plan.json lists ranking, candidates and reasons", "[unit]") {
  FakeEvaluator evaluator;
  PlannerConfig config;
  config.exclude_free = true;
  const Json json = ToJson(Plan(LopsidedCross(), config, evaluator));
  CHECK(json["schema"] == "tubetwin/plan/1");
  CHECK(json["ranking"].size() == 3);
  CHECK(json["ranking"][0]["class"] == "weak");
  CHECK(json["candidates"].size() == 5);  // up, two escapes, two ways out.
  CHECK(json["evaluation"]["schema"] == "tubetwin/scores/1");
  CHECK(json["evaluation"]["candidates"][1]["status"] == "jammed");
}

TEST_CASE("Points are thinned to one per cube, without floor and walls", "[unit]") {
  OrganizedCloud cloud;
  cloud.p_SP = {{0, 0, 0.05f},     {0.0002f, 0, 0.05f}, {0.1f, 0, 0.05f},
                {0.1f, 0, 0.001f}, {0.384f, 0, 0.05f},  InvalidPoint()};
  cloud.width = 6;
  cloud.height = 1;
  const std::vector<Vector3> points = VoxelDownsample({cloud, cloud}, Bin{});
  REQUIRE(points.size() == 2);
  CHECK(points[0].isApprox(Vector3(0, 0, 0.05), 1e-6));
}

}  // namespace
}  // namespace tubetwin
