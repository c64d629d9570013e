// The metrics of this program. A new one is a function like these and a line in the list below.

#include "twin/round/records/metric.h"

#include <algorithm>

namespace tubetwin {
namespace {

bool Any(const AttemptFacts&) { return true; }
bool Scored(const AttemptFacts& facts) { return facts.attempt->success.has_value(); }
bool Success(const AttemptFacts& facts) { return facts.success; }
bool PlacedOne(const AttemptFacts& facts) { return facts.PlacedOne(); }
bool ToleranceKnown(const AttemptFacts& facts) { return facts.attempt->in_tolerance.has_value(); }
bool First(const AttemptFacts& facts) { return facts.first; }
bool UsedSimulator(const AttemptFacts& facts) { return facts.attempt->used_simulator; }
bool UsedResolution(const AttemptFacts& facts) { return facts.attempt->resolution_used; }

Metric Headline(Metric metric, const std::string& stream) {
  metric.place = Metric::Place::kHeadline;
  metric.stream = stream;
  return metric;
}

Metric Step(Metric metric, const std::string& stream, const std::string& compared) {
  metric.place = Metric::Place::kStep;
  metric.stream = stream;
  metric.compared = compared;
  return metric;
}

Metric Time(Metric metric) {
  metric.place = Metric::Place::kTime;
  metric.compared.clear();
  return metric;
}

Metric SuccessRate() {
  return Headline(AttemptRate("success", "Attempts that placed exactly one tube", Scored, Success),
                  "success");
}

Metric FirstAttemptRate() {
  return Headline(
      AttemptRate("first_attempt", "Placed tubes that took one attempt", PlacedOne, First),
      "first");
}

/// Of all tubes that lay in the bin at the start, those that were placed by the first attempt after
/// the tube before: what is left in the bin counts as missed.
Metric FirstAttemptOfStartRate() {
  Metric metric =
      Headline(AttemptRate("first_attempt_of_start",
                           "Tubes in the bin at the start that were placed by one attempt",
                           PlacedOne, First),
               "first_of_start");
  metric.reduce = [](const RoundFacts& round) {
    const RoundSummary& summary = round.record->summary;
    Counts counts;
    int placed = 0;
    for (const AttemptFacts& facts : round.attempts) {
      placed += facts.PlacedOne() ? 1 : 0;
      counts.k += facts.PlacedOne() && facts.first ? 1 : 0;
    }
    // Without truth the start is what the first look found, which may be too few.
    counts.n =
        std::max(placed, summary.tubes_start - summary.placed_before - summary.outside_before);
    return MetricSample{counts, {}};
  };
  return metric;
}

Metric InToleranceRate() {
  return Headline(
      AttemptRate("in_tolerance", "Attempts that placed exactly one tube, within the tolerance",
                  ToleranceKnown,
                  [](const AttemptFacts& facts) { return facts.attempt->in_tolerance == true; }),
      "in_tolerance");
}

/// The same for another distance, with the round's own limit of yaw.
Metric InToleranceAt(int error_mm) {
  const std::string mm = std::to_string(error_mm);
  Metric metric = AttemptRate(
      "in_tolerance_at/" + mm, "Placed exactly one tube within " + mm + " mm", ToleranceKnown,
      [error_mm](const AttemptFacts& facts) { return facts.Within(error_mm); });
  metric.compared.clear();
  return metric;
}

Metric EmptiedRate() {
  Metric metric = RoundRate("emptied", "Bins emptied",
                            [](const RoundRecord& record) { return record.summary.emptied; });
  metric.place = Metric::Place::kHeadline;
  metric.compared.clear();  // A question of each round there.
  return metric;
}

Metric SimulatorUsed() {
  return Step(AttemptRate("simulator/used", "Motion simulated first", Any, UsedSimulator),
              "simulator_used", "");
}

Metric SimulatorSuccess() {
  return Step(AttemptRate("simulator/success", "Success where simulated", UsedSimulator, Success),
              "simulator", "");
}

Metric ResolutionUsed() {
  return Step(AttemptRate("resolution/used", "Separated in the air", Any, UsedResolution),
              "resolution_used", "");
}

Metric ResolutionSuccess() {
  return Step(AttemptRate("resolution/success", "Success where separated", UsedResolution, Success),
              "resolution", "resolution");
}

/// One part of an attempt's simulated time.
Metric AttemptTime(const std::string& part, const std::string& label,
                   double (*of)(const AttemptReport::SimTime&)) {
  return Time(AttemptMedian("sim_s/attempt/" + part, label, "s",
                            [of](const AttemptFacts& facts) -> std::optional<double> {
                              if (!facts.attempt->sim_s) return std::nullopt;
                              return of(*facts.attempt->sim_s);
                            }));
}

Metric RoundTime() {
  return Time(RoundMedian("sim_s/round", "simulated, per bin", "s",
                          [](const RoundRecord& record) { return record.summary.sim_s; }));
}

Metric PlacedTubeTime() {
  return Time(RoundMedian("sim_s/placed_tube", "simulated, per placed tube", "s",
                          [](const RoundRecord& record) -> std::optional<double> {
                            const RoundSummary& summary = record.summary;
                            if (!summary.sim_s || summary.placed == 0) return std::nullopt;
                            return *summary.sim_s / summary.placed;
                          }));
}

}  // namespace

const std::vector<Metric>& Metrics() {
  using Times = AttemptReport::SimTime;
  static const std::vector<Metric> metrics = {
      SuccessRate(),
      InToleranceRate(),
      FirstAttemptRate(),
      FirstAttemptOfStartRate(),
      EmptiedRate(),
      SimulatorUsed(),
      SimulatorSuccess(),
      ResolutionUsed(),
      ResolutionSuccess(),
      AttemptTime("scan", "scan", [](const Times& t) { return t.scan; }),
      AttemptTime("move", "move", [](const Times& t) { return t.move; }),
      AttemptTime("weigh", "weigh", [](const Times& t) { return t.weigh; }),
      AttemptTime("settle", "settle", [](const Times& t) { return t.settle; }),
      AttemptTime("total", "simulated, all of an attempt",
                  [](const Times& t) { return t.total(); }),
      RoundTime(),
      PlacedTubeTime(),
      InToleranceAt(5),
      InToleranceAt(10),
      InToleranceAt(20),
      InToleranceAt(50),
  };
  return metrics;
}

}  // namespace tubetwin
