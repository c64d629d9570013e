#include "twin/report/round_page.h"

#include <filesystem>
#include <map>
#include <sstream>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/report/chart.h"
#include "twin/report/page.h"
#include "twin/report/parts.h"
#include "twin/report/text.h"
#include "twin/round/attempt_facts.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

std::string Headline(const RoundReportInput& input) {
  const Json& s = input.summary;
  const Json& emptied = At(s, "/emptied");
  std::string lead;
  if (emptied.is_boolean()) {
    lead += emptied.get<bool>() ? "<b class=\"good\">The bin was emptied.</b> "
                                : "<b class=\"bad\">The bin was not emptied.</b> ";
  }
  lead += "The round ended: " + Shown(At(s, "/end_reason"));
  const Json& detail = At(s, "/end_detail");
  if (detail.is_string() && detail != "") lead += " (" + Shown(detail) + ")";
  std::string out = HeaderHtml(
      "One round",
      "Placed " + CountHtml(s, "/placed") + " of " + CountHtml(s, "/tubes_start") + " tubes",
      lead + ".");
  out += "<div class=\"cards\">\n" +
         RateCard("Attempts that placed exactly one tube", s, "/success") +
         RateCard("Placed tubes that took one attempt", s, "/first_attempt") + "</div>\n";
  return out + FactList({{"attempts", CountHtml(s, "/attempts")},
                         {"dropped", CountHtml(s, "/dropped")},
                         {"outside", CountHtml(s, "/outside")},
                         {"simulated time, s", FixedHtml(s, "/sim_s", 1)},
                         {"per placed tube, s", FixedHtml(s, "/sim_s_per_pick", 1)}});
}

std::string PictureHtml(const RoundReportInput& input) {
  std::string out;
  if (!input.picture.empty()) {
    out += "<canvas class=\"picture\" data-picture=\"" + std::to_string(input.attempts.size()) +
           "\" role=\"img\" aria-label=\"The cell at the start of the round\"></canvas>";
  }
  if (!input.video.empty()) {
    out +=
        "<p class=\"links\"><a href=\"" + Escaped(input.video) + "\">The film of the round</a></p>";
  }
  return out;
}

TimeParts PartsOf(const Json& row) {
  TimeParts parts{};
  for (std::size_t i = 0; i < kTimeParts.size(); ++i) {
    const Json& seconds = At(row, std::string("/sim_s/") + kTimeParts[i]);
    if (seconds.is_number()) parts[i] = seconds.get<double>();
  }
  return parts;
}

/// Seconds of computing per part, summed over the attempts.
std::map<std::string, double> ComputeSums(const std::vector<Json>& timings) {
  std::map<std::string, double> sums;
  for (const Json& row : timings) {
    for (const char* part : {"modelling", "planning", "evaluator"}) {
      const Json& seconds = At(row, std::string("/compute_s/") + part);
      if (seconds.is_number()) sums[part] += seconds.get<double>();
    }
  }
  return sums;
}

std::string TimeTable(const RoundReportInput& input, const TimeParts& sums) {
  const std::map<std::string, double> computing = ComputeSums(input.timings);
  double all = 0.0;
  for (const double sum : sums) all += sum;
  for (const auto& [part, sum] : computing) all += sum;
  std::string out =
      "<div class=\"wide\"><table><tr><th></th><th class=\"n\">per attempt, s</th>"
      "<th class=\"n\">in all, s</th><th class=\"n\">share</th></tr>\n";
  const auto line = [&](const std::string& name, double sum) {
    out += "<tr><th>" + name + "</th>" +
           NumberCell(Fixed(sum / static_cast<double>(input.rows.size()), 2)) +
           NumberCell(Fixed(sum, 1)) + NumberCell(Fixed(100.0 * sum / all, 0) + "&nbsp;%") +
           "</tr>\n";
  };
  for (std::size_t i = 0; i < kTimeParts.size(); ++i) line(kTimeParts[i], sums[i]);
  for (const auto& [part, sum] : computing) line("computing: " + part, sum);
  line("total", all);
  return out + "</table></div>\n" +
         (computing.empty() ? "<p class=\"quiet\">Simulated seconds; computing times are in "
                              "timings.jsonl.</p>\n"
                            : "");
}

