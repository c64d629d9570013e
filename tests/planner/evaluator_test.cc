#include "planner/evaluator/evaluator.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/json.h"
#include "models/part.h"
#include "planner/evaluator/rollout.h"
#include "planner/extraction/generators.h"
#include "tests/support/catch.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

const std::vector<Vector3> kUp = {{0, 0, 0}, {0, 0, 0.4}};

CandidateMotion Motion(int tube, const std::string& name, std::vector<Vector3> waypoints_N) {
  CandidateMotion motion;
  motion.tube = tube;
  motion.name = name;
  motion.waypoints_N = std::move(waypoints_N);
  return motion;
}

EvaluationResult Evaluate(const TubeScene& scene, const EvaluationRequest& request,
                          const std::string& part = "pvc_a", int threads = 1) {
  EvaluatorOptions options;
  options.parallelism.threads = threads;
  options.gripper = FirstGripper();
  return MakeEvaluator(options)(scene, LoadPart(part), Bin{}, request);
}

EvaluationRequest Request(std::vector<CandidateMotion> candidates, const TubeScene& scene,
                          double share = 0.5) {
  EvaluationRequest request;
  for (const CandidateMotion& candidate : candidates) {
    for (const PerceivedTube& tube : scene.tubes) {
      if (tube.id == candidate.tube) {
        request.grasp_at_m.push_back(share * Length(tube.centerline_N));
      }
    }
  }
  request.candidates = std::move(candidates);
  return request;
}

// Tube 1 lies along x on the floor; tube 2 leans over it near its +x end, its own far end down.
TubeScene Covered() {
  return PerfectScene({StraightLine({-0.25, 0, kRadius}, {0.25, 0, kRadius}),
                       StraightLine({0.19, -0.24, kRadius}, {0.19, 0.24, 0.06})},
                      kRadius);
}

TEST_CASE("A free tube is lifted at no cost and needs no roll-out", "[physics]") {
  const TubeScene scene = Covered();
  EvaluationRequest request = Request({Motion(2, "up", kUp)}, scene);
  const EvaluationResult pruned = Evaluate(scene, request);
  REQUIRE(pruned.candidates.size() == 1);
  CHECK(pruned.candidates[0].status == CandidateScore::Status::kPruned);
  CHECK(pruned.candidates[0].displacement_m == 0.0);
  CHECK(pruned.candidates[0].samples.empty());
  CHECK(pruned.best == 0);

  request.full = true;
  const EvaluationResult full = Evaluate(scene, request);
  CHECK(full.candidates[0].status == CandidateScore::Status::kDone);
  CHECK(full.candidates[0].cost < 0.005);  // Nothing but the friction of one line contact.
  CHECK(full.candidates[0].sim_s > 1.6);   // 0.4 m at 0.25 m/s, never cut short.
}

TEST_CASE("A leg profile knows from when on it only rises") {
  CHECK(LegProfile(kUp, 0.25).RisingFrom() == 0.0);
  const LegProfile aside({{0, 0, 0}, {0, 0.1, 0}, {0, 0.1, 0.2}, {0, 0.1, 0.4}}, 0.25);
  CHECK(aside.RisingFrom() == Approx(0.1 / 0.25 + 0.15));
  const LegProfile down({{0, 0, 0}, {0, 0, 0.1}, {0, 0, 0}}, 0.25);
  CHECK(down.RisingFrom() == down.duration_s());
}

TEST_CASE("Lifting a covered tube takes the other along", "[physics]") {
  const TubeScene scene = Balanced();
  REQUIRE(scene.tubes[0].tube_class == TubeClass::kWeak);
  const EvaluationResult result = Evaluate(scene, Request({Motion(1, "up", kUp)}, scene, 0.4));
  REQUIRE(result.candidates.size() == 1);
  const CandidateScore& up = result.candidates[0];
  CHECK(up.status == CandidateScore::Status::kDone);
  CHECK(up.cost == up.displacement_m);         // One sample: the paper's cost.
  CHECK(up.cost == Approx(0.4).margin(0.02));  // It rides all the way.
  CHECK(up.extra_probability == 1.0);
}

