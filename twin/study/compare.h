#pragma once

#include <string>
#include <vector>

#include "models/base/json_fwd.h"
#include "twin/campaign/merge.h"

namespace tubetwin {

/// One arm of one result, as a comparison names it.
struct ArmChoice {
  const CampaignResult* result = nullptr;
  int arm = 0;
  std::string name;
};

/// Two arms to compare, round by round with the same seed.
struct ArmPair {
  ArmChoice a, b;
};

/// The pairs of two results: all arms in order when they have equally many, or the only arm of one
/// against each of the other. Throws Error(kBadData) when neither fits.
std::vector<ArmPair> PairArms(const CampaignResult& a, const CampaignResult& b);

/// All pairs of arms within one result. Throws Error(kBadData) when it has only one.
std::vector<ArmPair> PairArmsWithin(const CampaignResult& result);

/// Compares each pair over the rounds whose seeds both have. Each round gives three yes-or-no
/// answers on truth: `first_pick` (its first attempt succeeded; both arms face the same pile),
/// `flawless` (every attempt succeeded and the bin was emptied) and `emptied`; each is tested by
/// the exact McNemar test, and all tests of the comparison are adjusted together by Holm.
/// Differences B
/// - A of rates over attempts and of simulated time per placed tube come with a bootstrap that
/// draws whole pairs of rounds. Crashed rounds count as failed. Throws Error(kBadData) when a pair
/// has no seed in common.
Json CompareArms(const std::vector<ArmPair>& pairs);

/// As a table for people.
std::string CompareText(const Json& comparison);

}  // namespace tubetwin