std::string Times(const RoundReportInput& input) {
  std::vector<TimeBar> bars;
  TimeParts sums{};
  for (const Json& row : input.rows) {
    const Json& success = At(row, "/success");
    bars.push_back({PartsOf(row), success.is_boolean() ? std::optional<bool>(success.get<bool>())
                                                       : std::nullopt});
    for (std::size_t i = 0; i < kTimeParts.size(); ++i) sums[i] += bars.back().seconds[i];
  }
  const std::string chart = TimeChartSvg(bars);
  if (chart.empty()) return "";
  std::vector<std::pair<std::string, std::string>> legend;
  for (std::size_t i = 0; i < kTimeParts.size(); ++i) {
    legend.emplace_back("part" + std::to_string(i), kTimeParts[i]);
  }
  return Figure(chart,
                "Simulated seconds of each attempt; <span class=\"bad\">\xc3\x97</span> did "
                "not place exactly one tube. " +
                    Legend(legend)) +
         TimeTable(input, sums);
}

/// Attempts by how many tubes the pipeline saw in the bin, and of them those that placed one.
std::string TubesLeft(const std::vector<AttemptFacts>& facts) {
  std::map<int, std::pair<int, int>, std::greater<>> counts;
  for (const AttemptFacts& fact : facts) {
    auto& [placed, failed] = counts[fact.tubes_left];
    ++(fact.failure.empty() ? placed : failed);
  }
  std::vector<BarRow> rows;
  for (const auto& [left, count] : counts) {
    const auto [placed, failed] = count;
    rows.push_back({std::to_string(left) + (left == 1 ? " tube left" : " tubes left"),
                    {static_cast<double>(placed), static_cast<double>(failed)},
                    std::to_string(placed) + " of " + std::to_string(placed + failed)});
  }
  return Figure(BarsSvg(rows, {"good-bar", "bad-bar"}, "Attempts by tubes left"),
                "Attempts by tubes left in the bin: " +
                    Legend({{"good-bar", "placed one"}, {"bad-bar", "did not"}}));
}

std::string Failures(const std::vector<AttemptFacts>& facts) {
  std::map<std::string, int> counts;
  for (const AttemptFacts& fact : facts) {
    if (!fact.failure.empty()) ++counts[fact.failure];
  }
  std::vector<BarRow> rows;
  for (const auto& [failure, count] : counts) {
    rows.push_back({FailureName(failure), {static_cast<double>(count)}, std::to_string(count)});
  }
  if (rows.empty()) return "<p class=\"good\">No attempt failed.</p>\n";
  return Figure(BarsSvg(rows, {"bad-bar"}, "Failures by class"), "Failed attempts by class.");
}

std::string MotionName(const Json& row) {
  const Json& motion = At(row, "/motion");
  const Json& name = motion.is_object() ? At(motion, "/name") : motion;
  return name.is_string() ? name.get<std::string>() : "";
}

std::string Motions(const std::vector<AttemptFacts>& facts) {
  struct Counts {
    int attempts = 0, placed = 0, simulated = 0;
    double move_s = 0.0;
  };
  std::map<std::string, Counts> table;
  for (const AttemptFacts& fact : facts) {
    Counts& counts = table[MotionName(*fact.row)];
    ++counts.attempts;
    counts.placed += fact.failure.empty() ? 1 : 0;
    counts.simulated += At(*fact.row, "/used_simulator") == true ? 1 : 0;
    counts.move_s += PartsOf(*fact.row)[1];
  }
  std::string out =
      "<div class=\"wide\"><table><tr><th>motion</th><th class=\"n\">attempts</th><th "
      "class=\"n\">placed one</th><th class=\"n\">simulated first</th><th class=\"n\">mean "
      "movement, s</th></tr>\n";
  for (const auto& [motion, counts] : table) {
    out += "<tr><th>" + (motion.empty() ? "no plan" : Escaped(motion)) + "</th>" +
           NumberCell(std::to_string(counts.attempts)) + NumberCell(std::to_string(counts.placed)) +
           NumberCell(std::to_string(counts.simulated)) +
           NumberCell(Fixed(counts.move_s / counts.attempts, 1)) + "</tr>\n";
  }
  return out + "</table></div>\n";
}

