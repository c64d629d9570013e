// How comparisons stand in files and on the terminal.

#include <cmath>
#include <cstdio>

#include "models/base/json.h"
#include "twin/study/compare.h"

namespace tubetwin {
namespace {

Json Finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json QuestionJson(const QuestionResult& test) {
  return Json{{"question", test.question}, {"a", ToJson(test.a())}, {"b", ToJson(test.b())},
              {"both", test.both},         {"only_a", test.only_a}, {"only_b", test.only_b},
              {"neither", test.neither},   {"p", test.p},           {"p_holm", test.p_holm}};
}

Json DifferenceJson(const Difference& difference) {
  const Interval& interval = difference.bootstrap95;
  return Json{{"b_minus_a", Finite(difference.b_minus_a)},
              {"bootstrap95", Json::array({Finite(interval.low), Finite(interval.high)})}};
}

bool IsRate(const MetricDifference& row) { return row.a.metric->kind == Metric::Kind::kRate; }

Json MetricDifferenceJson(const MetricDifference& row) {
  Json out = DifferenceJson(row.difference);
  out["a"] = IsRate(row) ? ToJson(row.a.rate) : ToJson(row.a.spread);
  out["b"] = IsRate(row) ? ToJson(row.b.rate) : ToJson(row.b.spread);
  return out;
}

std::string Percent(Counts counts) {
  char text[64];
  std::snprintf(text, sizeof text, "%d/%d = %.1f %%", counts.k, counts.n,
                counts.n > 0 ? 100.0 * counts.k / counts.n : 0.0);
  return text;
}

std::string ValueText(const MetricValue& value) {
  const Metric& metric = *value.metric;
  if (metric.kind == Metric::Kind::kRate) return Percent(value.rate.counts);
  if (!value.spread) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.2f %s",
                metric.kind == Metric::Kind::kMean ? value.spread->mean : value.spread->median,
                metric.unit.c_str());
  return text;
}

std::string DifferenceText(const Difference& difference, double scale, const std::string& unit) {
  const Interval& interval = difference.bootstrap95;
  if (!std::isfinite(difference.b_minus_a) || !std::isfinite(interval.low)) return "not known";
  char text[96];
  std::snprintf(text, sizeof text, "%+.1f %s [%+.1f, %+.1f]", scale * difference.b_minus_a,
                unit.c_str(), scale * interval.low, scale * interval.high);
  return text;
}

}  // namespace

Json ToJson(const Comparison& comparison) {
  Json out{{"schema", "tubetwin/comparison/1"}, {"pairs", Json::array()}};
  std::size_t tests = 0;
  for (const PairComparison& pair : comparison.pairs) {
    Json row{{"a", pair.a},
             {"b", pair.b},
             {"pairs", pair.pairs},
             {"unpaired_a", pair.unpaired_a},
             {"unpaired_b", pair.unpaired_b},
             {"tests", Json::array()}};
    for (const QuestionResult& test : pair.questions) row["tests"].push_back(QuestionJson(test));
    for (const MetricDifference& metric : pair.metrics) {
      row[metric.a.metric->compared] = MetricDifferenceJson(metric);
    }
    row["sim_s_per_placed_tube"] = DifferenceJson(pair.sim_s_per_placed_tube);
    out["pairs"].push_back(std::move(row));
    tests += pair.questions.size();
  }
  out["tests"] = tests;
  return out;
}

std::string CompareText(const Comparison& comparison) {
  std::string out;
  for (const PairComparison& pair : comparison.pairs) {
    out += "A = " + pair.a + "\nB = " + pair.b + "\n" + std::to_string(pair.pairs) +
           " pairs of rounds with the same seed";
    const int left = pair.unpaired_a + pair.unpaired_b;
    if (left > 0) out += ", " + std::to_string(left) + " rounds without a partner left out";
    out += "\n";
    for (const QuestionResult& test : pair.questions) {
      char text[256];
      std::snprintf(text, sizeof text,
                    "  %-11s A %-18s B %-18s only A %d, only B %d, McNemar p = %.4g, Holm %.4g\n",
                    test.question.c_str(), Percent(test.a()).c_str(), Percent(test.b()).c_str(),
                    test.only_a, test.only_b, test.p, test.p_holm);
      out += text;
    }
    for (const MetricDifference& row : pair.metrics) {
      const bool rate = IsRate(row);
      char text[256];
      std::snprintf(
          text, sizeof text, "  %-21s A %-20s B %-20s B - A %s\n", row.a.metric->compared.c_str(),
          ValueText(row.a).c_str(), ValueText(row.b).c_str(),
          DifferenceText(row.difference, rate ? 100.0 : 1.0, rate ? "points" : row.a.metric->unit)
              .c_str());
      out += text;
    }
    out += "  simulated time per placed tube: B - A " +
           DifferenceText(pair.sim_s_per_placed_tube, 1.0, "s") + "\n";
  }
  return out;
}

}  // namespace tubetwin
