// How summaries of campaigns stand in files and on the terminal.

#include <cstdio>

#include "models/base/error.h"
#include "models/base/json.h"
#include "twin/campaign/campaign_summary.h"

namespace tubetwin {
namespace {

void AddTotals(const CampaignTotals& totals, Json& out) {
  out["rounds"] = totals.rounds;
  out["crashed"] = totals.crashed;
  out["tubes_start"] = totals.tubes_start;
  out["placed"] = totals.placed;
  out["attempts"] = totals.attempts;
  out["several_placed"] = totals.several_placed;
  out["outside"] = totals.outside;
  out["dropped"] = totals.dropped;
}

void AddMetrics(const std::vector<MetricValue>& values, Metric::Place place, Json& out) {
  for (const MetricValue& value : values) {
    if (value.metric->place == place) AddValue(value, out);
  }
}

Json FrequenciesJson(const Frequencies& frequencies) {
  Json out = Json::object();
  for (const auto& [name, count] : frequencies) out[name] = count;
  return out;
}

Json VariantSummaryJson(const VariantSummary& variant) {
  Json out;
  out["variant"] = variant.variant;
  out["name"] = variant.name;
  AddTotals(variant.totals, out);
  out["parts_per_hour"] = ToJson(variant.parts_per_hour);
  AddMetrics(variant.metrics, Metric::Place::kHeadline, out);
  out["by_tubes_left"] = Json::array();
  for (const TubesLeftSummary& row : variant.by_tubes_left) {
    out["by_tubes_left"].push_back(Json{{"tubes_left", row.tubes_left},
                                        {"success", ToJson(row.success)},
                                        {"first_attempt", ToJson(row.first_attempt)}});
  }
  out["by_motion"] = Json::array();
  for (const MotionSummary& row : variant.by_motion) {
    out["by_motion"].push_back(Json{{"motion", row.motion},
                                    {"success", ToJson(row.success)},
                                    {"used_simulator", row.used_simulator},
                                    {"move_s", ToJson(row.move_s)}});
  }
  out["failures"] = FrequenciesJson(variant.failures);
  out["end_reasons"] = FrequenciesJson(variant.end_reasons);
  AddMetrics(variant.metrics, Metric::Place::kStep, out);
  out["belief"] = Json::object();
  for (const BeliefSummary& row : variant.belief) {
    out["belief"][row.outcome] = Json{{"attempts", row.attempts}, {"success", row.success}};
  }
  AddMetrics(variant.metrics, Metric::Place::kTime, out);
  AddMetrics(variant.metrics, Metric::Place::kMeasure, out);
  return out;
}

std::string RateText(const Rate& rate) {
  const auto [k, n] = rate.counts;
  const ShareInterval interval = Interval95(rate);
  char text[96];
  std::snprintf(text, sizeof text, "%5d/%-5d %5.1f %% [%5.1f, %5.1f]%s", k, n,
                n > 0 ? 100.0 * k / n : 0.0, 100.0 * interval.low, 100.0 * interval.high,
                rate.by_cluster ? " by rounds" : "");
  return text;
}

std::string SpreadText(const std::optional<Spread>& spread) {
  if (!spread) return "-";
  char text[96];
  std::snprintf(text, sizeof text, "median %.2f s, 5 to 95 %%: %.2f to %.2f s, n %d",
                spread->median, spread->p5, spread->p95, spread->n);
  return text;
}

const MetricValue& Named(const std::vector<MetricValue>& values, const std::string& name) {
  for (const MetricValue& value : values) {
    if (value.metric->name == name) return value;
  }
  throw LogicError("no metric is called '" + name + "'");
}

}  // namespace

Json ToJson(const CampaignSummary& summary) {
  Json out;
  out["schema"] = "tubetwin/campaign_summary/2";
  out["seed"] = summary.seed;
  AddTotals(summary.totals, out);
  // Several variants are compared, not mixed: each has its own.
  if (summary.variants.size() == 1) {
    out["parts_per_hour"] = ToJson(summary.variants.front().parts_per_hour);
  }
  AddMetrics(summary.metrics, Metric::Place::kHeadline, out);
  out["variants"] = Json::array();
  for (const VariantSummary& variant : summary.variants)
    out["variants"].push_back(VariantSummaryJson(variant));
  return out;
}

Json ToJson(const CampaignManifest& manifest) {
  Json out;
  out["schema"] = "tubetwin/campaign_manifest/2";
  out["program"] = manifest.program;
  out["mujoco"] = manifest.mujoco;
  out["fingerprint"] = manifest.fingerprint;
  out["purpose"] = manifest.purpose.empty() ? Json(nullptr) : Json(manifest.purpose);
  out["compute_s"] = Json::array();
  for (const VariantTimes& times : manifest.compute_s) {
    Json row{{"variant", times.variant}, {"name", times.name}};
    row["parts_per_hour"] = ToJson(times.parts_per_hour);
    for (const auto& [factor, rate] : times.with_more_rounds) {
      row["parts_per_hour"]["with_more_rounds"][std::to_string(factor) + "x"] =
          rate.interval ? Json::array({rate.interval->low, rate.interval->high}) : Json(nullptr);
    }
    for (const VariantTimes::Part& part : times.parts) {
      row[part.name] = Json{{"all", ToJson(part.all)},
                            {"without_simulator", ToJson(part.without_simulator)},
                            {"with_simulator", ToJson(part.with_simulator)}};
    }
    out["compute_s"].push_back(std::move(row));
  }
  return out;
}

std::string SummaryText(const CampaignSummary& summary, const CampaignManifest& manifest) {
  std::string out;
  for (std::size_t i = 0; i < summary.variants.size(); ++i) {
    const VariantSummary& variant = summary.variants[i];
    out += "variant " + std::to_string(i) + "  " + variant.name + ", " +
           std::to_string(variant.totals.rounds) + " rounds\n";
    out += "  parts per hour    " + ToText(manifest.compute_s[i].parts_per_hour) +
           "; without computing " + ToText(variant.parts_per_hour) + "\n";
    out += "  success           " + RateText(Named(variant.metrics, "success").rate) + "\n";
    out += "  in tolerance      " + RateText(Named(variant.metrics, "in_tolerance").rate) + "\n";
    out += "  at first attempt  " + RateText(Named(variant.metrics, "first_attempt").rate) + "\n";
    out += "  of all at start   " +
           RateText(Named(variant.metrics, "first_attempt_of_start").rate) + "\n";
    out += "  bins emptied      " + RateText(Named(variant.metrics, "emptied").rate) + "\n";
    for (const TubesLeftSummary& row : variant.by_tubes_left) {
      char head[32];
      std::snprintf(head, sizeof head, "  %2d tubes left     ", row.tubes_left);
      out += head + RateText(row.success) + "\n";
    }
    for (const auto& [name, count] : variant.failures) {
      out += "  failure " + name + ": " + std::to_string(count) + "\n";
    }
    out += "  simulated time of an attempt: " +
           SpreadText(Named(variant.metrics, "sim_s/attempt/total").spread) + "\n";
    out += "  computing time of an attempt: " + SpreadText(manifest.compute_s[i].parts.back().all) +
           "\n";
  }
  return out;
}

}  // namespace tubetwin