/// Why this motion: said from what the row holds.
std::string WhyChosen(const Json& row) {
  const std::string name = MotionName(row);
  if (name.empty()) return kDash;
  if (At(row, "/used_simulator") == true) {
    return Escaped(name) + ": least displacement of the other tubes in simulation, then best grasp";
  }
  if (At(row, "/class") == "free") {
    return Escaped(name) + ": nothing lies over it, no simulation needed";
  }
  return Escaped(name) + ": best ranked without simulation";
}

std::string DetectionText(const Json& row) {
  const Json& detection = At(row, "/detection");
  if (!detection.is_object()) return kDash;
  return Shown(At(detection, "/outcome")) + ", " + Fixed(At(detection, "/force_N"), 2) + "&nbsp;N";
}

std::string ResolutionText(const Json& row) {
  if (At(row, "/resolution/used") != true) return kDash;
  return Shown(At(row, "/resolution/strategy")) + ": " + Shown(At(row, "/resolution/outcome"));
}

std::string Attempts(const RoundReportInput& input) {
  std::string out =
      "<div class=\"wide\"><table class=\"attempts\"><tr><th class=\"n\">#</th><th class=\"n\">"
      "try</th><th class=\"n\">seen in bin</th><th class=\"n\">tube</th><th>class</th>"
      "<th>motion, and why</th><th>weighed</th><th>separation</th><th>believed</th>"
      "<th>placed one</th><th class=\"n\">time, s</th><th>reason</th></tr>\n";
  int number = 0;
  for (const Json& row : input.rows) {
    const Json& success = At(row, "/success");
    const char* colour = success == true ? "good" : success == false ? "bad" : "quiet";
    out += "<tr>" + NumberCell(std::to_string(++number)) + NumberCell(Shown(At(row, "/attempt"))) +
           NumberCell(Shown(At(row, "/tubes_in_bin"))) + NumberCell(Shown(At(row, "/target"))) +
           "<td>" + Shown(At(row, "/class")) + "</td><td class=\"why\">" + WhyChosen(row) +
           "</td><td>" + DetectionText(row) + "</td><td>" + ResolutionText(row) + "</td><td>" +
           Shown(At(row, "/outcome")) + "</td><td class=\"" + colour + "\">" + Shown(success) +
           "</td>" + NumberCell(Fixed(At(row, "/sim_s/total"), 1)) + "<td class=\"why\">" +
           Shown(At(row, "/reason")) + "</td></tr>\n";
  }
  return out + "</table></div>\n";
}

std::string Belief(const std::vector<Json>& rows) {
  struct Counts {
    int yes = 0, no = 0, unknown = 0;
  };
  std::map<std::string, Counts> by_outcome;  // Sorted by name: the same bytes every time.
  for (const Json& row : rows) {
    const Json& outcome = At(row, "/outcome");
    Counts& counts = by_outcome[outcome.is_string() ? outcome.get<std::string>() : kDash];
    const Json& success = At(row, "/success");
    ++(success == true ? counts.yes : success == false ? counts.no : counts.unknown);
  }
  std::vector<BeliefCounts> table;
  for (const auto& [outcome, counts] : by_outcome) {
    table.push_back({outcome, std::to_string(counts.yes), std::to_string(counts.no),
                     std::to_string(counts.unknown)});
  }
  return BeliefTable(table);
}

}  // namespace

