#pragma once

#include <string>
#include <vector>

#include "twin/campaign/campaign_summary.h"
#include "twin/report/front/study_setup.h"
#include "twin/report/text.h"

namespace tubetwin {

/// What a page is made of: the rounds of a campaign, or one round as a campaign of one.
struct ReportInput {
  CampaignResult result;
  CampaignSummary summary;      ///< Of the result.
  CampaignManifest manifest;    ///< Likewise.
  bool computing_times = true;  ///< Tell them; without, nothing on the page comes from a clock.
  bool is_round = false;        ///< Of one round: then the result has one record.
  std::string title, customer;  ///< Plain text; empty: what the page says by itself.
  /// What each variant was run with; empty: the page does not tell it.
  std::vector<StudySetup> setups;
};

/// The parts an hour that the page tells of a variant: with computing time where it is told and was
/// kept, else of the cell alone.
const PartsPerHour& PageRate(const ReportInput& input, std::size_t variant);

/// Where a variant's numbers stand in summary.json; a single round's summary has no variants.
Pointer VariantPointer(const ReportInput& input, std::size_t variant);

/// Sections of pages as HTML, without their headings; empty where there is nothing to say.

/// Name, rounds, rates and losses of each variant; nothing for a single one.
std::string VariantsTable(const ReportInput& input);
/// Success by tubes left: a chart with intervals, and the numbers folded away.
std::string TubesLeft(const ReportInput& input);
/// Where the time goes: of one round each attempt, of several means and a distribution.
std::string Times(const ReportInput& input);
std::string Motions(const ReportInput& input);
/// The metrics that stand neither at the head nor among the times, a column for each variant.
std::string Measures(const ReportInput& input);
/// What the pipeline believed, against truth.
std::string Belief(const ReportInput& input);
/// Attempts row by row: all of a round, the failed ones of a campaign.
std::string AttemptsTable(const ReportInput& input);

/// What the page's chart of attempt times draws: {step_s, variants: [{name, counts}]}.
Json TimesHistogram(const CampaignResult& result);

}  // namespace tubetwin
