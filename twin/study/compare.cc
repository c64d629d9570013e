#include "twin/study/compare.h"

#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "models/base/error.h"
#include "twin/round/records/attempt_facts.h"

namespace tubetwin {
namespace {

/// The rounds of each seed, A's and B's: index i of both is a pair.
struct Sides {
  std::vector<RoundFacts> a, b;
};

/// Indices of the pairs that a resampling drew, and a number of one side over them.
using Drawn = std::vector<int>;
using Measure = std::function<double(const Drawn&, const std::vector<MetricSample>&)>;

bool FirstPick(const RoundFacts& round) {
  return !round.attempts.empty() && round.attempts.front().success;
}

bool Emptied(const RoundFacts& round) { return round.record->summary.emptied; }

bool Flawless(const RoundFacts& round) {
  bool good = Emptied(round);
  for (const AttemptFacts& facts : round.attempts) good = good && facts.success;
  return good;
}

QuestionResult Ask(const char* name, bool (*answer)(const RoundFacts&), const Sides& sides) {
  QuestionResult out;
  out.question = name;
  for (std::size_t i = 0; i < sides.a.size(); ++i) {
    const bool a = answer(sides.a[i]), b = answer(sides.b[i]);
    ++(a ? (b ? out.both : out.only_a) : (b ? out.only_b : out.neither));
  }
  out.p = McNemarExact(out.only_a, out.only_b);
  return out;
}

double ShareOf(const Drawn& drawn, const std::vector<MetricSample>& side) {
  double k = 0.0, n = 0.0;
  for (const int i : drawn) {
    k += side[i].counts.k;
    n += side[i].counts.n;
  }
  return k / n;  // No trial: not a number, left out.
}

double MiddleOf(Metric::Kind kind, const Drawn& drawn, const std::vector<MetricSample>& side) {
  std::vector<double> values;
  for (const int i : drawn) {
    values.insert(values.end(), side[i].values.begin(), side[i].values.end());
  }
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const Spread spread = SpreadOf(values);
  return kind == Metric::Kind::kMean ? spread.mean : spread.median;
}

Difference DifferenceOf(const std::vector<MetricSample>& a, const std::vector<MetricSample>& b,
                        const Measure& measure, const RandomStream& random) {
  const auto difference = [&](const Drawn& drawn) { return measure(drawn, b) - measure(drawn, a); };
  Drawn all(a.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  return {difference(all), Bootstrap95(static_cast<int>(a.size()), difference, random)};
}

std::vector<MetricSample> SamplesOf(const Metric& metric, const std::vector<RoundFacts>& rounds) {
  std::vector<MetricSample> out;
  for (const RoundFacts& round : rounds) out.push_back(metric.reduce(round));
  return out;
}

MetricDifference CompareMetric(const Metric& metric, const Sides& sides,
                               const RandomStream& random) {
  const Measure measure = metric.kind == Metric::Kind::kRate
                              ? Measure(ShareOf)
                              : [kind = metric.kind](const Drawn& drawn, const auto& side) {
                                  return MiddleOf(kind, drawn, side);
                                };
  return {ValueOf(metric, sides.a), ValueOf(metric, sides.b),
          DifferenceOf(SamplesOf(metric, sides.a), SamplesOf(metric, sides.b), measure, random)};
}

/// Of each round that did not crash its simulated time and what it placed.
std::vector<MetricSample> TimesAndPlaced(const std::vector<RoundFacts>& rounds) {
  std::vector<MetricSample> out;
  for (const RoundFacts& round : rounds) {
    const RoundSummary& summary = round.record->summary;
    out.push_back({{0, summary.sim_s ? summary.placed : 0}, {summary.sim_s.value_or(0.0)}});
  }
  return out;
}

double SecondsPerTube(const Drawn& drawn, const std::vector<MetricSample>& side) {
  double sim_s = 0.0, placed = 0.0;
  for (const int i : drawn) {
    sim_s += side[i].values.front();
    placed += side[i].counts.n;
  }
  return sim_s / placed;
}

PairComparison ComparePair(const VariantPair& pair, std::uint64_t index,
                           const std::vector<Metric>& metrics) {
  std::map<std::int64_t, const RoundRecord*> of_b;
  const auto records_b = pair.b.result->OfVariant(pair.b.variant);
  for (const RoundRecord* record : records_b) of_b[record->seed] = record;
  Sides sides;
  const auto records_a = pair.a.result->OfVariant(pair.a.variant);
  for (const RoundRecord* record : records_a) {
    const auto partner = of_b.find(record->seed);
    if (partner == of_b.end()) continue;
    sides.a.push_back(FactsOf(*record));
    sides.b.push_back(FactsOf(*partner->second));
  }
  if (sides.a.empty()) {
    throw Error(ErrorKind::kBadData,
                pair.a.name + " and " + pair.b.name +
                    " have no seed in common: paired comparison needs campaigns of one seed");
  }
  const RandomStream random =
      RandomStream(static_cast<std::uint64_t>(pair.a.result->identity.seed), 0, "compare")
          .Fork("pair", index);
  PairComparison out;
  out.a = pair.a.name;
  out.b = pair.b.name;
  out.pairs = static_cast<int>(sides.a.size());
  out.unpaired_a = static_cast<int>(records_a.size()) - out.pairs;
  out.unpaired_b = static_cast<int>(of_b.size()) - out.pairs;
  out.questions = {Ask("first_pick", FirstPick, sides), Ask("flawless", Flawless, sides),
                   Ask("emptied", Emptied, sides)};
  for (const Metric& metric : metrics) {
    if (metric.compared.empty()) continue;
    out.metrics.push_back(CompareMetric(metric, sides, random.Fork(metric.stream)));
  }
  out.sim_s_per_placed_tube = DifferenceOf(TimesAndPlaced(sides.a), TimesAndPlaced(sides.b),
                                           SecondsPerTube, random.Fork("time"));
  return out;
}

}  // namespace

std::vector<VariantPair> PairVariants(const CampaignResult& a, const CampaignResult& b) {
  const auto choice = [](const CampaignResult& result, int variant) {
    return VariantChoice{&result, variant, result.VariantName(variant)};
  };
  std::vector<VariantPair> out;
  if (a.variants() != b.variants() && a.variants() != 1 && b.variants() != 1) {
    throw Error(ErrorKind::kBadData, "A has " + std::to_string(a.variants()) +
                                         " variants and B has " + std::to_string(b.variants()) +
                                         "; equally many are needed, or one against all");
  }
  for (int i = 0; i < std::max(a.variants(), b.variants()); ++i) {
    out.push_back({choice(a, a.variants() == 1 ? 0 : i), choice(b, b.variants() == 1 ? 0 : i)});
    if (out.back().a.name == out.back().b.name) {
      out.back().a.name += " (A)";
      out.back().b.name += " (B)";
    }
  }
  return out;
}

std::vector<VariantPair> PairVariantsWithin(const CampaignResult& result) {
  if (result.variants() < 2) {
    throw Error(ErrorKind::kBadData, "the campaign has one variant ('" + result.VariantName(0) +
                                         "'); name a second campaign to compare it with");
  }
  std::vector<VariantPair> out;
  for (int i = 0; i < result.variants(); ++i) {
    for (int j = i + 1; j < result.variants(); ++j) {
      out.push_back({{&result, i, result.VariantName(i)}, {&result, j, result.VariantName(j)}});
    }
  }
  return out;
}

Comparison CompareVariants(const std::vector<VariantPair>& pairs,
                           const std::vector<Metric>& metrics) {
  Comparison out;
  std::vector<double> p_values;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    out.pairs.push_back(ComparePair(pairs[i], i, metrics));
    for (const QuestionResult& test : out.pairs.back().questions) p_values.push_back(test.p);
  }
  const std::vector<double> adjusted = HolmAdjusted(p_values);
  std::size_t next = 0;
  for (PairComparison& pair : out.pairs) {
    for (QuestionResult& test : pair.questions) test.p_holm = adjusted[next++];
  }
  return out;
}

}  // namespace tubetwin
