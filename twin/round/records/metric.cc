#include "twin/round/records/metric.h"

#include <utility>

#include "models/base/error.h"
#include "models/base/json.h"

namespace tubetwin {
namespace {

Metric Named(const std::string& name, const std::string& label, Metric::Kind kind) {
  Metric metric;
  metric.name = metric.compared = metric.stream = name;
  metric.label = label;
  metric.kind = kind;
  return metric;
}

}  // namespace

Metric AttemptRate(const std::string& name, const std::string& label, const AttemptTest& counted,
                   const AttemptTest& good) {
  Metric metric = Named(name, label, Metric::Kind::kRate);
  metric.reduce = [counted, good](const RoundFacts& round) {
    MetricSample sample;
    for (const AttemptFacts& facts : round.attempts) {
      if (!counted(facts)) continue;
      ++sample.counts.n;
      sample.counts.k += good(facts) ? 1 : 0;
    }
    return sample;
  };
  return metric;
}

Metric RoundRate(const std::string& name, const std::string& label,
                 const std::function<bool(const RoundRecord&)>& good) {
  Metric metric = Named(name, label, Metric::Kind::kRate);
  metric.per_round = true;
  metric.reduce = [good](const RoundFacts& round) {
    return MetricSample{{good(*round.record) ? 1 : 0, 1}, {}};
  };
  return metric;
}

Metric AttemptMedian(const std::string& name, const std::string& label, const std::string& unit,
                     const std::function<std::optional<double>(const AttemptFacts&)>& value) {
  Metric metric = Named(name, label, Metric::Kind::kMedian);
  metric.unit = unit;
  metric.reduce = [value](const RoundFacts& round) {
    MetricSample sample;
    for (const AttemptFacts& facts : round.attempts) {
      if (const auto found = value(facts)) sample.values.push_back(*found);
    }
    return sample;
  };
  return metric;
}

Metric RoundMedian(const std::string& name, const std::string& label, const std::string& unit,
                   const std::function<std::optional<double>(const RoundRecord&)>& value) {
  Metric metric = Named(name, label, Metric::Kind::kMedian);
  metric.unit = unit;
  metric.reduce = [value](const RoundFacts& round) {
    MetricSample sample;
    if (const auto found = value(*round.record)) sample.values.push_back(*found);
    return sample;
  };
  return metric;
}

MetricValue ValueOf(const Metric& metric, const std::vector<RoundFacts>& rounds, bool mixed) {
  std::vector<Counts> counts;
  std::vector<double> values;
  for (const RoundFacts& round : rounds) {
    const MetricSample sample = metric.reduce(round);
    counts.push_back(sample.counts);
    values.insert(values.end(), sample.values.begin(), sample.values.end());
  }
  MetricValue out{&metric, {}, OptionalSpread(values)};
  if (metric.kind != Metric::Kind::kRate) return out;
  const bool independent = mixed || metric.per_round;
  out.rate = RateOf(counts, independent ? Trials::kIndependent : Trials::kClustered);
  return out;
}

void AddValue(const MetricValue& value, Json& summary) {
  const std::string& name = value.metric->name;
  Json* at = &summary;
  std::size_t begin = 0;
  for (std::size_t end = name.find('/'); end != std::string::npos; end = name.find('/', begin)) {
    at = &(*at)[name.substr(begin, end - begin)];
    begin = end + 1;
  }
  const std::string key = name.substr(begin);
  TT_CHECK(!at->contains(key));  // Two metrics of one name, or one named like a field.
  const bool is_rate = value.metric->kind == Metric::Kind::kRate;
  (*at)[key] = is_rate ? ToJson(value.rate) : ToJson(value.spread);
}

}  // namespace tubetwin
