// The sections that tell of times, and of attempts row by row.

#include <algorithm>
#include <cmath>

#include "models/base/json.h"
#include "twin/report/chart.h"
#include "twin/report/parts.h"
#include "twin/report/sections.h"
#include "twin/round/records/attempt_facts.h"

namespace tubetwin {
namespace {

TimeParts PartsOf(const AttemptRecord& attempt) {
  if (!attempt.sim_s) return {};
  return {attempt.sim_s->scan, attempt.sim_s->move, attempt.sim_s->weigh, attempt.sim_s->settle};
}

std::string SpreadCells(const std::optional<Spread>& spread, const Pointer& at) {
  std::string out;
  constexpr std::pair<const char*, double Spread::*> kTold[] = {{"mean", &Spread::mean},
                                                                {"median", &Spread::median},
                                                                {"p5", &Spread::p5},
                                                                {"p95", &Spread::p95},
                                                                {"max", &Spread::max}};
  for (const auto& [name, value] : kTold) {
    out += NumberCell(spread ? FixedHtml((*spread).*value, at / name, 2) : kDash);
  }
  return out;
}

std::string TimeTable(const ReportInput& input) {
  std::string out =
      "<div class=\"wide\"><table><tr><th>seconds per attempt</th><th class=\"n\">mean</th>"
      "<th class=\"n\">median</th><th class=\"n\">5 %</th><th class=\"n\">95 %</th>"
      "<th class=\"n\">longest</th></tr>\n";
  for (std::size_t v = 0; v < input.summary.variants.size(); ++v) {
    const VariantSummary& variant = input.summary.variants[v];
    if (input.summary.variants.size() > 1) {
      out += "<tr class=\"group\"><th colspan=\"6\">" + Escaped(variant.name) + "</th></tr>\n";
    }
    for (const MetricValue& value : variant.metrics) {
      if (value.metric->place != Metric::Place::kTime) continue;
      out += "<tr><th>" + Escaped(value.metric->label) + "</th>" +
             SpreadCells(value.spread, VariantPointer(input, v) / value.metric->name) + "</tr>\n";
    }
    if (!input.computing_times) continue;
    for (const VariantTimes::Part& part : input.manifest.compute_s[v].parts) {
      out += "<tr><th>computing: " + part.name + "</th>" +
             SpreadCells(part.all, Pointer::Nowhere()) + "</tr>\n";
    }
  }
  return out + "</table></div>\n";
}

/// One bar for each attempt of a round.
std::string AttemptTimes(const RoundRecord& record) {
  std::vector<TimeBar> bars;
  for (const AttemptRecord& attempt : record.attempts) {
    bars.push_back({PartsOf(attempt), attempt.success});
  }
  std::vector<std::pair<std::string, std::string>> legend;
  for (std::size_t i = 0; i < kTimeParts.size(); ++i) {
    legend.emplace_back("part" + std::to_string(i), kTimeParts[i]);
  }
  return Figure(TimeChartSvg(bars),
                "Simulated seconds of each attempt; <span class=\"bad\">\xc3\x97</span> did "
                "not place exactly one tube. " +
                    Legend(legend));
}

/// The mean attempt of each variant, simulated and computing.
std::string MeanTimes(const ReportInput& input) {
  std::vector<BarRow> bars;
  for (std::size_t v = 0; v < input.summary.variants.size(); ++v) {
    BarRow bar{input.summary.variants[v].name, {}, ""};
    for (const char* part : kTimeParts) {
      for (const MetricValue& value : input.summary.variants[v].metrics) {
        if (value.metric->name != std::string("sim_s/attempt/") + part) continue;
        bar.segments.push_back(value.spread ? value.spread->mean : 0.0);
      }
    }
    for (const VariantTimes::Part& part : input.manifest.compute_s[v].parts) {
      if (part.name != "total") bar.segments.push_back(part.all ? part.all->mean : 0.0);
    }
    double sum = 0.0;
    for (const double segment : bar.segments) sum += segment;
    bar.told = Fixed(sum, 1) + " s";
    bars.push_back(std::move(bar));
  }
  const std::vector<std::string> classes = {"part0", "part1", "part2", "part3",
                                            "part4", "part4", "part4"};
  return Figure(BarsHtml(bars, classes, "Mean seconds of an attempt"),
                "Mean seconds of an attempt: simulated time of the cell plus computing time. " +
                    Legend({{"part0", "scan"},
                            {"part1", "move"},
                            {"part2", "weigh"},
                            {"part3", "settle"},
                            {"part4", "computing"}}));
}

/// Why this motion: said from what the row holds.
std::string WhyChosen(const AttemptRecord& attempt) {
  if (!attempt.chosen) return kDash;
  const std::string motion = Escaped(attempt.chosen->motion);
  if (attempt.used_simulator) {
    return motion + ": least displacement of the other tubes in simulation, then best grasp";
  }
  if (attempt.chosen->target_class == TubeClass::kFree) {
    return motion + ": nothing lies over it, no simulation needed";
  }
  return motion + ": best ranked without simulation";
}

std::string ResolutionText(const AttemptRecord& attempt) {
  if (!attempt.resolution_used) return kDash;
  return Shown(attempt.strategy) + ": " +
         (attempt.held_at_last ? ToString(*attempt.held_at_last) : kDash);
}

std::string TextCell(const std::string& html) { return "<td>" + html + "</td>"; }

/// Cells of an attempt that pages of rounds and of campaigns tell alike.
std::string AttemptCells(const AttemptFacts& facts) {
  const AttemptRecord& attempt = *facts.attempt;
  const std::string number =
      attempt.tubes_in_bin ? std::to_string(*attempt.tubes_in_bin) : std::string(kDash);
  const char* colour = !attempt.success ? "quiet" : *attempt.success ? "good" : "bad";
  const char* placed = !attempt.success ? kDash : *attempt.success ? "yes" : "no";
  return NumberCell(std::to_string(attempt.attempt)) +
         NumberCell(std::to_string(facts.tubes_left)) + NumberCell(number) +
         NumberCell(attempt.chosen ? std::to_string(attempt.chosen->target) : kDash) +
         TextCell(attempt.chosen ? ToString(attempt.chosen->target_class) : kDash) +
         "<td class=\"why\">" + WhyChosen(attempt) + "</td>" +
         TextCell(attempt.detection ? std::string(ToString(attempt.detection->outcome)) + ", " +
                                          Fixed(attempt.detection->force_N, 2) + "&nbsp;N"
                                    : kDash) +
         TextCell(ResolutionText(attempt)) + TextCell(ToString(attempt.outcome)) + "<td class=\"" +
         colour + "\">" + placed + "</td>" +
         TextCell(facts.failure.empty() ? kDash : Escaped(FailureName(facts.failure))) +
         NumberCell(attempt.sim_s ? Fixed(attempt.sim_s->total(), 1) : kDash) +
         "<td class=\"why\">" + Shown(attempt.reason) + "</td>";
}

}  // namespace

std::string Times(const ReportInput& input) {
  const std::string table =
      "<details><summary>The numbers</summary>" + TimeTable(input) + "</details>\n";
  if (input.is_round) return AttemptTimes(input.result.records.front()) + table;
  return "<div class=\"two\">" + MeanTimes(input) +
         "<figure class=\"chart-box\"><div class=\"chart-height\"><canvas id=\"times-chart\" "
         "role=\"img\" aria-label=\"Distribution of attempt times\"></canvas></div><figcaption>"
         "How long attempts took, simulated.</figcaption></figure></div>\n" +
         table;
}

Json TimesHistogram(const CampaignResult& result) {
  std::vector<std::vector<double>> all(static_cast<std::size_t>(result.variants()));
  double longest = 0.0;
  for (const RoundRecord& record : result.records) {
    for (const AttemptRecord& attempt : record.attempts) {
      if (!attempt.sim_s) continue;
      all[static_cast<std::size_t>(record.variant)].push_back(attempt.sim_s->total());
      longest = std::max(longest, attempt.sim_s->total());
    }
  }
  constexpr double kBins = 40.0;
  const double step = longest > 0.0 ? std::max(0.5, std::ceil(2.0 * longest / kBins) / 2.0) : 1.0;
  const auto bins = static_cast<std::size_t>(longest / step) + 1;
  Json out{{"step_s", step}, {"variants", Json::array()}};
  for (int variant = 0; variant < result.variants(); ++variant) {
    std::vector<int> counts(bins, 0);
    for (const double s : all[static_cast<std::size_t>(variant)]) {
      ++counts[std::min(bins - 1, static_cast<std::size_t>(s / step))];
    }
    out["variants"].push_back(Json{{"name", result.VariantName(variant)}, {"counts", counts}});
  }
  return out;
}

std::string AttemptsTable(const ReportInput& input) {
  constexpr int kMaxRows = 200;
  const bool whole = input.is_round;
  std::string rows;
  int shown = 0, told = 0;
  for (const RoundRecord& record : input.result.records) {
    const std::vector<AttemptFacts> attempts = FactsOf(record).attempts;
    for (std::size_t i = 0; i < attempts.size(); ++i) {
      if (!whole && attempts[i].failure.empty()) continue;
      if (++told > kMaxRows && !whole) continue;
      ++shown;
      rows += "<tr>" +
              (whole ? ""
                     : TextCell(Escaped(input.result.VariantName(record.variant))) +
                           NumberCell(std::to_string(record.round))) +
              NumberCell(std::to_string(i + 1)) + AttemptCells(attempts[i]) + "</tr>\n";
    }
  }
  if (rows.empty()) return "";
  const std::string table =
      "<div class=\"wide\"><table class=\"attempts\"><tr>" +
      std::string(whole ? "" : "<th>variant</th><th class=\"n\">round</th>") +
      "<th class=\"n\">#</th><th class=\"n\">try</th><th class=\"n\">left</th><th class=\"n\">seen "
      "in bin</th><th class=\"n\">tube</th><th>class</th><th>motion, and why</th><th>weighed</th>"
      "<th>separation</th><th>believed</th><th>placed one</th><th>failure</th><th "
      "class=\"n\">time, "
      "s</th><th>reason</th></tr>\n" +
      rows + "</table></div>\n";
  if (whole) return table;
  return "<details><summary>" + std::to_string(shown) + " of " + std::to_string(told) +
         " failed attempts, from picks.jsonl</summary>" + table + "</details>\n";
}

}  // namespace tubetwin
