#include "twin/round/records/throughput.h"

#include "models/base/json.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

constexpr double kRounding = 1e-12;

/// A round that placed so many in `sim_s`, with two attempts that computed a second each and half a
/// second after them.
RoundRecord Round(int placed, double sim_s) {
  RoundRecord record;
  record.summary.end = RoundEnd::kEmpty;
  record.summary.placed = placed;
  record.summary.sim_s = sim_s;
  record.attempts.resize(2);
  AttemptReport::ComputeTime second;
  second.total = 1.0;
  AttemptReport::ComputeTime half;
  half.total = 0.5;
  record.timings = {{1, second, 9.0}, {1, second, 9.0}, {kAfterLastAttempt, half, 9.0}};
  return record;
}

PartsPerHour Of(const std::vector<RoundRecord>& records, HourOf hour, bool with_interval = true) {
  std::vector<RoundFacts> facts;
  for (const RoundRecord& record : records) facts.push_back(FactsOf(record));
  std::optional<RandomStream> random;
  if (with_interval) random = RandomStream(1, 0, "throughput_test");
  return PartsPerHourOf(facts, hour, random);
}

}  // namespace

TEST_CASE("parts per hour are all placed over all time, looks and failures included", "[unit]") {
  const std::vector<RoundRecord> records = {Round(7, 300.0), Round(5, 420.0)};
  const PartsPerHour cell = Of(records, HourOf::kCell);
  CHECK(*cell.value == Approx(3600.0 * 12 / 720.0).epsilon(kRounding));
  const PartsPerHour both = Of(records, HourOf::kCellAndComputing);
  CHECK(both.time_s == Approx(725.0).epsilon(kRounding));  // 2.5 s of computing in each.
  CHECK(*both.value == Approx(3600.0 * 12 / 725.0).epsilon(kRounding));
  CHECK(both.rounds == 2);
  CHECK(both.placed == 12);
}

TEST_CASE("the interval lies between the slowest and the quickest round", "[unit]") {
  const PartsPerHour rate = Of({Round(7, 300.0), Round(5, 420.0), Round(7, 350.0)}, HourOf::kCell);
  REQUIRE(rate.interval);
  CHECK(rate.interval->low >= 3600.0 * 5 / 420.0 - kRounding);
  CHECK(rate.interval->high <= 3600.0 * 7 / 300.0 + kRounding);
  CHECK(rate.interval->low < *rate.value);
  CHECK(*rate.value < rate.interval->high);
  const PartsPerHour again = Of({Round(7, 300.0), Round(5, 420.0), Round(7, 350.0)}, HourOf::kCell);
  CHECK(again.interval->low == rate.interval->low);  // Seeded.
}

TEST_CASE("one round gives a rate and no interval, and says so", "[unit]") {
  const PartsPerHour rate = Of({Round(7, 360.0)}, HourOf::kCell);
  CHECK(*rate.value == Approx(70.0));
  CHECK_FALSE(rate.interval);
  CHECK(ToText(rate) == "70 (one round: no interval)");
  const Json json = ToJson(rate);
  CHECK(json["value"] == *rate.value);
  CHECK(json["low"].is_null());
  CHECK(json["definition"] == DefinitionOf(HourOf::kCell));
}

TEST_CASE("what nobody knows the time of is left out, and counted", "[unit]") {
  RoundRecord crashed;
  SetCrashed(7, "signal 11", 100.0, crashed);
  RoundRecord untimed = Round(7, 360.0);
  untimed.timings.clear();
  CHECK(Of({Round(7, 360.0), crashed}, HourOf::kCell).left_out == 1);
  CHECK(Of({untimed}, HourOf::kCell).rounds == 1);
  const PartsPerHour both = Of({untimed, crashed}, HourOf::kCellAndComputing);
  CHECK(both.left_out == 2);
  CHECK_FALSE(both.value);
  CHECK(ToText(both) == "-");
  CHECK(ToJson(both)["value"].is_null());
}

TEST_CASE("of a round resumed in the middle only what it placed itself counts", "[unit]") {
  RoundRecord resumed = Round(7, 360.0);
  resumed.summary.placed_before = 4;
  CHECK(*Of({resumed}, HourOf::kCell).value == Approx(30.0));
}

TEST_CASE("rates are written as people write them", "[unit]") {
  CHECK(ToText(62.4) == "62");
  CHECK(ToText(9.96) == "10");
  CHECK(ToText(9.94) == "9.9");
  PartsPerHour rate;
  rate.value = 62.4;
  rate.rounds = 20;
  rate.interval = Interval{58.3, 66.6};
  CHECK(ToText(rate) == "62 [58, 67]");
}

}  // namespace tubetwin
