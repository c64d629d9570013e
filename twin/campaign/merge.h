#pragma once

#include <string>
#include <vector>

#include "models/base/json.h"
#include "twin/round/round_record.h"

namespace tubetwin {

/// All rounds of a campaign: what reports, comparisons and tables are made of.
struct CampaignResult {
  Json identity;                     ///< Content of campaign.json.
  std::vector<RoundRecord> records;  ///< By arm, then round; none is missing.

  int arms() const { return static_cast<int>(identity["arms"].size()); }
  int rounds() const { return identity["rounds"].get<int>(); }
  std::string ArmName(int arm) const { return identity["arms"][arm]["name"]; }
  /// The records of one arm, round by round.
  std::vector<const RoundRecord*> OfArm(int arm) const;
};

/// Reads all shards of all `folders` as one campaign, in whatever order they come. Throws
/// Error(kMissing) for a folder without campaign or shards, Error(kBadData) when folders belong to
/// different campaigns (naming the first key that differs), a line is damaged or half-written, a
/// round stands there twice (saying whether the rows differ) or is missing: all of these name file
/// and line, or arm and rounds.
CampaignResult ReadShards(const std::vector<std::string>& folders);

/// Reads a merged folder, or the shards of a campaign's folder that was not merged. Throws as
/// ReadShards() does.
CampaignResult ReadCampaignResult(const std::string& folder);

/// Writes picks.jsonl, timings.jsonl, rounds.jsonl (one round's summary per line), summary.json,
/// campaign.json and manifest.json. The same rounds give the same bytes in all but timings.jsonl
/// and manifest.json, the two that hold wall times. Returns summary.json's content.
Json WriteMerged(const CampaignResult& result, const std::string& folder);

}  // namespace tubetwin
