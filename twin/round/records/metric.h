#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "models/base/json_fwd.h"
#include "twin/round/records/attempt_facts.h"
#include "twin/statistics/rate.h"

namespace tubetwin {

/// What one round contributes to a metric: trials of a rate, or values.
struct MetricSample {
  Counts counts;
  std::vector<double> values;
};

/// Something that summaries, comparisons and pages tell of rounds: a name and how a round's records
/// reduce to it. Adding one is a function that returns it and a line in metrics.cc; make it with
/// AttemptRate() and its like.
struct Metric {
  enum class Kind {
    kRate,    ///< k of n, with Wilson's interval and, over attempts, the interval by rounds.
    kMean,    ///< Of all rounds' values; files hold the whole spread.
    kMedian,  ///< Likewise.
  };
  enum class Place {
    kHeadline,  ///< A card at the head of pages, and a column of the table of variants; in every
                ///< summary.json.
    kStep,      ///< The table of measures, and nothing in a single round's summary.json.
    kTime,      ///< The table of times, likewise.
    kMeasure,   ///< The table of measures; in every summary.json under its name.
  };
  std::string name;   ///< Its key in summary.json; "simulator/used" is `used` in `simulator`.
  std::string label;  ///< On pages, plain text.
  Kind kind = Kind::kRate;
  /// Only of rates: one trial a round. Rounds are independent, so Wilson's interval says it all.
  bool per_round = false;
  std::function<MetricSample(const RoundFacts&)> reduce;
  Place place = Place::kMeasure;
  std::string unit = "";      ///< Of values: "s", "N"; empty: a plain number.
  std::string compared = "";  ///< Its key in comparisons; empty: it is not compared.
  std::string stream = "";    ///< Name of the random stream of its comparisons; empty: its name.
};

using AttemptTest = std::function<bool(const AttemptFacts&)>;

/// A rate over the attempts that pass `counted`: the share of them that pass `good`.
Metric AttemptRate(const std::string& name, const std::string& label, const AttemptTest& counted,
                   const AttemptTest& good);
/// A rate over rounds.
Metric RoundRate(const std::string& name, const std::string& label,
                 const std::function<bool(const RoundRecord&)>& good);
/// The median over attempts of a value; attempts that have none are left out.
Metric AttemptMedian(const std::string& name, const std::string& label, const std::string& unit,
                     const std::function<std::optional<double>(const AttemptFacts&)>& value);
/// The median over rounds of a value; rounds that have none are left out.
Metric RoundMedian(const std::string& name, const std::string& label, const std::string& unit,
                   const std::function<std::optional<double>(const RoundRecord&)>& value);

/// A metric over some rounds.
struct MetricValue {
  const Metric* metric = nullptr;
  Rate rate;                     ///< Of kRate.
  std::optional<Spread> spread;  ///< Of the others; nothing: no round had a value.
};

/// The value of a metric over the rounds. Rates over attempts get their interval by rounds, unless
/// the rounds are of several variants and `mixed` says so: then Wilson's alone.
MetricValue ValueOf(const Metric& metric, const std::vector<RoundFacts>& rounds,
                    bool mixed = false);

/// Puts the value at the metric's place in a summary.json.
void AddValue(const MetricValue& value, Json& summary);

/// All metrics of this program, in the order of files and pages (metrics.cc).
const std::vector<Metric>& Metrics();

}  // namespace tubetwin