TEST_CASE("A hose that arches over another one comes along", "[physics]") {
  constexpr double r = 0.010;
  Polyline arch;
  for (int k = 0; k <= 40; ++k) {
    const double angle = kPi * k / 40;
    arch.push_back({0.15, 0.1 * std::cos(angle), 0.03 + 0.03 * std::sin(angle)});
  }
  const TubeScene scene = PerfectScene({StraightLine({-0.2, 0, r}, {0.2, 0, r}), arch}, r);
  EvaluationRequest request = Request({Motion(1, "up", kUp)}, scene, 0.4);
  const EvaluationResult result = Evaluate(scene, request, "hose_b");
  REQUIRE(result.candidates[0].status == CandidateScore::Status::kDone);
  CHECK(result.candidates[0].extra_probability == 1.0);
  CHECK(result.candidates[0].displacement_m > 0.2);
}

TEST_CASE("A tube that is driven into a wall jams instead of going through", "[physics]") {
  const TubeScene scene =
      PerfectScene({StraightLine({-0.2, 0.2, kRadius}, {0.2, 0.2, kRadius})}, kRadius);
  EvaluationRequest request =
      Request({Motion(1, "into the wall", {{0, 0, 0}, {0, 0, 0.02}, {0, 0.4, 0.02}})}, scene);
  request.full = true;  // Else it would be pruned: no other tube is touched.
  const EvaluationResult result = Evaluate(scene, request);
  CHECK(result.candidates[0].status == CandidateScore::Status::kJammed);
  CHECK(result.candidates[0].cost >= 1.0);

  // With another tube between it is not pruned, and the roll-out ends at the jam.
  const TubeScene pressed =
      PerfectScene({StraightLine({-0.2, 0.2, kRadius}, {0.2, 0.2, kRadius}),
                    StraightLine({-0.2, 0.25, kRadius}, {0.2, 0.25, kRadius})},
                   kRadius);
  request.full = false;
  request.candidates[0].waypoints_N = {{0, 0, 0}, {0, 0.4, 0}};
  const EvaluationResult cut = Evaluate(pressed, request);
  CHECK(cut.candidates[0].status == CandidateScore::Status::kJammed);
  CHECK(cut.candidates[0].sim_s < 1.2);  // The whole motion would take 1.75 s.
}

TEST_CASE("The fingers push a tube that the held one would not touch", "[physics]") {
  // Its surface comes 5 mm short of the other tube, the fingers reach 8 mm into it.
  const TubeScene scene = PerfectScene({StraightLine({-0.2, 0, kRadius}, {0.2, 0, kRadius}),
                                        StraightLine({-0.2, 0.06, kRadius}, {0.2, 0.06, kRadius})},
                                       kRadius);
  EvaluationRequest request = Request({Motion(1, "aside", {{0, 0, 0}, {0, 0.03, 0}})}, scene);
  const EvaluationResult result = Evaluate(scene, request);
  REQUIRE(result.candidates[0].status == CandidateScore::Status::kDone);
  CHECK(result.candidates[0].displacement_m > 0.006);
  // Straight up they leave as they came.
  request.candidates[0].waypoints_N = kUp;
  CHECK(Evaluate(scene, request).candidates[0].status == CandidateScore::Status::kPruned);
}

TEST_CASE("A roll-out ends once nothing lies over a tube that only rises", "[physics]") {
  // Tube 1 leaves the one that it lies against, then goes up. Another stands high beside it.
  const TubeScene scene = PerfectScene(
      {StraightLine({-0.25, 0, kRadius}, {0.25, 0, kRadius}),
       StraightLine({0.1, 0.027, kRadius}, {0.25, 0.027, kRadius}),
       {{-0.1, 0.24, kRadius}, {-0.3, 0.24, kRadius}, {-0.3, 0.1, kRadius}, {-0.3, 0.1, 0.2}}},
      kRadius);
  EvaluationRequest request =
      Request({Motion(1, "out", {{0, 0, 0}, {0, -0.1, 0}, {0, -0.1, 0.4}})}, scene);
  const CandidateScore cut = Evaluate(scene, request).candidates[0];
  REQUIRE(cut.status == CandidateScore::Status::kDone);
  CHECK(cut.sim_s < 1.2);  // Over the standing one only after 1.5 s.
  request.full = true;
  const CandidateScore full = Evaluate(scene, request).candidates[0];
  CHECK(full.sim_s > 2.4);
  CHECK(cut.displacement_m == Approx(full.displacement_m).margin(0.005));
}

