#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/base/json_fwd.h"
#include "twin/campaign/merge.h"
#include "twin/round/records/metric.h"
#include "twin/round/records/throughput.h"

namespace tubetwin {

/// Sums over rounds.
struct CampaignTotals {
  int rounds = 0, crashed = 0;
  int tubes_start = 0, placed = 0;
  int attempts = 0;
  int several_placed = 0;  ///< Attempts that placed more than one tube.
  int outside = 0, dropped = 0;
};

/// How attempts with so many tubes in the bin went.
struct TubesLeftSummary {
  int tubes_left = 0;
  Rate success;
  Rate first_attempt;  ///< Of the placed tubes.
};

/// How attempts with one motion went; "none" where there was no plan.
struct MotionSummary {
  std::string motion;
  Rate success;
  int used_simulator = 0;
  std::optional<Spread> move_s;  ///< Simulated seconds of moving.
};

/// What came of attempts that the pipeline believed to end so.
struct BeliefSummary {
  std::string outcome;
  int attempts = 0, success = 0;
  int unknown = 0;  ///< Of a cell without truth.
};

/// Names with how often they came, most frequent first, then by name.
using Frequencies = std::vector<std::pair<std::string, int>>;

/// One variant over all its rounds.
struct VariantSummary {
  int variant = 0;
  std::string name;
  CampaignTotals totals;
  PartsPerHour parts_per_hour;                  ///< Of the cell alone: no clock is in a summary.
  std::vector<MetricValue> metrics;             ///< One for each metric, in their order.
  std::vector<TubesLeftSummary> by_tubes_left;  ///< Most tubes first, as the paper's Table 4.
  std::vector<MotionSummary> by_motion;         ///< Most used first.
  Frequencies failures;                         ///< Classes of AttemptFacts.
  Frequencies end_reasons;                      ///< Of rounds.
  std::vector<BeliefSummary> belief;            ///< By outcome, in the order of names.
};

/// A campaign as its summary.json tells it: from `success` and truth alone, never from what the
/// pipeline believes (that is `belief`), and nothing that a clock measured. Its metrics refer to
/// the list that they were made of.
struct CampaignSummary {
  std::int64_t seed = 0;
  CampaignTotals totals;             ///< Over all variants.
  std::vector<MetricValue> metrics;  ///< Likewise, without intervals by rounds.
  std::vector<VariantSummary> variants;
};
/// What a variant's intervals are drawn from.
RandomStream BootstrapStream(std::int64_t campaign_seed, int variant);
CampaignSummary Summarize(const CampaignResult& result,
                          const std::vector<Metric>& metrics = Metrics());
Json ToJson(const CampaignSummary& summary);

/// Computing times of one variant, wall seconds, and parts an hour with them.
struct VariantTimes {
  struct Part {
    std::string name;  ///< "modelling", "planning", "evaluator", "total".
    std::optional<Spread> all, without_simulator, with_simulator;
  };
  int variant = 0;
  std::string name;
  std::vector<Part> parts;
  PartsPerHour parts_per_hour;  ///< Computing included.
  /// The same with the interval that 2 and 4 times as many rounds would give.
  std::vector<std::pair<int, PartsPerHour>> with_more_rounds;
};

/// A campaign's manifest.json: versions and computing times.
struct CampaignManifest {
  std::string program, mujoco, fingerprint;
  std::string purpose;  ///< As CampaignIdentity's.
  std::vector<VariantTimes> compute_s;
};
CampaignManifest ManifestOf(const CampaignResult& result);
Json ToJson(const CampaignManifest& manifest);

/// Both as a table for people.
std::string SummaryText(const CampaignSummary& summary, const CampaignManifest& manifest);

}  // namespace tubetwin
