#pragma once

#include <string>
#include <vector>

#include "models/base/json.h"
#include "twin/report/kept_attempt.h"

namespace tubetwin {

/// What one round's page is made of.
struct RoundReportInput {
  Json summary;            ///< Content of summary.json.
  std::vector<Json> rows;  ///< Of picks.jsonl.
  std::vector<Json>
      timings;  ///< Of timings.jsonl, or empty: then the page tells no computing time.
  std::vector<ShownAttempt> attempts;  ///< What more was kept.
  std::string picture;                 ///< Of the round, base 64, or empty.
  std::string video;                   ///< Film as seen from the page; empty when there is none.
  std::string link;                    ///< Result folder likewise; empty for the page's own.
};

/// One round as a page for people: one file, offline, light and dark, printable. Every text is
/// escaped, absent or null fields show as a dash. Without timings it holds nothing that a clock
/// measured: the same round gives the same bytes.
std::string RoundReportHtml(const RoundReportInput& input);

/// Writes `file` for the result folder `folder`, from what lies there; `timings`: with computing
/// times. Returns the page's size in bytes. Throws Error(kMissing | kBadData | kCannotCreate |
/// kIo).
std::size_t WriteRoundReport(const std::string& folder, const std::string& file, bool timings);

/// Objects of a file of one JSON object per line. Throws Error(kMissing | kBadData) naming the
/// line.
std::vector<Json> ReadJsonLines(const std::string& path);

/// Where `folder` lies as seen from the folder of `file`; empty when it is that folder.
std::string LinkFrom(const std::string& file, const std::string& folder);

}  // namespace tubetwin
