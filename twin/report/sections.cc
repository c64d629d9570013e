#include "twin/report/sections.h"

#include <algorithm>
#include <cmath>

#include "models/base/json.h"
#include "twin/report/chart.h"
#include "twin/report/parts.h"

namespace tubetwin {
namespace {

constexpr std::size_t kVariantsInOneChart = 6;  // As many colours as there are.

/// The heading of a variant's part of a section; nothing where there is only one.
std::string Subheading(const ReportInput& input, const VariantSummary& variant) {
  return input.summary.variants.size() > 1 ? "<h3>" + Escaped(variant.name) + "</h3>" : "";
}

/// The same as a row of a table.
std::string GroupRow(const ReportInput& input, const VariantSummary& variant, int columns) {
  if (input.summary.variants.size() < 2) return "";
  return "<tr class=\"group\"><th colspan=\"" + std::to_string(columns) + "\">" +
         Escaped(variant.name) + "</th></tr>\n";
}

IntervalSeries TubesLeftSeries(const VariantSummary& variant) {
  IntervalSeries series;
  series.name = variant.name;
  for (const TubesLeftSummary& row : variant.by_tubes_left) {
    const auto [k, n] = row.success.counts;
    const ShareInterval interval = Interval95(row.success);
    const double share = static_cast<double>(k) / n;
    series.points.push_back({row.tubes_left, share, interval.low, interval.high,
                             series.name + ", " + std::to_string(row.tubes_left) +
                                 " left: " + std::to_string(k) + " of " + std::to_string(n) +
                                 ", 95 % " + Fixed(100.0 * interval.low, 1) + " to " +
                                 Fixed(100.0 * interval.high, 1) + " %"});
  }
  return series;
}

std::string TubesLeftTable(const VariantSummary& variant, const Pointer& at) {
  std::string out =
      "<div class=\"wide\"><table><tr><th class=\"n\">tubes left</th><th>success</th><th>of the "
      "placed, at the first attempt</th></tr>\n";
  for (std::size_t i = 0; i < variant.by_tubes_left.size(); ++i) {
    const TubesLeftSummary& row = variant.by_tubes_left[i];
    const Pointer here = at / "by_tubes_left" / i;
    out += "<tr>" + NumberCell(CountHtml(row.tubes_left, here / "tubes_left")) + "<td>" +
           RateHtml(row.success, here / "success") + "</td><td>" +
           RateHtml(row.first_attempt, here / "first_attempt") + "</td></tr>\n";
  }
  return out + "</table></div>\n";
}

std::string MeasureCell(const MetricValue& value, const Pointer& at) {
  const Metric& metric = *value.metric;
  if (metric.kind == Metric::Kind::kRate) {
    return "<td class=\"rate\">" + RateMark(value.rate) + " " + RateHtml(value.rate, at) + "</td>";
  }
  if (!value.spread) return NumberCell(kDash);
  const bool is_mean = metric.kind == Metric::Kind::kMean;
  return "<td>" + std::string(is_mean ? "mean " : "median ") +
         FixedHtml(is_mean ? value.spread->mean : value.spread->median,
                   at / (is_mean ? "mean" : "median"), 2) +
         " " + Escaped(metric.unit) +
         " <span class=\"quiet\">5 to 95&nbsp;%: " + FixedHtml(value.spread->p5, at / "p5", 2) +
         " to " + FixedHtml(value.spread->p95, at / "p95", 2) + ", n " +
         CountHtml(value.spread->n, at / "n") + "</span></td>";
}

}  // namespace

Pointer VariantPointer(const ReportInput& input, std::size_t variant) {
  return input.is_round ? Pointer::Nowhere() : Pointer() / "variants" / variant;
}

std::string VariantsTable(const ReportInput& input) {
  if (input.summary.variants.size() < 2) return "";
  std::string head, rows;
  for (const MetricValue& value : input.summary.metrics) {
    if (value.metric->place == Metric::Place::kHeadline) {
      head += "<th>" + Escaped(value.metric->label) + "</th>";
    }
  }
  for (std::size_t i = 0; i < input.summary.variants.size(); ++i) {
    const VariantSummary& variant = input.summary.variants[i];
    const Pointer at = VariantPointer(input, i);
    rows += "<tr><th>" + Escaped(variant.name) + "</th>" +
            NumberCell(CountHtml(variant.totals.rounds, at / "rounds"));
    for (const MetricValue& value : variant.metrics) {
      if (value.metric->place != Metric::Place::kHeadline) continue;
      rows += MeasureCell(value, at / value.metric->name);
    }
    rows += NumberCell(CountHtml(variant.totals.outside, at / "outside")) +
            NumberCell(CountHtml(variant.totals.several_placed, at / "several_placed")) +
            NumberCell(CountHtml(variant.totals.dropped, at / "dropped")) + "</tr>\n";
  }
  return "<div class=\"wide\"><table class=\"variants\"><tr><th>variant</th><th class=\"n\">bins"
         "</th>" +
         head +
         "<th class=\"n\">outside</th><th class=\"n\">several</th><th class=\"n\">dropped</th>"
         "</tr>\n" +
         rows + "</table></div>\n";
}

std::string TubesLeft(const ReportInput& input) {
  const std::vector<VariantSummary>& variants = input.summary.variants;
  std::vector<IntervalSeries> series;
  std::vector<std::pair<std::string, std::string>> legend;
  std::string charts, tables;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    series.push_back(TubesLeftSeries(variants[i]));
    legend.emplace_back("variant" + std::to_string(series.size() - 1), variants[i].name);
    tables +=
        Subheading(input, variants[i]) + TubesLeftTable(variants[i], VariantPointer(input, i));
    if (series.size() < kVariantsInOneChart && i + 1 < variants.size()) continue;
    charts += Figure(IntervalChartSvg(series, "tubes left in the bin"),
                     "Attempts that placed exactly one tube, with 95&nbsp;% intervals. " +
                         (variants.size() > 1 ? Legend(legend) : ""));
    series.clear();
    legend.clear();
  }
  return charts + "<details><summary>The numbers</summary>" + tables + "</details>\n";
}