std::string RoundReportHtml(const RoundReportInput& input) {
  std::string body = Headline(input) + PictureHtml(input);
  RoundRecord record;
  record.summary = input.summary;
  record.picks = input.rows;
  if (input.rows.empty()) {
    body += "<p>There was no attempt.</p>\n";
  } else {
    const std::vector<AttemptFacts> facts = FactsOf(record);
    body += "<div class=\"two\">" + Section("left", "Success by tubes left", TubesLeft(facts)) +
            Section("failures", "Failure classes", Failures(facts)) + "</div>\n" +
            Section("times", "Where the time goes", Times(input)) +
            Section("view", "One attempt in 3-D", ViewerHtml(input.attempts)) +
            Section("gallery", "Failed attempts", GalleryHtml(input.attempts)) +
            Section("forces", "Load at the wrist", TracesHtml(input.attempts)) +
            "<div class=\"two\">" + Section("motions", "Motions", Motions(facts)) +
            Section("belief", "Belief against truth", Belief(input.rows)) + "</div>\n" +
            Section("attempts", "Every attempt", Attempts(input));
  }
  const bool believed = At(input.summary, "/scored_by") == "belief";
  body +=
      std::string("<footer><p>") +
      (believed ? "The cell of this round has no truth: what was placed is what the picking "
                  "pipeline believes. This command, run in the folder of this page, runs the cell "
                  "again:"
                : "Success is judged by the simulation's truth, which the picking pipeline never "
                  "sees. This command, run in the folder of this page, repeats the round:") +
      "</p><pre class=\"command\">" + Escaped(RepeatCommand(input.link)) + "</pre></footer>\n";
  Json data = AttemptData(input.attempts);
  if (!input.picture.empty()) data["pictures"].push_back(input.picture);
  Json content{{"schema", "tubetwin/report/1"}, {"kind", "round"}, {"summary", input.summary}};
  content.update(data);
  return ReportPage("tubetwin: one round", body, content);
}

std::vector<Json> ReadJsonLines(const std::string& path) {
  std::vector<Json> rows;
  std::istringstream lines(ReadFile(path));
  for (std::string line; std::getline(lines, line);) {
    Json row = Json::parse(line, nullptr, false);
    if (!row.is_object()) {
      throw Error(ErrorKind::kBadData,
                  path + ":" + std::to_string(rows.size() + 1) + ": not a JSON object");
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string LinkFrom(const std::string& file, const std::string& folder) {
  const fs::path from = fs::absolute(file).parent_path();
  const std::string link =
      fs::absolute(folder).lexically_normal().lexically_relative(from.lexically_normal()).string();
  return link == "." || link == "./" ? "" : link;
}

std::size_t WriteRoundReport(const std::string& folder, const std::string& file, bool timings) {
  const fs::path at(folder);
  RoundReportInput input;
  const std::string summary = (at / "summary.json").string();
  input.summary = ReadJsonFile(summary);
  RequireSchema(JsonView(input.summary, summary), "summary");
  JsonView(input.summary, summary).Field("tubes_start").AsInteger();
  input.rows = ReadJsonLines((at / "picks.jsonl").string());
  if (timings && fs::exists(at / "timings.jsonl")) {
    input.timings = ReadJsonLines((at / "timings.jsonl").string());
  }
  RoundRecord record;
  record.summary = input.summary;
  record.picks = input.rows;
  ShownLimits limits;
  input.link = LinkFrom(file, folder);
  input.attempts = ShownAttempts(record, folder, input.link, ShownKind::kAll, limits);
  if (fs::exists(at / "picture.png")) {
    input.picture = Base64(ReadFile((at / "picture.png").string()));
  }
  if (fs::exists(at / "video.mp4")) {
    input.video = (fs::path(input.link) / "video.mp4").string();
  }
  const std::string html = RoundReportHtml(input);
  WriteFileAtomically(file, html);
  return html.size();
}

}  // namespace tubetwin
