#pragma once

#include <string>
#include <vector>

#include "hw_bridge/base/json_fwd.h"

namespace tubetwin {

/// Which of the round's pictures lie beside the report.
struct ReportPictures {
  bool picture = false;  ///< picture.png
  bool video = false;    ///< video.mp4
};

/// One round as a page for people: whole in itself but for picture and film, without scripts, in
/// light and dark, printable. `summary` is summary.json, `rows` are the lines of picks.jsonl; every
/// text from them is escaped, absent or null fields show as a dash. Holds nothing that a clock
/// measured, so that the same round gives the same bytes; computing times stay in timings.jsonl.
std::string ReportHtml(const Json& summary, const std::vector<Json>& rows,
                       const ReportPictures& pictures);

/// Writes FOLDER/report.html with what pictures lie there. Throws Error(kCannotCreate | kIo).
void WriteReport(const Json& summary, const std::vector<Json>& rows, const std::string& folder);

}  // namespace tubetwin
