#include "twin/campaign/report_html.h"

#include <cstdio>
#include <filesystem>
#include <map>
#include <utility>

#include "hw_bridge/base/files.h"
#include "hw_bridge/base/json.h"
#include "twin/campaign/report_chart.h"
#include "twin/campaign/wilson.h"

namespace tubetwin {
namespace {

constexpr const char* kDash = "\xe2\x80\x93";

std::string Escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// The value under nested keys; null when any is absent.
const Json& At(const Json& json, std::initializer_list<const char*> keys) {
  static const Json null;
  const Json* at = &json;
  for (const char* key : keys) {
    if (!at->is_object() || !at->contains(key)) return null;
    at = &(*at)[key];
  }
  return *at;
}

std::string Fixed(const Json& value, int digits) {
  if (!value.is_number()) return kDash;
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value.get<double>());
  return text;
}

/// A value as a person reads it, escaped; a dash for null and for an empty text.
std::string Shown(const Json& value) {
  if (value.is_null() || value == "") return kDash;
  if (value.is_string()) return Escape(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  return Escape(value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string Count(const Json& value) {
  return value.is_number_integer() ? std::to_string(value.get<std::int64_t>()) : kDash;
}

/// "6 of 16 (38 %, 95 % interval 18 to 61 %)".
std::string ShareText(const Json& k_json, const Json& n_json) {
  if (!k_json.is_number_integer() || !n_json.is_number_integer()) return kDash;
  const int k = k_json.get<int>();
  const int n = n_json.get<int>();
  std::string out = std::to_string(k) + " of " + std::to_string(n);
  if (k < 0 || n <= 0 || k > n) return out;
  const ShareInterval interval = Wilson95(k, n);
  char text[80];
  std::snprintf(text, sizeof text, " (%.0f %%, 95 %% interval %.0f to %.0f %%)", 100.0 * k / n,
                100.0 * interval.low, 100.0 * interval.high);
  return out + text;
}

constexpr const char* kHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src 'self' file:; media-src 'self' file:; base-uri 'none'; form-action 'none'">
<title>tubetwin: one round</title>
<style>
:root { color-scheme: light dark; --text: #1c2126; --quiet: #5b6670; --page: #ffffff; --line: #d5dade;
  --good: #14713d; --bad: #b3261e; --p0: #3b6ea5; --p1: #6aa3b8; --p2: #d08a2e; --p3: #9a9fa5; }
@media (prefers-color-scheme: dark) {
  :root { --text: #e6e9ec; --quiet: #9aa5ae; --page: #14181c; --line: #343c44;
    --good: #62c98d; --bad: #ff8a80; --p0: #6f9fd8; --p1: #7fc0d4; --p2: #e0a552; --p3: #7c848c; }
}
body { margin: 2rem auto; max-width: 68rem; padding: 0 1rem; background: var(--page); color: var(--text);
  font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.9rem; margin: 0 0 .3rem; }
h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem; }
p { max-width: 46rem; }
.quiet, figcaption, .legend { color: var(--quiet); }
.good { color: var(--good); } .bad { color: var(--bad); }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: top; padding: .3rem .8rem .3rem 0; border-bottom: 1px solid var(--line); }
th { font-weight: 600; }
td.n, th.n { text-align: right; }
.attempts td { font-size: .88rem; } .attempts td.why { min-width: 15rem; }
figure { margin: 1rem 0; } img, video, svg { max-width: 100%; height: auto; display: block; }
.grid { stroke: var(--line); } .tick { fill: var(--quiet); font-size: 12px; }
.part0 { fill: var(--p0); } .part1 { fill: var(--p1); } .part2 { fill: var(--p2); } .part3 { fill: var(--p3); }
.swatch { display: inline-block; width: .8em; height: .8em; margin: 0 .3em 0 1em; }
@media print { body { margin: 0; max-width: none; } .wide { overflow: visible; } tr, figure { break-inside: avoid; }
  video { display: none; } }
</style>
</head>
<body>
)";

std::string Row(const std::string& name, const std::string& value) {
  return "<tr><th>" + name + "</th><td>" + value + "</td></tr>\n";
}

std::string Headline(const Json& summary) {
  const Json& emptied = At(summary, {"emptied"});
  std::string out = "<h1>Placed " + Count(At(summary, {"placed"})) + " of " +
                    Count(At(summary, {"tubes_start"})) + " tubes</h1>\n<p>";
  if (emptied.is_boolean()) {
    out += emptied.get<bool>() ? "<span class=\"good\">The bin was emptied.</span> "
                               : "<span class=\"bad\">The bin was not emptied.</span> ";
  }
  out += "The round ended: " + Shown(At(summary, {"end_reason"}));
  const Json& detail = At(summary, {"end_detail"});
  if (detail.is_string() && detail != "") out += " (" + Shown(detail) + ")";
  out += ".</p>\n<table>\n";
  out += Row("Tubes placed", ShareText(At(summary, {"placed"}), At(summary, {"tubes_start"})));
  out += Row("Placed at the first attempt",
             ShareText(At(summary, {"first_attempt", "k"}), At(summary, {"first_attempt", "n"})));
  out += Row("Attempts", Count(At(summary, {"attempts"})));
  out += Row("Tubes dropped, tubes outside",
             Count(At(summary, {"dropped"})) + ", " + Count(At(summary, {"outside"})));
  out += Row("Simulated time", Fixed(At(summary, {"sim_s"}), 1) + " s, per pick " +
                                   Fixed(At(summary, {"sim_s_per_pick"}), 1) + " s");
  return out +
         "</table>\n<p class=\"quiet\">Placed is judged by the simulation's truth, which the "
         "picking pipeline never sees. Computing times are in timings.jsonl.</p>\n";
}

std::string Pictures(const ReportPictures& pictures) {
  std::string out;
  if (pictures.video) {
    out +=
        std::string("<figure><video controls preload=\"none\"") +
        (pictures.picture ? " poster=\"picture.png\"" : "") +
        " src=\"video.mp4\"></video><figcaption><a href=\"video.mp4\">The film of the round</a>: "
        "perceived centre lines in the colours of their class, the force at the wrist below."
        "</figcaption></figure>\n";
  } else if (pictures.picture) {
    out +=
        "<figure><img src=\"picture.png\" alt=\"The cell at the start of the round\">"
        "<figcaption>The cell at the start of the round.</figcaption></figure>\n";
  }
  return out;
}

TimeParts PartsOf(const Json& row) {
  TimeParts parts{};
  for (std::size_t i = 0; i < kTimeParts.size(); ++i) {
    const Json& seconds = At(row, {"sim_s", kTimeParts[i]});
    if (seconds.is_number()) parts[i] = seconds.get<double>();
  }
  return parts;
}

std::string Times(const std::vector<Json>& rows) {
  std::vector<TimeParts> attempts;
  TimeParts sums{};
  double all = 0.0;
  for (const Json& row : rows) {
    attempts.push_back(PartsOf(row));
    for (std::size_t i = 0; i < kTimeParts.size(); ++i) {
      sums[i] += attempts.back()[i];
      all += attempts.back()[i];
    }
  }
  const std::string chart = TimeChartSvg(attempts);
  if (chart.empty()) return "";
  std::string out = "<h2>Where the time goes</h2>\n<figure>" + chart + "<figcaption>";
  out += "Simulated seconds of each attempt.";
  for (std::size_t i = 0; i < kTimeParts.size(); ++i) {
    out += "<svg class=\"swatch\" viewBox=\"0 0 8 8\"><rect class=\"part" + std::to_string(i) +
           "\" width=\"8\" height=\"8\"/></svg>" + kTimeParts[i];
  }
  out +=
      "</figcaption></figure>\n<table><tr><th></th><th class=\"n\">per attempt, s</th>"
      "<th class=\"n\">in all, s</th><th class=\"n\">share</th></tr>\n";
  const auto line = [&](const std::string& name, double sum) {
    out += "<tr><th>" + name + "</th><td class=\"n\">" +
           Fixed(sum / static_cast<double>(rows.size()), 2) + "</td><td class=\"n\">" +
           Fixed(sum, 1) + "</td><td class=\"n\">" + Fixed(100.0 * sum / all, 0) + " %</td></tr>\n";
  };
  for (std::size_t i = 0; i < kTimeParts.size(); ++i) line(kTimeParts[i], sums[i]);
  line("total", all);
  return out + "</table>\n";
}

/// Why this motion: said from what the row holds.
std::string WhyChosen(const Json& row) {
  const Json& motion = At(row, {"motion"});
  if (motion.is_null()) return kDash;
  const std::string name = Shown(motion.is_object() ? At(motion, {"name"}) : motion);
  const Json& why = At(motion, {"why"});
  if (why.is_string() && why != "") return name + ": " + Shown(why);
  if (At(row, {"used_simulator"}) == true) {
    return name + ": least displacement of the other tubes in simulation, then best grasp";
  }
  if (At(row, {"class"}) == "free") return name + ": nothing lies over it, no simulation needed";
  return name + ": best ranked without simulation";
}

std::string DetectionText(const Json& row) {
  const Json& detection = At(row, {"detection"});
  if (!detection.is_object()) return kDash;
  return Shown(At(detection, {"outcome"})) + ", " + Fixed(At(detection, {"force_N"}), 2) + " N";
}

std::string ResolutionText(const Json& row) {
  if (At(row, {"resolution", "used"}) != true) return kDash;
  return Shown(At(row, {"resolution", "strategy"})) + ": " +
         Shown(At(row, {"resolution", "outcome"}));
}

std::string Attempts(const std::vector<Json>& rows) {
  std::string out =
      "<h2>Every attempt</h2>\n<div class=\"wide\"><table class=\"attempts\"><tr><th class=\"n\">"
      "#</th><th class=\"n\">try</th><th class=\"n\">in bin</th><th class=\"n\">tube</th>"
      "<th>class</th><th>motion, and why</th><th>weighed</th><th>separation</th>"
      "<th>believed</th><th>truly placed</th><th class=\"n\">time, s</th><th>reason</th></tr>\n";
  int number = 0;
  for (const Json& row : rows) {
    const Json& success = At(row, {"success"});
    const char* colour = success == true ? "good" : success == false ? "bad" : "quiet";
    out += "<tr><td class=\"n\">" + std::to_string(++number) + "</td><td class=\"n\">" +
           Count(At(row, {"attempt"})) + "</td><td class=\"n\">" +
           Count(At(row, {"tubes_in_bin"})) + "</td><td class=\"n\">" + Shown(At(row, {"target"})) +
           "</td><td>" + Shown(At(row, {"class"})) + "</td><td class=\"why\">" + WhyChosen(row) +
           "</td><td>" + DetectionText(row) + "</td><td>" + ResolutionText(row) + "</td><td>" +
           Shown(At(row, {"outcome"})) + "</td><td class=\"" + colour + "\">" + Shown(success) +
           "</td><td class=\"n\">" + Fixed(At(row, {"sim_s", "total"}), 1) +
           "</td><td class=\"why\">" + Shown(At(row, {"reason"})) + "</td></tr>\n";
  }
  return out + "</table></div>\n";
}

std::string BeliefAgainstTruth(const std::vector<Json>& rows) {
  struct Counts {
    int yes = 0;
    int no = 0;
    int unknown = 0;
  };
  std::map<std::string, Counts> by_outcome;  // Sorted by name: the same bytes every time.
  for (const Json& row : rows) {
    Counts& counts = by_outcome[Shown(At(row, {"outcome"}))];
    const Json& success = At(row, {"success"});
    ++(success == true ? counts.yes : success == false ? counts.no : counts.unknown);
  }
  std::string out =
      "<h2>Belief against truth</h2>\n<table><tr><th>the pipeline believed</th><th class=\"n\">"
      "truly placed</th><th class=\"n\">not placed</th><th class=\"n\">unknown</th></tr>\n";
  for (const auto& [outcome, counts] : by_outcome) {
    out += "<tr><th>" + outcome + "</th><td class=\"n\">" + std::to_string(counts.yes) +
           "</td><td class=\"n\">" + std::to_string(counts.no) + "</td><td class=\"n\">" +
           std::to_string(counts.unknown) + "</td></tr>\n";
  }
  return out + "</table>\n";
}

}  // namespace

std::string ReportHtml(const Json& summary, const std::vector<Json>& rows,
                       const ReportPictures& pictures) {
  std::string out = kHead + Headline(summary) + Pictures(pictures);
  if (rows.empty()) {
    out += "<p>There was no attempt.</p>\n";
  } else {
    out += Times(rows) + Attempts(rows) + BeliefAgainstTruth(rows);
  }
  return out + "</body>\n</html>\n";
}

void WriteReport(const Json& summary, const std::vector<Json>& rows, const std::string& folder) {
  const std::filesystem::path at(folder);
  ReportPictures pictures;
  pictures.picture = std::filesystem::exists(at / "picture.png");
  pictures.video = std::filesystem::exists(at / "video.mp4");
  WriteFileAtomically((at / "report.html").string(), ReportHtml(summary, rows, pictures));
}

}  // namespace tubetwin
