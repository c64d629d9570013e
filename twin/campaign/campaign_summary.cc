#include "twin/campaign/campaign_summary.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include "models/base/files.h"
#include "models/base/json.h"
#include "twin/round/attempt_facts.h"

namespace tubetwin {
namespace {

using Records = std::vector<const RoundRecord*>;
using FactTest = std::function<bool(const AttemptFacts&)>;

/// Counts per round: attempts that pass `counted`, of them those that pass `good`.
std::vector<Counts> ByRound(const std::vector<std::vector<AttemptFacts>>& rounds,
                            const FactTest& counted, const FactTest& good) {
  std::vector<Counts> out;
  for (const auto& round : rounds) {
    Counts counts;
    for (const AttemptFacts& facts : round) {
      if (!counted(facts)) continue;
      ++counts.n;
      counts.k += good(facts) ? 1 : 0;
    }
    out.push_back(counts);
  }
  return out;
}

bool Any(const AttemptFacts&) { return true; }
bool Success(const AttemptFacts& facts) { return facts.success; }
bool First(const AttemptFacts& facts) { return facts.first; }
bool UsedSimulator(const AttemptFacts& facts) { return (*facts.row)["used_simulator"] == true; }
bool UsedResolution(const AttemptFacts& facts) {
  return (*facts.row)["resolution"]["used"] == true;
}

/// Table of keys with their counts, most frequent first, then by name.
Json Ranked(const std::map<std::string, int>& counts) {
  std::vector<std::pair<std::string, int>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  Json out = Json::object();
  for (const auto& [key, count] : sorted) out[key] = count;
  return out;
}

/// Success by tubes left, most tubes first, as the paper's Table 4.
Json ByTubesLeft(const std::vector<std::vector<AttemptFacts>>& rounds, const RandomStream& random) {
  std::map<int, bool, std::greater<>> lefts;
  for (const auto& round : rounds) {
    for (const AttemptFacts& facts : round) lefts[facts.tubes_left] = true;
  }
  Json out = Json::array();
  for (const auto& [left, seen] : lefts) {
    const auto here = [left = left](const AttemptFacts& f) { return f.tubes_left == left; };
    Json row;
    row["tubes_left"] = left;
    row["success"] =
        RateJson(ByRound(rounds, here, Success), random.Fork("left", static_cast<unsigned>(left)));
    row["first_attempt"] = RateJson(Total(ByRound(
        rounds, [&](const AttemptFacts& f) { return here(f) && f.success; }, First)));
    out.push_back(std::move(row));
  }
  return out;
}

std::string MotionOf(const AttemptFacts& facts) {
  const Json& row = *facts.row;
  if (!row.contains("motion") || !row["motion"].is_object()) return "none";
  return row["motion"]["name"];
}

/// Success by motion, most used first; "none" where there was no plan.
Json ByMotion(const std::vector<std::vector<AttemptFacts>>& rounds, const RandomStream& random) {
  std::map<std::string, int> uses;
  for (const auto& round : rounds) {
    for (const AttemptFacts& facts : round) ++uses[MotionOf(facts)];
  }
  Json out = Json::array();
  const Json ranked = Ranked(uses);
  for (const auto& [motion, count] : ranked.items()) {
    const auto chosen = [&name = motion](const AttemptFacts& f) { return MotionOf(f) == name; };
    std::vector<double> move_s;
    for (const auto& round : rounds) {
      for (const AttemptFacts& facts : round) {
        const Json& times = (*facts.row)["sim_s"];
        if (chosen(facts) && times.is_object()) move_s.push_back(times["move"]);
      }
    }
    Json row;
    row["motion"] = motion;
    row["success"] = RateJson(ByRound(rounds, chosen, Success), random.Fork("motion", out.size()));
    row["used_simulator"] = Total(ByRound(rounds, chosen, UsedSimulator)).k;
    row["move_s"] = SpreadJson(move_s);
    out.push_back(std::move(row));
  }
  return out;
}

/// What the pipeline believed against truth, attempts that ran to an end.
Json BeliefTable(const std::vector<std::vector<AttemptFacts>>& rounds) {
  std::map<std::string, Counts> table;
  for (const auto& round : rounds) {
    for (const AttemptFacts& facts : round) {
      Counts& counts = table[(*facts.row)["outcome"].get<std::string>()];
      ++counts.n;
      counts.k += facts.success ? 1 : 0;
    }
  }
  Json out = Json::object();
  for (const auto& [outcome, counts] : table) {
    out[outcome] = Json{{"attempts", counts.n}, {"success", counts.k}};
  }
  return out;
}

Json SimTimes(const Records& records, const std::vector<std::vector<AttemptFacts>>& rounds) {
  std::map<std::string, std::vector<double>> parts;
  std::vector<double> per_round, per_placed;
  for (const auto& round : rounds) {
    for (const AttemptFacts& facts : round) {
      const Json& times = (*facts.row)["sim_s"];
      if (!times.is_object()) continue;
      for (const auto& [part, value] : times.items()) parts[part].push_back(value);
    }
  }
  for (const RoundRecord* record : records) {
    const Json& total = record->summary["sim_s"];
    if (!total.is_number()) continue;
    per_round.push_back(total);
    const int placed = record->summary["placed"];
    if (placed > 0) per_placed.push_back(per_round.back() / placed);
  }
  Json out;
  out["attempt"] = Json::object();
  for (const char* part : {"scan", "move", "weigh", "settle", "total"}) {
    out["attempt"][part] = SpreadJson(parts[part]);
  }
  out["round"] = SpreadJson(per_round);
  out["placed_tube"] = SpreadJson(per_placed);
  return out;
}

void AddTotals(const Records& records, const std::vector<std::vector<AttemptFacts>>& rounds,
               Json& out) {
  int crashed = 0, start = 0, placed = 0, outside = 0, dropped = 0, attempts = 0;
  for (const RoundRecord* record : records) {
    crashed += IsFaultSummary(record->summary) ? 1 : 0;
    start += record->summary["tubes_start"].get<int>();
    placed += record->summary["placed"].get<int>();
    outside += record->summary["outside"].get<int>();
    dropped += record->summary["dropped"].get<int>();
    attempts += static_cast<int>(record->picks.size());
  }
  int several = 0;
  for (const auto& round : rounds) {
    for (const AttemptFacts& facts : round) several += facts.placed > 1 ? 1 : 0;
  }
  out["rounds"] = records.size();
  out["crashed"] = crashed;
  out["tubes_start"] = start;
  out["placed"] = placed;
  out["attempts"] = attempts;
  out["several_placed"] = several;
  out["outside"] = outside;
  out["dropped"] = dropped;
}

std::vector<std::vector<AttemptFacts>> Facts(const Records& records) {
  std::vector<std::vector<AttemptFacts>> out;
  for (const RoundRecord* record : records) out.push_back(FactsOf(*record));
  return out;
}

Counts Emptied(const Records& records) {
  Counts out;
  for (const RoundRecord* record : records) {
    ++out.n;
    out.k += record->summary["emptied"] == true ? 1 : 0;
  }
  return out;
}

Json ArmSummary(const CampaignResult& result, int arm, const RandomStream& random) {
  const Records records = result.OfArm(arm);
  const auto rounds = Facts(records);
  Json out;
  out["arm"] = arm;
  out["name"] = result.ArmName(arm);
  AddTotals(records, rounds, out);
  out["success"] = RateJson(ByRound(rounds, Any, Success), random.Fork("success"));
  out["first_attempt"] = RateJson(ByRound(rounds, Success, First), random.Fork("first"));
  out["emptied"] = RateJson(Emptied(records));
  out["by_tubes_left"] = ByTubesLeft(rounds, random);
  out["by_motion"] = ByMotion(rounds, random);
  std::map<std::string, int> failures, ends;
  for (const auto& round : rounds) {
    for (const AttemptFacts& facts : round) {
      if (!facts.success) ++failures[facts.failure];
    }
  }
  for (const RoundRecord* record : records) {
    ++ends[record->summary["end_reason"].get<std::string>()];
  }
  out["failures"] = Ranked(failures);
  out["end_reasons"] = Ranked(ends);
  out["simulator"] = Json{
      {"used", RateJson(ByRound(rounds, Any, UsedSimulator), random.Fork("simulator_used"))},
      {"success", RateJson(ByRound(rounds, UsedSimulator, Success), random.Fork("simulator"))}};
  out["resolution"] = Json{
      {"used", RateJson(ByRound(rounds, Any, UsedResolution), random.Fork("resolution_used"))},
      {"success", RateJson(ByRound(rounds, UsedResolution, Success), random.Fork("resolution"))}};
  out["belief"] = BeliefTable(rounds);
  out["sim_s"] = SimTimes(records, rounds);
  return out;
}

/// Computing times of one arm, seconds of wall clock.
Json ComputeTimes(const CampaignResult& result, int arm) {
  std::map<std::string, std::vector<double>> all, with, without;
  for (const RoundRecord* record : result.OfArm(arm)) {
    for (std::size_t i = 0; i < record->timings.size() && i < record->picks.size(); ++i) {
      const Json& times = record->timings[i]["compute_s"];
      if (!times.is_object()) continue;
      const bool used = record->picks[i]["used_simulator"] == true;
      for (const auto& [part, value] : times.items()) {
        all[part].push_back(value);
        (used ? with : without)[part].push_back(value);
      }
    }
  }
  Json out;
  out["arm"] = arm;
  out["name"] = result.ArmName(arm);
  for (const char* part : {"modelling", "planning", "evaluator", "total"}) {
    out[part] = Json{{"all", SpreadJson(all[part])},
                     {"without_simulator", SpreadJson(without[part])},
                     {"with_simulator", SpreadJson(with[part])}};
  }
  return out;
}

std::string RateText(const Json& rate) {
  const int k = rate["k"], n = rate["n"];
  char text[96];
  std::snprintf(text, sizeof text, "%5d/%-5d %5.1f %% [%5.1f, %5.1f]", k, n,
                n > 0 ? 100.0 * k / n : 0.0, 100.0 * rate["wilson95"][0].get<double>(),
                100.0 * rate["wilson95"][1].get<double>());
  std::string out = text;
  if (rate.contains("cluster95")) {
    std::snprintf(text, sizeof text, "  by round [%5.1f, %5.1f]",
                  100.0 * rate["cluster95"][0].get<double>(),
                  100.0 * rate["cluster95"][1].get<double>());
    out += text;
  }
  return out;
}

std::string SpreadText(const Json& spread) {
  if (spread.is_null()) return "-";
  char text[96];
  std::snprintf(text, sizeof text, "median %.2f s, 5 to 95 %%: %.2f to %.2f s, n %d",
                spread["median"].get<double>(), spread["p5"].get<double>(),
                spread["p95"].get<double>(), spread["n"].get<int>());
  return text;
}

}  // namespace

Json RateJson(Counts counts) {
  const ShareInterval wilson = Wilson95(counts.k, counts.n);
  return Json{
      {"k", counts.k}, {"n", counts.n}, {"wilson95", Json::array({wilson.low, wilson.high})}};
}

Json RateJson(const std::vector<Counts>& by_round, const RandomStream& random) {
  Json out = RateJson(Total(by_round));
  const ShareInterval cluster = ClusterBootstrap95(by_round, random);
  out["cluster95"] = Json::array({cluster.low, cluster.high});
  return out;
}

Json SpreadJson(const std::vector<double>& values) {
  if (values.empty()) return nullptr;
  const Spread spread = SpreadOf(values);
  return Json{{"n", spread.n},    {"mean", spread.mean},     {"sd", spread.sd},
              {"p5", spread.p5},  {"median", spread.median}, {"p95", spread.p95},
              {"max", spread.max}};
}

Json CampaignSummary(const CampaignResult& result) {
  const auto seed = result.identity["seed"].get<std::uint64_t>();
  Records all;
  for (const RoundRecord& record : result.records) all.push_back(&record);
  const auto rounds = Facts(all);
  Json out;
  out["schema"] = "tubetwin/campaign_summary/1";
  out["seed"] = seed;
  AddTotals(all, rounds, out);
  out["success"] = RateJson(Total(ByRound(rounds, Any, Success)));
  out["first_attempt"] = RateJson(Total(ByRound(rounds, Success, First)));
  out["emptied"] = RateJson(Emptied(all));
  out["arms"] = Json::array();
  for (int arm = 0; arm < result.arms(); ++arm) {
    const RandomStream random =
        RandomStream(seed, 0, "bootstrap").Fork("arm", static_cast<std::uint64_t>(arm));
    out["arms"].push_back(ArmSummary(result, arm, random));
  }
  return out;
}

Json CampaignManifest(const CampaignResult& result) {
  Json out;
  out["schema"] = "tubetwin/campaign_manifest/1";
  out["program"] = result.identity["program"];
  out["mujoco"] = result.identity["mujoco"];
  out["fingerprint"] = Fingerprint(result.identity.dump());
  out["compute_s"] = Json::array();
  for (int arm = 0; arm < result.arms(); ++arm) {
    out["compute_s"].push_back(ComputeTimes(result, arm));
  }
  return out;
}

std::string SummaryText(const Json& summary, const Json& manifest) {
  std::string out;
  for (std::size_t i = 0; i < summary["arms"].size(); ++i) {
    const Json& arm = summary["arms"][i];
    out += "arm " + std::to_string(i) + "  " + arm["name"].get<std::string>() + ", " +
           std::to_string(arm["rounds"].get<int>()) + " rounds\n";
    out += "  success           " + RateText(arm["success"]) + "\n";
    out += "  at first attempt  " + RateText(arm["first_attempt"]) + "\n";
    out += "  bins emptied      " + RateText(arm["emptied"]) + "\n";
    for (const Json& left : arm["by_tubes_left"]) {
      char head[32];
      std::snprintf(head, sizeof head, "  %2d tubes left     ", left["tubes_left"].get<int>());
      out += head + RateText(left["success"]) + "\n";
    }
    for (const auto& [name, count] : arm["failures"].items()) {
      out += "  failure " + name + ": " + count.dump() + "\n";
    }
    out += "  simulated time of an attempt: " + SpreadText(arm["sim_s"]["attempt"]["total"]) + "\n";
    out +=
        "  computing time of an attempt: " + SpreadText(manifest["compute_s"][i]["total"]["all"]) +
        "\n";
  }
  return out;
}

}  // namespace tubetwin