// Everything but the wall times.
void CheckSame(const CandidateScore& a, const CandidateScore& b) {
  CHECK(a.tube == b.tube);
  CHECK(a.motion == b.motion);
  CHECK(a.status == b.status);
  CHECK(a.displacement_m == b.displacement_m);
  CHECK(a.extra_probability == b.extra_probability);
  CHECK(a.cost == b.cost);
  CHECK(a.sim_s == b.sim_s);
  CHECK(a.samples == b.samples);
}

TEST_CASE("A roll-out is given up once it has displaced the others by too much", "[physics]") {
  const TubeScene scene = Balanced();
  EvaluatorOptions options;
  options.config.give_up_m = 0.1;
  options.gripper = FirstGripper();
  const auto evaluate = MakeEvaluator(options);
  // As it goes aside in the end, riding along tells nothing before.
  EvaluationRequest request =
      Request({Motion(1, "out", {{0, 0, 0}, {0, 0, 0.4}, {0, 0.05, 0.4}})}, scene, 0.4);
  const CandidateScore cut = evaluate(scene, LoadPart("pvc_a"), Bin{}, request).candidates[0];
  CHECK(cut.status == CandidateScore::Status::kDone);
  CHECK(cut.lower_bound);
  CHECK(cut.displacement_m > 0.1);
  CHECK(cut.displacement_m < 0.15);  // Looked at every 50 ms.
  request.give_up_m = {0.05};        // The smaller of both limits holds.
  const CandidateScore sooner = evaluate(scene, LoadPart("pvc_a"), Bin{}, request).candidates[0];
  CHECK(sooner.displacement_m > 0.05);
  CHECK(sooner.displacement_m < 0.1);
  request.full = true;
  const CandidateScore full = evaluate(scene, LoadPart("pvc_a"), Bin{}, request).candidates[0];
  CHECK_FALSE(full.lower_bound);
  CHECK(full.displacement_m > cut.displacement_m);
  CHECK(full.sim_s > 1.5 * cut.sim_s);
}

TEST_CASE("A roll-out ends once another tube rides along for sure", "[physics]") {
  const TubeScene scene = Balanced();
  EvaluationRequest request = Request({Motion(1, "up", kUp)}, scene, 0.4);
  const CandidateScore cut = Evaluate(scene, request).candidates[0];
  CHECK(cut.sim_s < 0.7);  // Of 2.05 s.
  CHECK_FALSE(cut.lower_bound);
  CHECK(cut.extra_probability == 1.0);
  request.full = true;
  const CandidateScore full = Evaluate(scene, request).candidates[0];
  CHECK(full.sim_s > 2.0);
  CHECK(cut.displacement_m == Approx(full.displacement_m).margin(0.01));
  CHECK(full.extra_probability == 1.0);
}

TEST_CASE("Scores depend neither on threads nor on order nor on what ran before", "[physics]") {
  const TubeScene scene =
      PerfectScene({StraightLine({-0.25, 0, kRadius}, {0.25, 0, kRadius}),
                    StraightLine({0.10, -0.2, 3 * kRadius}, {0.10, 0.2, 3 * kRadius}),
                    StraightLine({-0.2, -0.15, 5 * kRadius}, {0.2, 0.1, 5 * kRadius})},
                   kRadius);
  std::vector<CandidateMotion> candidates;
  for (const PerceivedTube& tube : scene.tubes) {
    for (const CandidateMotion& motion : MotionsOf(kPaperKinds, scene, tube).motions) {
      candidates.push_back(motion);
    }
  }
  REQUIRE(candidates.size() >= 5);
  EvaluationRequest request = Request(candidates, scene, 0.3);
  request.samples = 2;
  const EvaluationResult one = Evaluate(scene, request);
  const EvaluationResult again = Evaluate(scene, request);
  const EvaluationResult two = Evaluate(scene, request, "pvc_a", 2);
  EvaluationRequest backwards = request;
  std::reverse(backwards.candidates.begin(), backwards.candidates.end());
  std::reverse(backwards.grasp_at_m.begin(), backwards.grasp_at_m.end());
  const EvaluationResult turned = Evaluate(scene, backwards, "pvc_a", 2);
  bool samples_differ = false;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    CheckSame(one.candidates[k], again.candidates[k]);
    CheckSame(one.candidates[k], two.candidates[k]);
    CheckSame(one.candidates[k], turned.candidates[candidates.size() - 1 - k]);
    const std::vector<double>& samples = one.candidates[k].samples;
    if (samples.size() == 2 && samples[0] != samples[1]) samples_differ = true;
  }
  CHECK(samples_differ);
  CHECK(two.threads == 2);
}

