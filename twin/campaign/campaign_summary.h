#pragma once

#include "models/base/json_fwd.h"
#include "twin/campaign/merge.h"
#include "twin/statistics/statistics.h"

namespace tubetwin {

/// {k, n, wilson95}.
Json RateJson(Counts counts);
/// {k, n, wilson95, cluster95}: with the bootstrap over clusters.
Json RateJson(const std::vector<Counts>& by_round, const RandomStream& random);
/// {n, mean, sd, p5, median, p95, max}, null when there is no value.
Json SpreadJson(const std::vector<double>& values);

/// Content of a campaign's summary.json, from `success` and truth alone, never from what the
/// pipeline believes (that is `belief`): totals over all arms, and for each arm rates with Wilson
/// intervals and, over attempts, with a bootstrap clustered by round; strata by tubes left; failure
/// classes, most frequent first; simulated times. Holds nothing that a clock measured.
Json CampaignSummary(const CampaignResult& result);

/// Content of manifest.json: versions and computing times.
Json CampaignManifest(const CampaignResult& result);

/// Both as a table for people.
std::string SummaryText(const Json& summary, const Json& manifest);

}  // namespace tubetwin