std::string Motions(const ReportInput& input) {
  std::string rows;
  for (std::size_t v = 0; v < input.summary.variants.size(); ++v) {
    const VariantSummary& variant = input.summary.variants[v];
    rows += GroupRow(input, variant, 5);
    for (std::size_t i = 0; i < variant.by_motion.size(); ++i) {
      const MotionSummary& row = variant.by_motion[i];
      const Pointer at = VariantPointer(input, v) / "by_motion" / i;
      const auto median =
          row.move_s ? std::optional<double>(row.move_s->median) : std::optional<double>();
      rows += "<tr><th>" + Escaped(row.motion) + "</th>" +
              NumberCell(CountHtml(row.success.counts.n, at / "success" / "n")) + "<td>" +
              RateHtml(row.success, at / "success") + "</td>" +
              NumberCell(CountHtml(row.used_simulator, at / "used_simulator")) +
              NumberCell(FixedHtml(median, at / "move_s" / "median", 1)) + "</tr>\n";
    }
  }
  if (rows.empty()) return "";
  return "<div class=\"wide\"><table><tr><th>motion</th><th class=\"n\">attempts</th>"
         "<th>success</th><th class=\"n\">simulated first</th><th class=\"n\">median movement, "
         "s</th></tr>\n" +
         rows + "</table></div>\n";
}

std::string Measures(const ReportInput& input) {
  const std::vector<VariantSummary>& variants = input.summary.variants;
  std::string out = "<div class=\"wide\"><table><tr><th></th>";
  for (const VariantSummary& variant : variants) {
    out += "<th>" + (variants.size() > 1 ? Escaped(variant.name) : "") + "</th>";
  }
  out += "</tr>\n";
  for (std::size_t i = 0; i < input.summary.metrics.size(); ++i) {
    const Metric& metric = *input.summary.metrics[i].metric;
    if (metric.place != Metric::Place::kStep && metric.place != Metric::Place::kMeasure) continue;
    out += "<tr><th>" + Escaped(metric.label) + "</th>";
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const bool in_round_file = input.is_round && metric.place == Metric::Place::kMeasure;
      const Pointer at = in_round_file ? Pointer() : VariantPointer(input, v);
      out += MeasureCell(variants[v].metrics[i], at / metric.name);
    }
    out += "</tr>\n";
  }
  return out + "</table></div>\n";
}

std::string Belief(const ReportInput& input) {
  std::string out;
  for (std::size_t v = 0; v < input.summary.variants.size(); ++v) {
    const VariantSummary& variant = input.summary.variants[v];
    if (variant.belief.empty()) continue;
    const bool unknown = std::any_of(variant.belief.begin(), variant.belief.end(),
                                     [](const BeliefSummary& row) { return row.unknown > 0; });
    out += Subheading(input, variant) +
           "<div class=\"wide\"><table><tr><th>the pipeline believed</th><th class=\"n\">truly "
           "placed</th><th class=\"n\">not placed</th>" +
           (unknown ? "<th class=\"n\">unknown</th>" : "") + "</tr>\n";
    for (const BeliefSummary& row : variant.belief) {
      const Pointer at = VariantPointer(input, v) / "belief" / row.outcome;
      out += "<tr><th>" + Escaped(FailureName(row.outcome)) + "</th>" +
             NumberCell(CountHtml(row.success, at / "success")) +
             NumberCell(std::to_string(row.attempts - row.success - row.unknown)) +
             (unknown ? NumberCell(std::to_string(row.unknown)) : "") + "</tr>\n";
    }
    out += "</table></div>\n";
  }
  return out;
}

}  // namespace tubetwin
