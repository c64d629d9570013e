#include "twin/report/front/time_shares.h"

#include "tests/campaign/fake_rounds.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

constexpr double kRounding = 1e-9;

/// An attempt with so many seconds of look and carry, and one of computing.
AttemptRecord Attempt(AttemptOutcome outcome, double look_s, double carry_s, int placed,
                      int outside = 0) {
  AttemptRecord attempt = FakeAttempt(1, outcome, outcome == AttemptOutcome::kPlaced, placed,
                                      outside, look_s + carry_s);
  attempt.phases_s.emplace();
  attempt.phases_s->look = look_s;
  attempt.phases_s->carry = carry_s;
  return attempt;
}

/// Two placed (20 s and 30 s) and one lost outside (40 s), and 10 s in no attempt.
RoundRecord RoundOfThree() {
  RoundRecord record = Record(
      0,
      {Attempt(AttemptOutcome::kPlaced, 8, 12, 1), Attempt(AttemptOutcome::kDropped, 10, 30, 1, 1),
       Attempt(AttemptOutcome::kPlaced, 12, 18, 2, 1)},
      FakeSummary(3, 2, 1, 100.0));
  for (int i = 0; i < 3; ++i) {
    AttemptTiming timing{1, AttemptReport::ComputeTime(), 1.0};
    timing.compute_s->total = 1.0;
    record.timings.push_back(timing);
  }
  return record;
}

double Of(const NamedSeconds& seconds, const std::string& name) {
  for (const auto& [found, s] : seconds) {
    if (found == name) return s;
  }
  return -1.0;
}

const Lever& Named(const std::vector<Lever>& levers, const std::string& what) {
  for (const Lever& lever : levers) {
    if (lever.what == what) return lever;
  }
  throw std::runtime_error("no lever '" + what + "'");
}

}  // namespace

TEST_CASE("phases, computing and the rest are the whole time", "[unit]") {
  const RoundRecord record = RoundOfThree();
  const auto shares = TimeSharesOf({FactsOf(record)}, HourOf::kCellAndComputing);
  REQUIRE(shares);
  CHECK(shares->placed == 2);
  CHECK(shares->total_s == Approx(103.0));
  CHECK(Of(shares->phases_s, "look") == Approx(30.0));
  CHECK(Of(shares->phases_s, "carry") == Approx(60.0));
  CHECK(Of(shares->phases_s, "compute") == Approx(3.0));
  CHECK(shares->rest_s == Approx(10.0));
  CHECK(shares->placed_attempt_s == Approx(26.0));  // 21 and 31 s.
  REQUIRE(shares->failures.size() == 1);
  CHECK(shares->failures[0].name == "outside");
  CHECK(shares->failures[0].lost == 1);
  CHECK(shares->failures[0].time_s == Approx(41.0));
  const auto cell = TimeSharesOf({FactsOf(record)}, HourOf::kCell);
  CHECK(cell->total_s == Approx(100.0));
  CHECK(Of(cell->phases_s, "compute") == -1.0);
}

TEST_CASE("what would raise the rate is computed from the times, most first", "[unit]") {
  const RoundRecord record = RoundOfThree();
  const auto shares = TimeSharesOf({FactsOf(record)}, HourOf::kCellAndComputing);
  const std::vector<Lever> levers = LeversOf(*shares);
  const double now = 3600.0 * 2 / 103.0;
  const Lever& carry = Named(levers, "half the time of carry");
  CHECK(carry.parts_per_hour == Approx(3600.0 * 2 / 73.0).epsilon(kRounding));
  CHECK(carry.gain == Approx(carry.parts_per_hour - now).epsilon(kRounding));
  // The lost one placed in 26 s instead of lost in 41.
  CHECK(Named(levers, "no attempt ends as outside").parts_per_hour ==
        Approx(3600.0 * 3 / 88.0).epsilon(kRounding));
  for (std::size_t i = 1; i < levers.size(); ++i) CHECK(levers[i - 1].gain >= levers[i].gain);
  CHECK(levers.front().what == "no attempt ends as outside");
  for (const Lever& lever : levers) CHECK(lever.what != "half the time of weigh");  // Took none.
}

TEST_CASE("the median pick is a pick that was, of an even number the quicker", "[unit]") {
  const RoundRecord record = RoundOfThree();
  const auto pick = MedianPickOf({FactsOf(record)}, HourOf::kCellAndComputing);
  REQUIRE(pick);
  CHECK(pick->picks == 2);
  CHECK(pick->row == 0);
  CHECK(pick->record == &record);
  CHECK(pick->total_s == Approx(21.0));
  CHECK(pick->phases_s.at(1).first == "compute");  // Between look and reach.
  CHECK_FALSE(MedianPickOf({}, HourOf::kCell));
}

TEST_CASE("rows of earlier versions tell what they know", "[unit]") {
  RoundRecord record = RoundOfThree();
  for (AttemptRecord& attempt : record.attempts) attempt.phases_s.reset();
  const auto shares = TimeSharesOf({FactsOf(record)}, HourOf::kCell);
  CHECK_FALSE(shares->has_phases);
  CHECK(Of(shares->phases_s, "scan") == Approx(15.0));
  CHECK(Of(shares->phases_s, "look") == -1.0);
}

}  // namespace tubetwin
