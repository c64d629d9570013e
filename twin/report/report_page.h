#pragma once

#include <string>
#include <vector>

#include "twin/report/kept_attempt.h"
#include "twin/report/sections.h"

namespace tubetwin {

/// What was kept of rounds besides their records.
struct KeptForReport {
  std::vector<ShownAttempt> attempts;
  // Of a round's own page:
  std::string picture;  ///< Of the round, base 64, or empty.
  std::string video;    ///< Film as seen from the page; empty when there is none.
  std::string link;     ///< Result folder likewise; empty for the page's own.
};

/// Rounds as a page for people: one file, offline, light and dark, printable. Every text is
/// escaped, what is not known shows as a dash. `told` is the content of summary.json, for scripts
/// and for whoever wants the numbers themselves. Without computing times the same rounds give the
/// same bytes.
std::string ReportHtml(const ReportInput& input, const KeptForReport& kept, const Json& told);

}  // namespace tubetwin
