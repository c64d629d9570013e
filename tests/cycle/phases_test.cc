// Every moment of an attempt belongs to one phase.

#include "models/base/json.h"
#include "tests/support/catch.h"
#include "tests/support/fake_round.h"

namespace tubetwin {
namespace {

using test::FakeRound;
using test::FakeTube;
using test::FakeWorld;
using test::MotionKind;
using test::TwoTubes;

constexpr double kRounding_s = 1e-9;  ///< Sums of whole nanoseconds.

/// How long each attempt took by the cell's clock, from the end of the one before.
std::vector<double> TimesOf(FakeRound& round, int attempts) {
  std::vector<double> out;
  double before_s = Seconds(round.world.cell.clock.Now());
  round.notes.on_attempt_end = [&] {
    const double now_s = Seconds(round.world.cell.clock.Now());
    out.push_back(now_s - before_s);
    before_s = now_s;
  };
  round.Run(attempts);
  return out;
}

TEST_CASE("The phases of an attempt sum up to its time, whatever comes of it", "[unit]") {
  FakeWorld world(TwoTubes());
  world.After(MotionKind::kCarry, 1, [&] { world.Fall(1); });  // Lost on the way to the tray.
  FakeRound round(world);
  const std::vector<double> times_s = TimesOf(round, 2);
  INFO(round.attempts_text());
  REQUIRE(times_s.size() == 2);
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    CHECK(round.attempt(k).phases_s.total() == Approx(times_s[k]).margin(kRounding_s));
    // What the older sums know of it is no more.
    CHECK(round.attempt(k).sim_s.total() <= times_s[k] + kRounding_s);
  }
}

TEST_CASE("A pick spends its time where its steps are", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  round.Run();
  REQUIRE(round.outcome(0) == "placed");
  REQUIRE(round.outcome(1) == "placed");
  for (std::size_t k = 0; k < 2; ++k) {
    const AttemptReport& attempt = round.attempt(k);
    for (const NamedPhase& named : AttemptPhases()) {
      CAPTURE(k, named.name);
      const double seconds = attempt.phases_s.*named.phase;
      if (named.phase == &AttemptReport::Phases::recover) {
        CHECK(seconds == 0.0);  // Nothing went wrong.
      } else if (named.phase != &AttemptReport::Phases::look &&
                 named.phase != &AttemptReport::Phases::close) {
        CHECK(seconds > 0.0);  // Scanner and fingers of the fake cell are done at once.
      }
    }
    // The waits for the load and the tare before it.
    CHECK(attempt.phases_s.weigh ==
          Approx(attempt.sim_s.weigh + attempt.sim_s.settle).margin(kRounding_s));
    CHECK(attempt.phases_s.look == Approx(attempt.sim_s.scan).margin(kRounding_s));
  }
}

TEST_CASE("What goes back into the bin is recovery, not placing", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  world.After(MotionKind::kLift, 1, [&] { world.Fall(1); });
  round.Run(1);
  INFO(round.attempts_text());
  REQUIRE(round.outcome(0) != "placed");
  CHECK(round.attempt(0).phases_s.recover > 0.0);
  CHECK(round.attempt(0).phases_s.place == 0.0);
  CHECK(round.attempt(0).phases_s.carry == 0.0);
}

TEST_CASE("What is computed after the last attempt is told of the round's end, once", "[unit]") {
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  round.Run();
  REQUIRE(round.end() == "empty");
  const AttemptReport::ComputeTime& last = round.report.compute_s;
  CHECK(last.modelling > 0.0);  // The look that found the bin empty.
  CHECK(last.planning == 0.0);
  CHECK(last.total == Approx(last.modelling));
  FakeWorld other(TwoTubes());
  FakeRound stopped(other);
  stopped.Run(1);
  CHECK(stopped.report.compute_s.total == 0.0);  // No look after the attempt.
}

TEST_CASE("Phases come back from files", "[unit]") {
  AttemptReport::Phases phases_s;
  double seconds = 0.1;
  for (const NamedPhase& named : AttemptPhases()) phases_s.*named.phase = seconds += 0.7;
  const Json json = ToJson(phases_s);
  CHECK(json.size() == 9);
  CHECK(json["return"] == phases_s.back);
  CHECK(ToJson(PhasesFromJson(JsonView(json, "row"))) == json);
}

}  // namespace
}  // namespace tubetwin
