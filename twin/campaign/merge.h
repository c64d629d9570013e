#pragma once

#include <string>
#include <vector>

#include "twin/campaign/campaign.h"
#include "twin/round/records/round_record.h"

namespace tubetwin {

/// All rounds of a campaign: what reports, comparisons and tables are made of.
struct CampaignResult {
  CampaignIdentity identity;
  std::vector<RoundRecord> records;  ///< By variant, then round; none is missing.

  int variants() const { return static_cast<int>(identity.variants.size()); }
  const std::string& VariantName(int variant) const { return identity.variants.at(variant); }
  /// The records of one variant, round by round.
  std::vector<const RoundRecord*> OfVariant(int variant) const;
};

/// Reads all shards of all `folders` as one campaign, in whatever order they come. Throws
/// Error(kMissing) for a folder without campaign or shards, Error(kBadData) when folders belong to
/// different campaigns (naming the first key that differs), a line is damaged or half-written, a
/// round stands there twice (saying whether the rows differ) or is missing: all of these name file
/// and line, or variant and rounds.
CampaignResult ReadShards(const std::vector<std::string>& folders);

/// Reads a merged folder, or the shards of a campaign's folder that was not merged. Throws as
/// ReadShards() does.
CampaignResult ReadCampaignResult(const std::string& folder);

/// Writes picks.jsonl, timings.jsonl, rounds.jsonl (one round's summary per line), summary.json,
/// campaign.json and manifest.json. The same rounds give the same bytes in all but timings.jsonl
/// and manifest.json, the two that hold wall times.
void WriteMerged(const CampaignResult& result, const std::string& folder);

}  // namespace tubetwin
