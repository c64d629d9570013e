#include "twin/report/campaign_page.h"

#include <algorithm>
#include <cmath>

#include "models/base/json.h"
#include "twin/report/chart.h"
#include "twin/report/page.h"
#include "twin/report/parts.h"
#include "twin/report/text.h"
#include "twin/round/attempt_facts.h"

namespace tubetwin {
namespace {

constexpr std::size_t kArmsInOneChart = 6;  // As many colours as there are.

std::string ArmPointer(std::size_t arm) { return "/arms/" + std::to_string(arm); }

std::size_t ArmCount(const Json& summary) { return At(summary, "/arms").size(); }

std::string ArmName(const Json& summary, std::size_t arm) {
  return At(summary, ArmPointer(arm) + "/name").get<std::string>();
}

std::string Headline(const CampaignResult& result, const Json& summary) {
  const std::size_t arms = ArmCount(summary);
  std::string eyebrow = "Campaign, seed " + CountHtml(summary, "/seed") + ", program " +
                        Shown(At(result.identity, "/program")) + ", MuJoCo " +
                        Shown(At(result.identity, "/mujoco"));
  const std::string lead =
      CountHtml(summary, "/rounds") + " bins with " + CountHtml(summary, "/tubes_start") +
      " tubes" +
      (arms > 1 ? " in " + std::to_string(arms) + " arms that share the seeds of their rounds"
                : ": " + Escaped(ArmName(summary, 0))) +
      ".";
  std::string out = HeaderHtml(eyebrow,
                               "Placed " + CountHtml(summary, "/placed") + " of " +
                                   CountHtml(summary, "/tubes_start") + " tubes",
                               lead);
  // One arm has the intervals by rounds, the totals over arms have not.
  const std::string at = arms == 1 ? ArmPointer(0) : "";
  out += "<div class=\"cards\">\n" +
         RateCard("Attempts that placed exactly one tube", summary, at + "/success") +
         RateCard("Placed tubes that took one attempt", summary, at + "/first_attempt") +
         RateCard("Bins emptied", summary, at + "/emptied") + "</div>\n";
  return out + FactList({{"rounds", CountHtml(summary, "/rounds")},
                         {"attempts", CountHtml(summary, "/attempts")},
                         {"several placed", CountHtml(summary, "/several_placed")},
                         {"dropped", CountHtml(summary, "/dropped")},
                         {"outside", CountHtml(summary, "/outside")},
                         {"rounds crashed", CountHtml(summary, "/crashed")}});
}

std::string RateCells(const Json& summary, const std::string& pointer) {
  const Json& n = At(summary, pointer + "/n");
  std::string mark;
  if (n.is_number_integer() && n > 0) {
    mark = IntervalMarkSvg(At(summary, pointer + "/k").get<double>() / n.get<double>(),
                           At(summary, pointer + "/wilson95/0").get<double>(),
                           At(summary, pointer + "/wilson95/1").get<double>());
  }
  return "<td class=\"rate\"><b>" + SharePercentHtml(summary, pointer) + "</b> " + mark +
         "<span class=\"quiet\">" + ShareDetailHtml(summary, pointer) + "</span></td>";
}

std::string ArmsTable(const Json& summary) {
  if (ArmCount(summary) < 2) return "";
  std::string out =
      "<div class=\"wide\"><table class=\"arms\"><tr><th>arm</th><th class=\"n\">bins</th>"
      "<th>success</th><th>at the first attempt</th><th>emptied</th><th class=\"n\">outside</th>"
      "<th class=\"n\">several</th><th class=\"n\">dropped</th></tr>\n";
  for (std::size_t arm = 0; arm < ArmCount(summary); ++arm) {
    const std::string at = ArmPointer(arm);
    out += "<tr><th>" + Escaped(ArmName(summary, arm)) + "</th>" +
           NumberCell(CountHtml(summary, at + "/rounds")) + RateCells(summary, at + "/success") +
           RateCells(summary, at + "/first_attempt") + RateCells(summary, at + "/emptied") +
           NumberCell(CountHtml(summary, at + "/outside")) +
           NumberCell(CountHtml(summary, at + "/several_placed")) +
           NumberCell(CountHtml(summary, at + "/dropped")) + "</tr>\n";
  }
  return out + "</table></div>\n";
}

IntervalSeries TubesLeftSeries(const Json& summary, std::size_t arm) {
  IntervalSeries series;
  series.name = ArmName(summary, arm);
  for (const Json& row : At(summary, ArmPointer(arm) + "/by_tubes_left")) {
    const int n = At(row, "/success/n").get<int>();
    if (n == 0) continue;
    const int k = At(row, "/success/k").get<int>();
    IntervalPoint point;
    point.x = row["tubes_left"];
    point.share = static_cast<double>(k) / n;
    point.low = At(row, "/success/wilson95/0").get<double>();
    point.high = At(row, "/success/wilson95/1").get<double>();
    point.hint = series.name + ", " + std::to_string(point.x) + " left: " + std::to_string(k) +
                 " of " + std::to_string(n) + ", 95 % " + Fixed(100.0 * point.low, 1) + " to " +
                 Fixed(100.0 * point.high, 1) + " %";
    series.points.push_back(point);
  }
  return series;
}

std::string TubesLeftTable(const Json& summary, std::size_t arm) {
  const std::string at = ArmPointer(arm) + "/by_tubes_left";
  std::string out =
      "<table><tr><th class=\"n\">tubes left</th><th>success</th><th>of the placed, at the first "
      "attempt</th></tr>\n";
  for (std::size_t i = 0; i < At(summary, at).size(); ++i) {
    const std::string row = at + "/" + std::to_string(i);
    out += "<tr>" + NumberCell(CountHtml(summary, row + "/tubes_left")) + "<td>" +
           SharePercentHtml(summary, row + "/success") + " <span class=\"quiet\">" +
           ShareDetailHtml(summary, row + "/success") + "</span></td><td>" +
           SharePercentHtml(summary, row + "/first_attempt") + " <span class=\"quiet\">" +
           ShareDetailHtml(summary, row + "/first_attempt") + "</span></td></tr>\n";
  }
  return out + "</table>\n";
}

std::string TubesLeft(const Json& summary) {
  const std::size_t arms = ArmCount(summary);
  std::vector<IntervalSeries> series;
  std::vector<std::pair<std::string, std::string>> legend;
  std::string out;
  for (std::size_t arm = 0; arm < arms; ++arm) {
    series.push_back(TubesLeftSeries(summary, arm));
    legend.emplace_back("arm" + std::to_string(series.size() - 1), ArmName(summary, arm));
    if (series.size() < kArmsInOneChart && arm + 1 < arms) continue;
    out += Figure(
        IntervalChartSvg(series, "tubes left in the bin"),
        "Attempts that placed exactly one tube, with 95&nbsp;% intervals. " + Legend(legend));
    series.clear();
    legend.clear();
  }
  std::string tables;
  for (std::size_t arm = 0; arm < arms; ++arm) {
    tables += (arms > 1 ? "<h3>" + Escaped(ArmName(summary, arm)) + "</h3>" : "") +
              "<div class=\"wide\">" + TubesLeftTable(summary, arm) + "</div>";
  }
  return out + "<details><summary>The numbers</summary>" + tables + "</details>\n";
}

std::string Failures(const Json& summary) {
  std::string out;
  for (std::size_t arm = 0; arm < ArmCount(summary); ++arm) {
    std::vector<BarRow> rows;
    for (const auto& [failure, count] : At(summary, ArmPointer(arm) + "/failures").items()) {
      rows.push_back({FailureName(failure), {count.get<double>()}, count.dump()});
    }
    if (ArmCount(summary) > 1) out += "<h3>" + Escaped(ArmName(summary, arm)) + "</h3>";
    out += rows.empty() ? "<p class=\"good\">No attempt failed.</p>\n"
                        : Figure(BarsSvg(rows, {"bad-bar"}, "Failed attempts by class"), "");
    std::string ends;
    for (const auto& [end, count] : At(summary, ArmPointer(arm) + "/end_reasons").items()) {
      ends += (ends.empty() ? "" : ", ") + Escaped(FailureName(end)) + " " + count.dump();
    }
    out += "<p class=\"quiet\">Rounds ended: " + ends + ".</p>\n";
  }
  return out;
}

/// The parts of an attempt's time: where the mean and the spread of each stand, in which document.
struct TimePart {
  std::string name, css_class;
  bool computing = false;
};
const std::vector<TimePart>& AllTimeParts() {
  static const std::vector<TimePart> parts = {{"scan", "part0"},
                                              {"move", "part1"},
                                              {"weigh", "part2"},
                                              {"settle", "part3"},
                                              {"modelling", "part4", true},
                                              {"planning", "part4", true},
                                              {"evaluator", "part4", true}};
  return parts;
}

std::string SpreadPointer(std::size_t arm, const TimePart& part) {
  return part.computing ? "/compute_s/" + std::to_string(arm) + "/" + part.name + "/all"
                        : ArmPointer(arm) + "/sim_s/attempt/" + part.name;
}

std::string SpreadCells(const Json& json, const std::string& pointer, bool is_summary) {
  std::string out;
  for (const char* key : {"mean", "median", "p5", "p95", "max"}) {
    const std::string at = pointer + "/" + key;
    out += NumberCell(is_summary ? FixedHtml(json, at, 2) : Fixed(At(json, at), 2));
  }
  return out;
}

std::string Times(const Json& summary, const Json& manifest) {
  std::vector<BarRow> bars;
  std::vector<std::string> classes;
  for (const TimePart& part : AllTimeParts()) classes.push_back(part.css_class);
  std::string table =
      "<div class=\"wide\"><table><tr><th>seconds per attempt</th><th class=\"n\">mean</th>"
      "<th class=\"n\">median</th><th class=\"n\">5 %</th><th class=\"n\">95 %</th>"
      "<th class=\"n\">longest</th></tr>\n";
  for (std::size_t arm = 0; arm < ArmCount(summary); ++arm) {
    BarRow bar{ArmName(summary, arm), {}, ""};
    double sum = 0.0;
    table += "<tr class=\"group\"><th colspan=\"6\">" + Escaped(bar.name) + "</th></tr>\n";
    for (const TimePart& part : AllTimeParts()) {
      const std::string at = SpreadPointer(arm, part);
      const Json& mean = At(part.computing ? manifest : summary, at + "/mean");
      bar.segments.push_back(mean.is_number() ? mean.get<double>() : 0.0);
      sum += bar.segments.back();
      table += "<tr><th>" + std::string(part.computing ? "computing: " : "") + part.name + "</th>" +
               SpreadCells(part.computing ? manifest : summary, at, !part.computing) + "</tr>\n";
    }
    bar.told = Fixed(sum, 1) + " s";
    bars.push_back(std::move(bar));
    const std::string sim = ArmPointer(arm) + "/sim_s";
    table += "<tr><th>simulated, all of an attempt</th>" +
             SpreadCells(summary, sim + "/attempt/total", true) +
             "</tr>\n<tr><th>simulated, per placed tube</th>" +
             SpreadCells(summary, sim + "/placed_tube", true) +
             "</tr>\n<tr><th>simulated, per bin</th>" + SpreadCells(summary, sim + "/round", true) +
             "</tr>\n";
  }
  return "<div class=\"two\">" +
         Figure(BarsSvg(bars, classes, "Mean seconds of an attempt"),
                "Mean seconds of an attempt: simulated time of the cell plus computing time. " +
                    Legend({{"part0", "scan"},
                            {"part1", "move"},
                            {"part2", "weigh"},
                            {"part3", "settle"},
                            {"part4", "computing"}})) +
         "<figure class=\"chart-box\"><div class=\"chart-height\"><canvas id=\"times-chart\" "
         "role=\"img\" aria-label=\"Distribution of attempt times\"></canvas></div><figcaption>"
         "How long attempts took, simulated.</figcaption></figure></div>\n<details><summary>The "
         "numbers"
         "</summary>" +
         table + "</table></div></details>\n";
}

/// How many attempts of each arm took how long: {edges_s, arms: [{name, counts}]}.
Json TimesHistogram(const CampaignResult& result) {
  std::vector<std::vector<double>> all(static_cast<std::size_t>(result.arms()));
  double longest = 0.0;
  for (const RoundRecord& record : result.records) {
    for (const Json& row : record.picks) {
      const Json& total = At(row, "/sim_s/total");
      if (!total.is_number()) continue;
      all[static_cast<std::size_t>(record.arm)].push_back(total.get<double>());
      longest = std::max(longest, total.get<double>());
    }
  }
  constexpr double kBins = 40.0;
  const double step = longest > 0.0 ? std::max(0.5, std::ceil(2.0 * longest / kBins) / 2.0) : 1.0;
  const auto bins = static_cast<std::size_t>(longest / step) + 1;
  Json out{{"step_s", step}, {"arms", Json::array()}};
  for (int arm = 0; arm < result.arms(); ++arm) {
    std::vector<int> counts(bins, 0);
    for (const double s : all[static_cast<std::size_t>(arm)]) {
      ++counts[std::min(bins - 1, static_cast<std::size_t>(s / step))];
    }
    out["arms"].push_back(Json{{"name", result.ArmName(arm)}, {"counts", counts}});
  }
  return out;
}

std::string Motions(const Json& summary) {
  std::string rows;
  for (std::size_t arm = 0; arm < ArmCount(summary); ++arm) {
    const std::string at = ArmPointer(arm) + "/by_motion";
    if (!At(summary, at).is_array()) continue;
    rows +=
        "<tr class=\"group\"><th colspan=\"5\">" + Escaped(ArmName(summary, arm)) + "</th></tr>\n";
    for (std::size_t i = 0; i < At(summary, at).size(); ++i) {
      const std::string row = at + "/" + std::to_string(i);
      rows += "<tr><th>" + Shown(At(summary, row + "/motion")) + "</th>" +
              NumberCell(CountHtml(summary, row + "/success/n")) + "<td>" +
              SharePercentHtml(summary, row + "/success") + " <span class=\"quiet\">" +
              ShareDetailHtml(summary, row + "/success") + "</span></td>" +
              NumberCell(CountHtml(summary, row + "/used_simulator")) +
              NumberCell(FixedHtml(summary, row + "/move_s/median", 1)) + "</tr>\n";
    }
  }
  if (rows.empty()) return "";
  return "<div class=\"wide\"><table><tr><th>motion</th><th class=\"n\">attempts</th>"
         "<th>success</th><th class=\"n\">simulated first</th><th class=\"n\">median movement, "
         "s</th></tr>\n" +
         rows + "</table></div>\n";
}

std::string Belief(const Json& summary) {
  std::string out;
  for (std::size_t arm = 0; arm < ArmCount(summary); ++arm) {
    std::vector<BeliefCounts> rows;
    const std::string at = ArmPointer(arm) + "/belief";
    for (const auto& [outcome, counts] : At(summary, at).items()) {
      const std::string row = at + "/" + outcome;
      const int failed = counts["attempts"].get<int>() - counts["success"].get<int>();
      rows.push_back({outcome, CountHtml(summary, row + "/success"), std::to_string(failed), "0"});
    }
    if (ArmCount(summary) > 1) out += "<h3>" + Escaped(ArmName(summary, arm)) + "</h3>";
    out += BeliefTable(rows);
  }
  return out;
}

std::string Steps(const Json& summary) {
  std::string out =
      "<div class=\"wide\"><table><tr><th></th><th>used</th><th>success where used</th></tr>\n";
  for (std::size_t arm = 0; arm < ArmCount(summary); ++arm) {
    for (const auto& [key, name] : {std::pair("simulator", "simulation of motions"),
                                    std::pair("resolution", "separation in the air")}) {
      const std::string at = ArmPointer(arm) + "/" + key;
      out += "<tr><th>" + Escaped(ArmName(summary, arm)) + ": " + name + "</th><td>" +
             SharePercentHtml(summary, at + "/used") + " <span class=\"quiet\">" +
             ShareDetailHtml(summary, at + "/used") + "</span></td><td>" +
             SharePercentHtml(summary, at + "/success") + " <span class=\"quiet\">" +
             ShareDetailHtml(summary, at + "/success") + "</span></td></tr>\n";
    }
  }
  return out + "</table></div>\n";
}

/// The first failed attempts, row by row.
std::string FailedRows(const CampaignResult& result) {
  constexpr int kMost = 200;
  std::string rows;
  int shown = 0, failed = 0;
  for (const RoundRecord& record : result.records) {
    const std::vector<AttemptFacts> facts = FactsOf(record);
    for (std::size_t i = 0; i < facts.size(); ++i) {
      if (facts[i].failure.empty() || ++failed > kMost) continue;
      ++shown;
      const Json& row = *facts[i].row;
      rows += "<tr><td>" + Escaped(result.ArmName(record.arm)) + "</td>" +
              NumberCell(std::to_string(record.round)) + NumberCell(std::to_string(i + 1)) +
              NumberCell(std::to_string(facts[i].tubes_left)) + "<td>" +
              Escaped(FailureName(facts[i].failure)) + "</td><td>" + Shown(At(row, "/class")) +
              "</td><td>" + Shown(At(row, "/motion/name")) + "</td><td>" +
              Shown(At(row, "/outcome")) + "</td><td class=\"why\">" + Shown(At(row, "/reason")) +
              "</td></tr>\n";
    }
  }
  if (rows.empty()) return "";
  return "<details><summary>" + std::to_string(shown) + " of " + std::to_string(failed) +
         " failed attempts, from picks.jsonl</summary><div class=\"wide\"><table "
         "class=\"attempts\">"
         "<tr><th>arm</th><th class=\"n\">round</th><th class=\"n\">attempt</th><th "
         "class=\"n\">tubes left</th><th>failure</th><th>class</th><th>motion</th><th>believed</th>"
         "<th>reason</th></tr>\n" +
         rows + "</table></div></details>\n";
}

}  // namespace

std::string CampaignReportHtml(const CampaignResult& result, const Json& summary,
                               const Json& manifest, const std::vector<ShownAttempt>& attempts) {
  const std::string body =
      Headline(result, summary) + Section("arms", "Arms", ArmsTable(summary)) +
      "<div class=\"two\">" + Section("left", "Success by tubes left", TubesLeft(summary)) +
      Section("failures", "Failure classes", Failures(summary)) + "</div>\n" +
      Section("times", "Where the time goes", Times(summary, manifest)) +
      Section("view", "One attempt in 3-D", ViewerHtml(attempts)) +
      Section("gallery", "Failed attempts", GalleryHtml(attempts)) +
      Section("forces", "Load at the wrist", TracesHtml(attempts)) +
      Section("motions", "Motions", Motions(summary)) +
      Section("steps", "Simulation and separation", Steps(summary)) +
      Section("belief", "Belief against truth", Belief(summary)) +
      Section("rows", "Failed attempts, row by row", FailedRows(result)) +
      "<footer><p>Success is judged by the simulation's truth, which the picking pipeline never "
      "sees: exactly one new tube at rest on the tray, none outside. Intervals are Wilson's; those "
      "by rounds are a bootstrap over rounds. Rates and intervals are those of summary.json. "
      "Commands are to be run in the folder of this page.</p></footer>\n";
  Json content{{"schema", "tubetwin/report/1"},
               {"kind", "campaign"},
               {"summary", summary},
               {"times", TimesHistogram(result)}};
  content.update(AttemptData(attempts));
  return ReportPage("tubetwin: campaign", body, content);
}

}  // namespace tubetwin