TEST_CASE("Samples that are asked for one by one are those asked for together", "[physics]") {
  const TubeScene scene = Covered();
  EvaluationRequest request = Request({Motion(1, "up", kUp), Motion(2, "up", kUp)}, scene);
  request.full = true;
  request.samples = 3;
  request.first_sample = 1;
  const EvaluationResult together = Evaluate(scene, request);
  request.samples = 1;
  std::vector<double> extra(2, 0.0);
  for (int k = 0; k < 3; ++k) {
    request.first_sample = 1 + k;
    const EvaluationResult one = Evaluate(scene, request);
    for (std::size_t c = 0; c < extra.size(); ++c) {
      CHECK(one.candidates[c].samples == std::vector{together.candidates[c].samples.at(k)});
      extra[c] += one.candidates[c].extra_probability / 3.0;
    }
  }
  for (std::size_t c = 0; c < extra.size(); ++c) {
    CHECK(together.candidates[c].extra_probability == Approx(extra[c]));
  }
  CHECK(extra[0] != extra[1]);
}

TEST_CASE("scores.json has the promised fields", "[physics]") {
  const TubeScene scene = Covered();
  const Json json =
      ToJson(Evaluate(scene, Request({Motion(1, "up", kUp), Motion(2, "up", kUp)}, scene)));
  CHECK(json["schema"] == "tubetwin/scores/1");
  REQUIRE(json["candidates"].size() == 2);
  for (const char* key : {"tube", "motion", "waypoints_m", "displacement_m", "extra_probability",
                          "cost", "status", "sim_s", "wall_s", "samples"}) {
    CHECK(json["candidates"][0].contains(key));
  }
  CHECK(json["candidates"][0]["status"] == "done");
  CHECK(json["candidates"][0]["samples"].size() == 1);
  CHECK(json["candidates"][1]["status"] == "pruned");
  CHECK(json["candidates"][1]["samples"].empty());
  CHECK(json["best"] == 1);
  for (const char* key : {"settle_s", "wall_s", "threads"}) CHECK(json.contains(key));
}

TEST_CASE("Requests that make no sense are refused by name", "[unit]") {
  const TubeScene scene = Covered();
  EvaluationRequest request = Request({Motion(1, "up", kUp)}, scene);
  request.candidates[0].tube = 9;
  CHECK_THROWS_WITH(Evaluate(scene, request),
                    Catch::Contains("tube 9 is not in the scene, which has tubes 1, 2"));
  request.candidates[0].tube = 1;
  request.grasp_at_m[0] = 2.0;
  CHECK_THROWS_WITH(Evaluate(scene, request), Catch::Contains("held at 2 m, allowed 0 to 0.5 m"));
  request.grasp_at_m[0] = 0.2;
  request.candidates[0].waypoints_N[1].z() = 1e6;
  CHECK_THROWS_WITH(Evaluate(scene, request), Catch::Contains("at most 30 s are simulated"));
}

