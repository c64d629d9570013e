// An attempt that ended where several tubes hung in the fingers, and was gone on with from there.

#include "models/base/json.h"
#include "models/base/random.h"
#include "planner/cycle/attempt_checkpoint.h"
#include "tests/support/catch.h"
#include "tests/support/fake_round.h"

namespace tubetwin {
namespace {

using test::FakeRound;
using test::FakeWorld;
using test::MotionKind;
using test::TwoTubes;

/// All but how a motion turns: quaternions are normalised when they are read.
std::string Text(const AttemptCheckpoint& state) {
  Json json = ToJson(state);
  json["plan"].erase("rotations_wxyz");
  return json.dump();
}

AttemptCheckpoint ThroughJson(const AttemptCheckpoint& state) {
  const Json json = Json::parse(ToJson(state).dump());
  return AttemptCheckpointFromJson(JsonView(json, "checkpoint"));
}

/// What a strategy is helped by: where a tube falls, if any does.
struct Course {
  std::string name;
  std::function<void(FakeWorld&)> script;
};

std::vector<Course> Courses() {
  return {
      {"none falls", [](FakeWorld&) {}},
      {"one falls in the first tilt",
       [](FakeWorld& world) { world.After(MotionKind::kTilt, 1, [&world] { world.Fall(1); }); }},
      {"one falls when let down",
       [](FakeWorld& world) { world.After(MotionKind::kLower, 1, [&world] { world.Fall(1); }); }},
      {"all fall in the first tilt",
       [](FakeWorld& world) { world.After(MotionKind::kTilt, 1, [&world] { world.Fall(2); }); }},
      {"the one that was left is lost on the way", [](FakeWorld& world) {
         world.After(MotionKind::kTilt, 1, [&world] { world.Fall(1); });
         world.During(MotionKind::kCarry, 2, [&world] { world.Fall(1); });
       }}};
}

/// All of a report that does not depend on how fast this computer is.
std::string Text(const AttemptReport& report) {
  std::string out = std::string(ToString(report.outcome)) + ", " + report.reason + ", attempt " +
                    std::to_string(report.attempt) + ", strategy " + report.strategy +
                    (report.resolution_used ? " used" : "");
  if (report.resolution_outcome) out += std::string(", ") + ToString(*report.resolution_outcome);
  for (const double number :
       {report.sim_s.scan, report.sim_s.move, report.sim_s.weigh, report.sim_s.settle,
        report.detection->force_N, report.detection->at_s, report.first_weighing->force_N}) {
    out += ", " + std::to_string(number);
  }
  return out;
}

/// Three tubes, of which the first is placed and the next grasp takes two.
std::vector<Polyline> ThreeTubes() {
  std::vector<Polyline> tubes = TwoTubes();
  tubes.push_back(StraightLine({-0.12, 0.02, 0.0125}, {0.11, 0.0, 0.0125}));
  return tubes;
}

TEST_CASE("A stored attempt goes on as if it had never been stored, with every strategy",
          "[unit]") {
  for (const ResolutionStrategy& each : ResolutionStrategies()) {
    const std::string& strategy = each.name;
    for (const Course& course : Courses()) {
      CAPTURE(strategy, course.name);
      // Without a break.
      FakeWorld whole_world(ThreeTubes());
      whole_world.Grab(1);
      whole_world.Grab(2);
      course.script(whole_world);
      FakeRound whole(whole_world);
      whole.setup.resolution.strategy = strategy;
      whole.Run(2);

      // Stored, and gone on with by another cycle on the cell as it stands.
      FakeWorld world(ThreeTubes());
      world.Grab(1);
      world.Grab(2);
      course.script(world);
      FakeRound stored(world);
      stored.setup.cycle.end_at_several = true;
      stored.Run();
      REQUIRE(stored.end() == "stored");
      REQUIRE(stored.notes.several.size() == 1);
      FakeRound rest(world);
      rest.setup.resolution.strategy = strategy;
      rest.report =
          ResumeAttempt(world.cell, rest.setup, ThroughJson(stored.notes.several[0]), rest.notes);
      rest.CheckFaults();

      CHECK(rest.end() == "stored");
      REQUIRE(rest.notes.attempts.size() == 1);
      CHECK(Text(rest.attempt(0)) == Text(whole.attempt(1)));
      CHECK(rest.report.placed_believed == whole.report.placed_believed);
      CHECK(world.log == whole_world.log);  // Every command, number by number.
    }
  }
}

TEST_CASE("What hears of a stored attempt hears its reference and its weighing first", "[unit]") {
  FakeWorld world(TwoTubes());
  world.Grab(2);
  FakeRound stored(world);
  stored.setup.cycle.end_at_several = true;
  stored.Run();
  FakeRound rest(world);
  rest.report = ResumeAttempt(world.cell, rest.setup, stored.notes.several.at(0), rest.notes);
  REQUIRE(rest.notes.references_K.size() == 1);
  CHECK(rest.notes.references_K[0].force_N == stored.notes.references_K[0].force_N);
  REQUIRE(rest.notes.detections.size() == 1);
  CHECK(rest.notes.detections[0].force_N == stored.notes.detections[0].force_N);
}

TEST_CASE("A stored attempt that is refused or stopped ends as it would have", "[unit]") {
  for (const bool refused : {true, false}) {
    CAPTURE(refused);
    FakeWorld world(TwoTubes());
    world.Grab(2);
    if (!refused) {
      world.During(MotionKind::kTilt, 1,
                   [&] { world.StopArm(ArmMode::kProtectiveStop, "a person came near"); });
    }
    if (refused) world.model.layout.p_BTilt = {1.6, 0.0, 0.575};  // Out of reach.
    FakeRound stored(world);
    stored.setup.cycle.end_at_several = true;
    stored.Run();
    REQUIRE(stored.end() == "stored");
    FakeRound rest(world);
    rest.setup.resolution.strategy = "plus45";
    rest.report = ResumeAttempt(world.cell, rest.setup, stored.notes.several.at(0), rest.notes);
    rest.CheckFaults();
    CHECK(rest.outcome(0) == (refused ? "put_back" : "fault"));
    CHECK(world.held() == (refused ? 0 : 2));
    CHECK(rest.end() == (refused ? "stored" : "fault"));
  }
}

/// A checkpoint of any numbers.
AttemptCheckpoint AnyCheckpoint(RandomStream& stream) {
  const auto number = [&] { return stream.Uniform(-2.0, 2.0) / 3.0; };
  const auto positive = [&] { return stream.Uniform(0.0, 2.0) / 3.0; };
  const auto vector = [&] { return Vector3(number(), number(), number()); };
  const auto line = [&] {
    Polyline out;
    for (int k = 0; k < 3; ++k) out.push_back(vector());
    return out;
  };
  const auto detection = [&] {
    Detection out;
    out.outcome = stream.Uniform() < 0.5 ? HeldOutcome::kOne : HeldOutcome::kSeveral;
    out.force_N = number();
    out.torque_Nm = vector();
    out.at_s = positive();
    return out;
  };
  AttemptCheckpoint state;
  AttemptReport& report = state.report;
  report.attempt = 1 + static_cast<int>(stream.Uniform(0.0, 9.0));
  report.tubes_in_bin = static_cast<int>(stream.Uniform(2.0, 40.0));
  PickPlan plan;
  plan.target = plan.motion.tube = plan.grasp.tube = static_cast<int>(stream.Uniform(1.0, 90.0));
  plan.target_class = TubeClass::kWeak;
  plan.motion.name = "escape-2";
  plan.motion.waypoints_N = line();
  if (stream.Uniform() < 0.5) {
    plan.motion.pivot_N = vector();
    for (int k = 0; k < 3; ++k) {
      plan.motion.rotations_N.emplace_back(Eigen::AngleAxisd(number(), vector().normalized()));
    }
  }
  plan.grasp.X_NG = MakeTransform(RotZ(number()) * RotX(kPi + number()), vector());
  plan.grasp.at_m = positive();
  plan.grasp.opening_m = positive();
  plan.used_simulator = stream.Uniform() < 0.5;
  if (plan.used_simulator) plan.prediction = Prediction{number(), number(), 5};
  report.plan = plan;
  report.first_weighing = detection();
  report.detection = detection();
  report.sim_s = {positive(), positive(), positive(), positive()};
  NudgeReport nudge;
  nudge.tube = 3;
  nudge.direction_N = vector();
  nudge.travel_m = number();
  nudge.rejected = "line: \"too near\"";
  if (stream.Uniform() < 0.5) report.nudges.push_back(nudge);
  state.line_E = line();
  state.reference_K = {vector(), vector()};
  state.attempt_began = TimeNs(static_cast<std::int64_t>(stream.Uniform(0.0, 1e12)));
  for (int k = 0; k < 2; ++k) state.placed_T.push_back(line());
  for (double& q : state.q) q = number();
  state.opening_m = positive();
  return state;
}

TEST_CASE("A checkpoint survives its file bit by bit", "[unit]") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    RandomStream stream(seed, 0, "checkpoint");
    const AttemptCheckpoint state = AnyCheckpoint(stream);
    const AttemptCheckpoint read = ThroughJson(state);
    CHECK(Text(read) == Text(state));
    // What the text cannot show twice wrong.
    CHECK(read.q == state.q);
    CHECK(read.report.plan->grasp.X_NG.matrix() == state.report.plan->grasp.X_NG.matrix());
    CHECK(read.report.plan->motion.waypoints_N == state.report.plan->motion.waypoints_N);
    const auto& turns = state.report.plan->motion.rotations_N;
    REQUIRE(read.report.plan->motion.rotations_N.size() == turns.size());
    for (std::size_t k = 0; k < turns.size(); ++k) {
      CHECK(read.report.plan->motion.rotations_N[k].isApprox(turns[k], 1e-14));
    }
    CHECK(read.report.detection->torque_Nm == state.report.detection->torque_Nm);
    CHECK(read.report.nudges.size() == state.report.nudges.size());
    CHECK(read.reference_K.torque_Nm == state.reference_K.torque_Nm);
    CHECK(read.placed_T == state.placed_T);
    CHECK(read.line_E == state.line_E);
    CHECK(read.attempt_began == state.attempt_began);
  }
}

TEST_CASE("A checkpoint that lacks something is refused by the name of what is missing", "[unit]") {
  RandomStream stream(7, 0, "checkpoint");
  const Json whole = ToJson(AnyCheckpoint(stream));
  for (const auto& [key, value] : whole.items()) {
    if (key == "nudges" || key == "phases_s") continue;  // Older files have none.
    CAPTURE(key);
    Json torn = whole;
    torn.erase(key);
    CHECK_THROWS_WITH(AttemptCheckpointFromJson(JsonView(torn, "checkpoint")),
                      Catch::Contains(key));
  }
}

}  // namespace
}  // namespace tubetwin
