#include "twin/campaign/campaign_summary.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "twin/round/records/attempt_facts.h"

namespace tubetwin {
namespace {

using Rounds = std::vector<RoundFacts>;

bool PlacedOne(const AttemptFacts& facts) { return facts.PlacedOne(); }

/// The rate of the attempts that pass `counted`, as a metric would tell it.
Rate RateWhere(const Rounds& rounds, const AttemptTest& counted, const AttemptTest& good) {
  return ValueOf(AttemptRate("", "", counted, good), rounds).rate;
}

template <class Use>
void ForEachAttempt(const Rounds& rounds, const Use& use) {
  for (const RoundFacts& round : rounds) {
    for (const AttemptFacts& facts : round.attempts) use(facts);
  }
}

Frequencies Ranked(const std::map<std::string, int>& counts) {
  Frequencies out(counts.begin(), counts.end());
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return out;
}

std::vector<TubesLeftSummary> ByTubesLeft(const Rounds& rounds) {
  std::set<int, std::greater<>> lefts;
  ForEachAttempt(rounds, [&](const AttemptFacts& facts) { lefts.insert(facts.tubes_left); });
  std::vector<TubesLeftSummary> out;
  for (const int left : lefts) {
    const auto here = [left](const AttemptFacts& facts) { return facts.tubes_left == left; };
    const auto placed_here = [&](const AttemptFacts& facts) {
      return here(facts) && PlacedOne(facts);
    };
    const auto first = [](const AttemptFacts& facts) { return facts.first; };
    out.push_back(
        {left, RateWhere(rounds, here, PlacedOne), RateWhere(rounds, placed_here, first)});
  }
  return out;
}

std::string MotionOf(const AttemptFacts& facts) {
  return facts.attempt->chosen ? facts.attempt->chosen->motion : "none";
}

std::vector<MotionSummary> ByMotion(const Rounds& rounds) {
  std::map<std::string, int> uses;
  ForEachAttempt(rounds, [&](const AttemptFacts& facts) { ++uses[MotionOf(facts)]; });
  std::vector<MotionSummary> out;
  for (const auto& [name, count] : Ranked(uses)) {
    const auto chosen = [&name = name](const AttemptFacts& facts) {
      return MotionOf(facts) == name;
    };
    MotionSummary row;
    row.motion = name;
    row.success = RateWhere(rounds, chosen, PlacedOne);
    std::vector<double> move_s;
    ForEachAttempt(rounds, [&](const AttemptFacts& facts) {
      if (!chosen(facts)) return;
      row.used_simulator += facts.attempt->used_simulator ? 1 : 0;
      if (facts.attempt->sim_s) move_s.push_back(facts.attempt->sim_s->move);
    });
    row.move_s = OptionalSpread(move_s);
    out.push_back(std::move(row));
  }
  return out;
}

std::vector<BeliefSummary> Belief(const Rounds& rounds) {
  std::map<std::string, BeliefSummary> table;
  ForEachAttempt(rounds, [&](const AttemptFacts& facts) {
    BeliefSummary& row = table[ToString(facts.attempt->outcome)];
    ++row.attempts;
    row.success += facts.success ? 1 : 0;
    row.unknown += facts.attempt->success ? 0 : 1;
  });
  std::vector<BeliefSummary> out;
  for (auto& [outcome, row] : table) {
    row.outcome = outcome;
    out.push_back(row);
  }
  return out;
}

CampaignTotals TotalsOf(const Rounds& rounds) {
  CampaignTotals out;
  for (const RoundFacts& round : rounds) {
    const RoundSummary& summary = round.record->summary;
    ++out.rounds;
    out.crashed += summary.crashed() ? 1 : 0;
    out.tubes_start += summary.tubes_start;
    out.placed += summary.placed;
    out.outside += summary.outside;
    out.dropped += summary.dropped;
    out.attempts += static_cast<int>(round.attempts.size());
  }
  ForEachAttempt(
      rounds, [&](const AttemptFacts& facts) { out.several_placed += facts.placed > 1 ? 1 : 0; });
  return out;
}

std::vector<MetricValue> ValuesOf(const std::vector<Metric>& metrics, const Rounds& rounds,
                                  bool mixed) {
  std::vector<MetricValue> out;
  for (const Metric& metric : metrics) out.push_back(ValueOf(metric, rounds, mixed));
  return out;
}

VariantSummary SummarizeVariant(const CampaignResult& result, int variant,
                                const std::vector<Metric>& metrics, const RandomStream& random) {
  const Rounds rounds = FactsOf(result.OfVariant(variant));
  VariantSummary out;
  out.variant = variant;
  out.name = result.VariantName(variant);
  out.totals = TotalsOf(rounds);
  out.parts_per_hour = PartsPerHourOf(rounds, HourOf::kCell, random.Fork("parts_per_hour"));
  out.metrics = ValuesOf(metrics, rounds, /*mixed=*/false);
  out.by_tubes_left = ByTubesLeft(rounds);
  out.by_motion = ByMotion(rounds);
  std::map<std::string, int> failures, ends;
  ForEachAttempt(rounds, [&](const AttemptFacts& facts) {
    if (!facts.failure.empty()) ++failures[facts.failure];
  });
  for (const RoundFacts& round : rounds) ++ends[round.record->summary.EndName()];
  out.failures = Ranked(failures);
  out.end_reasons = Ranked(ends);
  out.belief = Belief(rounds);
  return out;
}

VariantTimes TimesOf(const CampaignResult& result, int variant) {
  using Times = AttemptReport::ComputeTime;
  constexpr std::pair<const char*, double Times::*> kParts[] = {{"modelling", &Times::modelling},
                                                                {"planning", &Times::planning},
                                                                {"evaluator", &Times::evaluator},
                                                                {"total", &Times::total}};
  VariantTimes out;
  out.variant = variant;
  out.name = result.VariantName(variant);
  const Rounds rounds = FactsOf(result.OfVariant(variant));
  for (const auto& [name, part] : kParts) {
    std::vector<double> all, without, with;
    ForEachAttempt(rounds, [&, part = part](const AttemptFacts& facts) {
      if (facts.timing == nullptr || !facts.timing->compute_s) return;
      const double seconds = *facts.timing->compute_s.*part;
      all.push_back(seconds);
      (facts.attempt->used_simulator ? with : without).push_back(seconds);
    });
    out.parts.push_back({name, OptionalSpread(all), OptionalSpread(without), OptionalSpread(with)});
  }
  const RandomStream random = BootstrapStream(result.identity.seed, variant).Fork("parts_per_hour");
  out.parts_per_hour = PartsPerHourOf(rounds, HourOf::kCellAndComputing, random);
  for (const int times : {2, 4}) {
    out.with_more_rounds.emplace_back(
        times, PartsPerHourOf(rounds, HourOf::kCellAndComputing, random, times));
  }
  return out;
}

}  // namespace

RandomStream BootstrapStream(std::int64_t campaign_seed, int variant) {
  // Called as variants once were: a resampling goes on drawing the same rounds.
  return RandomStream(static_cast<std::uint64_t>(campaign_seed), 0, "bootstrap")
      .Fork("arm", static_cast<std::uint64_t>(variant));
}

CampaignSummary Summarize(const CampaignResult& result, const std::vector<Metric>& metrics) {
  std::vector<const RoundRecord*> records;
  for (const RoundRecord& record : result.records) records.push_back(&record);
  const Rounds all = FactsOf(records);
  CampaignSummary out;
  out.seed = result.identity.seed;
  out.totals = TotalsOf(all);
  out.metrics = ValuesOf(metrics, all, /*mixed=*/true);
  for (int variant = 0; variant < result.variants(); ++variant) {
    out.variants.push_back(
        SummarizeVariant(result, variant, metrics, BootstrapStream(out.seed, variant)));
  }
  return out;
}

CampaignManifest ManifestOf(const CampaignResult& result) {
  const CampaignIdentity& identity = result.identity;
  CampaignManifest out{
      identity.program, identity.mujoco, identity.fingerprint(), identity.purpose, {}};
  for (int variant = 0; variant < result.variants(); ++variant) {
    out.compute_s.push_back(TimesOf(result, variant));
  }
  return out;
}

}  // namespace tubetwin
