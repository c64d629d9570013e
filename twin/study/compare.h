#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/base/json_fwd.h"
#include "twin/campaign/merge.h"
#include "twin/round/records/metric.h"

namespace tubetwin {

/// One variant of one result, as a comparison names it.
struct VariantChoice {
  const CampaignResult* result = nullptr;
  int variant = 0;
  std::string name;
};

/// Two variants to compare, round by round with the same seed.
struct VariantPair {
  VariantChoice a, b;
};

/// The pairs of two results: all variants in order when they have equally many, or the only one of
/// one against each of the other. Throws Error(kBadData) when neither fits.
std::vector<VariantPair> PairVariants(const CampaignResult& a, const CampaignResult& b);

/// All pairs of variants within one result. Throws Error(kBadData) when it has only one.
std::vector<VariantPair> PairVariantsWithin(const CampaignResult& result);

/// A yes-or-no question that each round answers, put to pairs of rounds.
struct QuestionResult {
  std::string question;  ///< "first_pick", "flawless" or "emptied".
  int both = 0, only_a = 0, only_b = 0, neither = 0;
  double p = 1.0;       ///< By the exact McNemar test.
  double p_holm = 1.0;  ///< Adjusted for all tests of the comparison.

  Counts a() const { return {both + only_a, both + only_a + only_b + neither}; }
  Counts b() const { return {both + only_b, both + only_a + only_b + neither}; }
};

/// B - A of something, with a bootstrap that draws whole pairs of rounds. Not finite where it is
/// not known.
struct Difference {
  double b_minus_a = 0.0;
  Interval bootstrap95;
};

/// A metric of both sides and their difference.
struct MetricDifference {
  MetricValue a, b;
  Difference difference;
};

struct PairComparison {
  std::string a, b;                    ///< Names.
  int pairs = 0;                       ///< Rounds whose seeds both have.
  int unpaired_a = 0, unpaired_b = 0;  ///< Rounds left out.
  std::vector<QuestionResult> questions;
  std::vector<MetricDifference> metrics;  ///< Those that have a name in comparisons.
  Difference sim_s_per_placed_tube;
};

struct Comparison {
  std::vector<PairComparison> pairs;
};

/// Compares each pair over the rounds whose seeds both have. Each round answers three questions on
/// truth: `first_pick` (its first attempt succeeded; both variants face the same pile), `flawless`
/// (every attempt succeeded and the bin was emptied) and `emptied`; all tests of the comparison are
/// adjusted together by Holm. Crashed rounds count as failed. Throws Error(kBadData) when a pair
/// has no seed in common.
Comparison CompareVariants(const std::vector<VariantPair>& pairs,
                           const std::vector<Metric>& metrics = Metrics());

Json ToJson(const Comparison& comparison);
/// As a table for people.
std::string CompareText(const Comparison& comparison);

}  // namespace tubetwin
