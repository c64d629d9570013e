#include "twin/statistics/rate.h"

#include "models/base/json.h"
#include "models/base/json_text.h"

namespace tubetwin {
namespace {

Json IntervalJson(const ShareInterval& interval) {
  return Json::array({interval.low, interval.high});
}

}  // namespace

Rate RateOf(const std::vector<Counts>& clusters, Trials trials) {
  Rate rate{Total(clusters), std::nullopt};
  if (trials == Trials::kClustered && clusters.size() > 1) {
    rate.by_cluster = ClusterWilson95(clusters);
  }
  return rate;
}

ShareInterval Interval95(const Rate& rate) {
  return rate.by_cluster ? *rate.by_cluster : Wilson95(rate.counts.k, rate.counts.n);
}

Json ToJson(Counts counts) {
  return Json{
      {"k", counts.k}, {"n", counts.n}, {"wilson95", IntervalJson(Wilson95(counts.k, counts.n))}};
}

Json ToJson(const Rate& rate) {
  Json out = ToJson(rate.counts);
  if (rate.by_cluster) out["cluster95"] = IntervalJson(*rate.by_cluster);
  return out;
}

Counts CountsFromJson(const JsonView& view) {
  const Counts counts{CountFromJson(view.Field("k")), CountFromJson(view.Field("n"))};
  if (counts.k < 0 || counts.k > counts.n) view.Fail("k must lie between 0 and n");
  return counts;
}

std::optional<Spread> OptionalSpread(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return SpreadOf(values);
}

Json ToJson(const std::optional<Spread>& spread) {
  if (!spread) return nullptr;
  return Json{{"n", spread->n},    {"mean", spread->mean},     {"sd", spread->sd},
              {"p5", spread->p5},  {"median", spread->median}, {"p95", spread->p95},
              {"max", spread->max}};
}

}  // namespace tubetwin
