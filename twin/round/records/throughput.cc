#include "twin/round/records/throughput.h"

#include <cstdio>

#include "models/base/json.h"

namespace tubetwin {
namespace {

constexpr double kHour_s = 3600.0;

double CellAndComputing_s(const RoundWork& work) { return work.cell_s + work.compute_s; }

}  // namespace

const char* DefinitionOf(HourOf hour) {
  if (hour == HourOf::kCell) {
    return "placed parts over the simulated time of whole rounds, looks, failures and waits "
           "included, computing time not";
  }
  return "placed parts over simulated plus computing time of whole rounds, looks, failures and "
         "waits included";
}

std::optional<RoundWork> WorkOf(const RoundFacts& round, HourOf hour) {
  const RoundRecord& record = *round.record;
  if (record.summary.crashed() || !record.summary.sim_s) return std::nullopt;
  RoundWork work;
  work.placed = record.summary.placed - record.summary.placed_before;
  work.cell_s = *record.summary.sim_s;
  if (hour == HourOf::kCell) return work;
  if (record.timings.size() < record.attempts.size()) return std::nullopt;
  for (const AttemptTiming& timing : record.timings) {
    if (!timing.compute_s) return std::nullopt;
    work.compute_s += timing.compute_s->total;
  }
  return work;
}

PartsPerHour PartsPerHourOf(const std::vector<RoundFacts>& rounds, HourOf hour,
                            const std::optional<RandomStream>& random, int times) {
  PartsPerHour out;
  out.hour = hour;
  std::vector<RatioPart> parts;
  for (const RoundFacts& round : rounds) {
    const std::optional<RoundWork> work = WorkOf(round, hour);
    if (!work) {
      ++out.left_out;
      continue;
    }
    ++out.rounds;
    out.placed += work->placed;
    out.time_s += CellAndComputing_s(*work);
    parts.push_back({kHour_s * work->placed, CellAndComputing_s(*work)});
  }
  if (out.time_s > 0.0) out.value = kHour_s * out.placed / out.time_s;
  if (out.value && random && out.rounds > 1) {
    out.interval = RatioBootstrap95(parts, *random, times * out.rounds);
  }
  return out;
}

std::string ToText(double parts_per_hour) {
  char text[32];
  std::snprintf(text, sizeof text, parts_per_hour < 9.95 ? "%.1f" : "%.0f", parts_per_hour);
  return text;
}

std::string ToText(const PartsPerHour& rate) {
  if (!rate.value) return "-";
  const std::string value = ToText(*rate.value);
  if (rate.rounds == 1) return value + " (one round: no interval)";
  if (!rate.interval) return value;
  return value + " [" + ToText(rate.interval->low) + ", " + ToText(rate.interval->high) + "]";
}

Json ToJson(const PartsPerHour& rate) {
  const auto bound = [&](double Interval::*side) {
    return rate.interval ? Json(*rate.interval.*side) : Json(nullptr);
  };
  return Json{{"value", rate.value ? Json(*rate.value) : Json(nullptr)},
              {"low", bound(&Interval::low)},
              {"high", bound(&Interval::high)},
              {"definition", DefinitionOf(rate.hour)},
              {"rounds", rate.rounds},
              {"left_out", rate.left_out}};
}

}  // namespace tubetwin
