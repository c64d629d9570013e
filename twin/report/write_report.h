#pragma once

#include <string>
#include <vector>

#include "twin/campaign/merge.h"
#include "twin/report/report_page.h"

namespace tubetwin {

/// The input of a round's page: the round as a campaign of one.
ReportInput RoundReportInput(RoundRecord record, bool computing_times,
                             const std::vector<Metric>& metrics = Metrics());
/// The input of a campaign's page.
ReportInput CampaignReportInput(CampaignResult result,
                                const std::vector<Metric>& metrics = Metrics());

/// What a person writes over the page; empty: what the page says by itself.
struct ReportHead {
  std::string title;
  std::string customer;
};

/// Writes `file` for the result folder of a round, from what lies there. Returns the page's size in
/// bytes. Throws Error(kMissing | kBadData | kCannotCreate | kIo).
std::size_t WriteRoundReport(const std::string& folder, const std::string& file,
                             bool computing_times, const ReportHead& head = {});

/// Writes `file` for a campaign's folder, merged or not, from its rows and what was kept of single
/// rounds there and in `kept_folders` (folders of shards, when `folder` was merged from them).
/// Returns the page's size in bytes. Throws as ReadCampaignResult() does, Error(kBadData) when the
/// folder's summary.json tells of other rows, and what writing throws.
std::size_t WriteCampaignReport(const std::string& folder,
                                const std::vector<std::string>& kept_folders,
                                const std::string& file, const ReportHead& head = {});

/// Where `folder` lies as seen from the folder of `file`; empty when it is that folder.
std::string LinkFrom(const std::string& file, const std::string& folder);

}  // namespace tubetwin
