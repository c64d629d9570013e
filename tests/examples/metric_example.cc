// A metric of one's own: twin/report/README.md quotes what stands between the two lines.

#include "models/base/json.h"
#include "tests/support/catch.h"
#include "twin/round/records/metric.h"
#include "twin/round/result_files.h"

namespace tubetwin {
namespace {

// --- begin of the example
/// Share of attempts before which a tube had to be pushed free.
Metric NudgedRate() {
  return AttemptRate(
      "nudged", "Attempts that needed a nudge", [](const AttemptFacts&) { return true; },
      [](const AttemptFacts& facts) { return !facts.attempt->nudges.empty(); });
}
// --- end of the example

/// Median load in the fingers where one tube hung, in newtons.
Metric WeighedMedian() {
  return AttemptMedian("weighed_N", "Load of a single tube", "N",
                       [](const AttemptFacts& facts) -> std::optional<double> {
                         const auto& detection = facts.attempt->detection;
                         if (!detection || detection->outcome != HeldOutcome::kOne) {
                           return std::nullopt;
                         }
                         return detection->force_N;
                       });
}

AttemptRecord Attempt(bool nudged, double force_N) {
  AttemptRecord attempt;
  if (nudged) attempt.nudges.emplace_back();
  attempt.detection = Detection{HeldOutcome::kOne, force_N, Vector3::Zero(), 1.0};
  attempt.success = true;
  return attempt;
}

TEST_CASE("a metric of one's own stands in a summary with its interval or its spread", "[unit]") {
  std::vector<Metric> metrics = Metrics();
  metrics.push_back(NudgedRate());
  metrics.push_back(WeighedMedian());
  RoundRecord record;
  record.summary.end = RoundEnd::kEmpty;
  record.attempts = {Attempt(true, 1.0), Attempt(false, 2.0), Attempt(false, 6.0)};
  const Json summary = RoundSummaryJson(record, metrics);
  CHECK(summary["nudged"]["k"] == 1);
  CHECK(summary["nudged"]["n"] == 3);
  CHECK(summary["nudged"]["wilson95"][1].get<double>() == Approx(0.7923).margin(1e-4));
  CHECK(summary["weighed_N"]["median"] == 2.0);
  CHECK_FALSE(RoundSummaryJson(record).contains("nudged"));
}

TEST_CASE("two metrics of one name are a bug that is found at once", "[unit]") {
  std::vector<Metric> metrics = {NudgedRate(), NudgedRate()};
  RoundRecord record;
  CHECK_THROWS_WITH(RoundSummaryJson(record, metrics), Catch::Matchers::Contains("contains"));
}

}  // namespace
}  // namespace tubetwin
