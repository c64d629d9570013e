// What summaries tell of tolerance and of first attempts.

#include "models/base/json.h"
#include "tests/support/catch.h"
#include "twin/round/records/metric.h"
#include "twin/round/result_files.h"

namespace tubetwin {
namespace {

AttemptRecord Attempt(int number, bool success, std::optional<double> error_mm = {},
                      double error_deg = 0.0) {
  AttemptRecord attempt;
  attempt.attempt = number;
  attempt.outcome = success ? AttemptOutcome::kPlaced : AttemptOutcome::kNothingHeld;
  attempt.success = success;
  attempt.truth.emplace();
  attempt.truth->placement_error_mm = error_mm;
  if (error_mm) attempt.truth->placement_error_deg = error_deg;
  const PlacementTolerance tolerance;
  attempt.in_tolerance = success && error_mm && tolerance.Holds(*error_mm, error_deg);
  return attempt;
}

RoundRecord Round(int tubes_start, std::vector<AttemptRecord> attempts) {
  RoundRecord record;
  record.summary.tubes_start = tubes_start;
  record.summary.end = RoundEnd::kNoPlan;
  record.summary.tolerance = PlacementTolerance();
  record.attempts = std::move(attempts);
  return record;
}

void CheckRate(const Json& rate, int k, int n) {
  INFO(rate.dump());
  CHECK(rate["k"] == k);
  CHECK(rate["n"] == n);
  CHECK(rate["wilson95"].size() == 2);
}

TEST_CASE("in_tolerance counts attempts, its distances keep the limit of yaw", "[unit]") {
  const Json summary = RoundSummaryJson(
      Round(7, {Attempt(1, true, 4.0, 2.0), Attempt(1, true, 4.0, 12.0), Attempt(1, true, 12.0),
                Attempt(1, true, 30.0), Attempt(1, false), Attempt(2, false, 3.0)}));
  CheckRate(summary["in_tolerance"], 2, 6);
  CheckRate(summary["in_tolerance_at"]["5"], 1, 6);
  CheckRate(summary["in_tolerance_at"]["10"], 1, 6);
  CheckRate(summary["in_tolerance_at"]["20"], 2, 6);
  CheckRate(summary["in_tolerance_at"]["50"], 3, 6);
  CHECK(summary["tolerance"] == Json{{"position_mm", 20.0}, {"yaw_deg", 10.0}});
}

TEST_CASE("first attempts are told over placed tubes and over all at the start", "[unit]") {
  RoundRecord record = Round(7, {Attempt(1, true, 1.0), Attempt(1, false), Attempt(2, true, 1.0),
                                 Attempt(1, true, 1.0), Attempt(1, false)});
  record.summary.first_attempt = CountAttempts(record.attempts).first_attempt;
  Json summary = RoundSummaryJson(record);
  CheckRate(summary["first_attempt"], 2, 3);
  CheckRate(summary["first_attempt_of_start"], 2, 7);
  // A round that began in the middle began with fewer in the bin.
  record.summary.placed_before = 2;
  record.summary.outside_before = 1;
  CheckRate(RoundSummaryJson(record)["first_attempt_of_start"], 2, 4);
  // Where the first look saw too few, as many as were placed were there.
  record.summary = RoundSummary();
  record.summary.tubes_start = 1;
  CheckRate(RoundSummaryJson(record)["first_attempt_of_start"], 2, 3);
}

TEST_CASE("a crashed round misses its tolerance and all its first attempts", "[unit]") {
  RoundRecord crashed;
  SetCrashed(7, "signal 11", 1.5, crashed);
  const Json summary = RoundSummaryJson(crashed);
  CheckRate(summary["in_tolerance"], 0, 1);
  CheckRate(summary["in_tolerance_at"]["50"], 0, 1);
  CheckRate(summary["first_attempt_of_start"], 0, 7);
}

TEST_CASE("the same success is told by rounds where there are several", "[unit]") {
  std::vector<RoundRecord> records;
  for (int i = 0; i < 20; ++i) records.push_back(Round(2, {Attempt(1, true), Attempt(1, true)}));
  std::vector<RoundFacts> rounds;
  for (const RoundRecord& record : records) rounds.push_back(FactsOf(record));
  const Metric& success = Metrics().front();
  REQUIRE(success.name == "success");
  const Rate rate = ValueOf(success, rounds).rate;
  CHECK(rate.counts.n == 40);
  REQUIRE(rate.by_cluster);
  CHECK(rate.by_cluster->low == Wilson95(20, 20).low);
  CHECK_FALSE(ValueOf(success, rounds, /*mixed=*/true).rate.by_cluster);
}

}  // namespace
}  // namespace tubetwin
