#pragma once

#include <string>
#include <vector>

#include "twin/campaign/merge.h"
#include "twin/report/kept_attempt.h"

namespace tubetwin {

/// A campaign as a page for people: one file, offline, light and dark, printable. All rates and
/// intervals are those of `summary` (summary.json); `manifest` (manifest.json) gives the computing
/// times; what the charts of single attempts need comes from `attempts`. Every text is escaped.
std::string CampaignReportHtml(const CampaignResult& result, const Json& summary,
                               const Json& manifest, const std::vector<ShownAttempt>& attempts);

/// Writes `file` for a campaign's folder, merged or not: rows, summary.json (made anew when there
/// is none) and what was kept of single rounds there and in `kept_folders` (folders of shards, when
/// `folder` was merged from them). Returns the page's size in bytes. Throws as ReadCampaignResult()
/// does, Error(kBadData) when summary.json tells of other rows, and what writing throws.
std::size_t WriteCampaignReport(const std::string& folder,
                                const std::vector<std::string>& kept_folders,
                                const std::string& file);

}  // namespace tubetwin