TEST_CASE("The hand keeps its speed, ramps and stops at every waypoint", "[unit]") {
  const LegProfile profile({{0, 0, 0}, {0, 0, 0.05}, {0.2, 0, 0.05}}, 0.25);
  CHECK(profile.duration_s() == Approx(0.05 / 0.25 + 0.15 + 0.2 / 0.25 + 0.15));
  CHECK(profile.At(0.0).isZero());
  CHECK(profile.At(0.35).isApprox(Vector3(0, 0, 0.05)));
  CHECK(profile.At(99.0).isApprox(Vector3(0.2, 0, 0.05)));
  double fastest = 0.0, jump = 0.0, before = 0.0;
  constexpr double kStep = 1e-3;
  for (double t = 0.0; t < profile.duration_s(); t += kStep) {
    const double speed = (profile.At(t + kStep) - profile.At(t)).norm() / kStep;
    fastest = std::max(fastest, speed);
    jump = std::max(jump, std::abs(speed - before));
    before = speed;
  }
  CHECK(fastest == Approx(0.25));
  CHECK(jump < 0.25 / 0.15 * kPi / 2 * kStep * 1.05);  // Steepest point of a half-cosine ramp.
}

TEST_CASE("The hand turns what it holds as told, as far as its torque allows", "[physics]") {
  const TubeScene scene =
      PerfectScene({StraightLine({-0.25, 0, 0.0125}, {0.25, 0, 0.0125})}, kRadius);
  const EvaluatorConfig config;
  const Part part = LoadPart("pvc_a");
  const RolloutScene world(scene, part, Bin{}, DrawSample(part, 1, 0, 1, config),
                           {Parallelism{1}, config, FirstGripper()});
  MjModel model(mj_copyModel(nullptr, &world.model()));
  MjData data = MakeData(*model);
  CandidateMotion motion = Motion(1, "turn", {{0, 0, 0}, {0, 0, 0.3}, {0, 0, 0.3}, {0, 0, 0.3}});
  const Matrix3 first = RotY(Radians(30)), second = RotZ(Radians(60)) * RotX(Radians(20));
  motion.rotations_N = {Eigen::Quaterniond::Identity(), Eigen::Quaterniond::Identity(),
                        Eigen::Quaterniond(first), Eigen::Quaterniond(second)};
  world.Grip(0, 0.3, *model, *data);
  const Matrix3 before = BodyPose(*data, world.tubes()[0].bodies()[0]).linear();
  const RolloutOutcome outcome = RollOut(world, 0, 0.3, motion, true, config, *model, *data);
  CHECK(outcome.status == CandidateScore::Status::kDone);
  const Matrix3 after = BodyPose(*data, world.tubes()[0].bodies()[0]).linear();
  const double off_rad =
      Eigen::AngleAxisd(Matrix3(after * before.transpose() * second.transpose())).angle();
  CHECK(off_rad < 0.01);  // The tube's weight turns the hand by 0.2 mrad, the servo lags no more.

  // Turned into the floor.
  CandidateMotion into = Motion(1, "into", {{0, 0, 0}, {0, 0, 0}});
  into.rotations_N = {Eigen::Quaterniond::Identity(), Eigen::Quaterniond(first)};
  CHECK(RollOut(world, 0, 0.5, into, true, config, *model, *data).status ==
        CandidateScore::Status::kJammed);
}

TEST_CASE("Legs that turn take as long as the slower of way and turn", "[unit]") {
  const Eigen::Quaterniond none = Eigen::Quaterniond::Identity(), half(RotX(0.5));
  const LegProfile turn({{0, 0, 0}, {0, 0, 0}}, 0.25, {none, half}, 0.5);
  CHECK(turn.duration_s() == Approx(0.5 / 0.5 + 0.15));
  CHECK(turn.TurnAt(0.5 * turn.duration_s()).angularDistance(none) == Approx(0.25));
  CHECK(turn.TurnAt(99.0).angularDistance(half) == Approx(0.0).margin(1e-9));
  const LegProfile both({{0, 0, 0}, {0, 0, 0.5}}, 0.25, {none, half}, 0.5);
  CHECK(both.duration_s() == Approx(0.5 / 0.25 + 0.15));
  CHECK(both.At(0.5 * both.duration_s()).z() == Approx(0.25));
  CHECK(both.TurnAt(0.5 * both.duration_s()).angularDistance(none) == Approx(0.25));
}

}  // namespace
}  // namespace tubetwin
