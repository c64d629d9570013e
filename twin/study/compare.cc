#include "twin/study/compare.h"

#include <cmath>
#include <cstdio>
#include <map>

#include "models/base/error.h"
#include "models/base/json.h"
#include "twin/campaign/campaign_summary.h"
#include "twin/round/attempt_facts.h"

namespace tubetwin {
namespace {

/// What one round contributes to the comparison.
struct RoundScore {
  bool first_pick = false, flawless = false, emptied = false;
  Counts success, first_attempt, resolution;
  double sim_s = 0.0;
  int placed = 0;
};

RoundScore ScoreOf(const RoundRecord& record) {
  RoundScore out;
  const std::vector<AttemptFacts> all = FactsOf(record);
  out.emptied = record.summary["emptied"] == true;
  out.first_pick = !all.empty() && all.front().success;
  out.flawless = out.emptied;
  for (const AttemptFacts& facts : all) {
    out.flawless = out.flawless && facts.success;
    ++out.success.n;
    out.success.k += facts.success ? 1 : 0;
    out.first_attempt.n += facts.success ? 1 : 0;
    out.first_attempt.k += facts.success && facts.first ? 1 : 0;
    if ((*facts.row)["resolution"]["used"] == true) {
      ++out.resolution.n;
      out.resolution.k += facts.success ? 1 : 0;
    }
  }
  const Json& sim_s = record.summary["sim_s"];
  if (sim_s.is_number()) {
    out.sim_s = sim_s;
    out.placed = record.summary["placed"];
  }
  return out;
}

using Scores = std::vector<std::pair<RoundScore, RoundScore>>;  ///< A and B of each seed.
using Answer = bool RoundScore::*;
using Share = Counts RoundScore::*;

Json McNemarJson(const char* name, Answer answer, const Scores& scores) {
  int both = 0, only_a = 0, only_b = 0, neither = 0;
  for (const auto& [a, b] : scores) {
    if (a.*answer) {
      ++(b.*answer ? both : only_a);
    } else {
      ++(b.*answer ? only_b : neither);
    }
  }
  const int n = static_cast<int>(scores.size());
  return Json{{"question", name},
              {"a", RateJson(Counts{both + only_a, n})},
              {"b", RateJson(Counts{both + only_b, n})},
              {"both", both},
              {"only_a", only_a},
              {"only_b", only_b},
              {"neither", neither},
              {"p", McNemarExact(only_a, only_b)}};
}

Json Finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// B - A of `measure(sum over rounds)`, with a bootstrap over pairs of rounds.
template <class Measure>
Json DifferenceJson(const Scores& scores, const RandomStream& random, const Measure& measure) {
  const auto difference = [&](const std::vector<int>& drawn) {
    return measure(drawn, &Scores::value_type::second) - measure(drawn, &Scores::value_type::first);
  };
  std::vector<int> all(scores.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  const Interval interval = Bootstrap95(static_cast<int>(scores.size()), difference, random);
  return Json{{"b_minus_a", Finite(difference(all))},
              {"bootstrap95", Json::array({Finite(interval.low), Finite(interval.high)})}};
}

Json ShareDifference(Share share, const Scores& scores, const RandomStream& random) {
  Json out = DifferenceJson(scores, random, [&](const std::vector<int>& drawn, auto side) {
    double k = 0.0, n = 0.0;
    for (const int i : drawn) {
      k += (scores[i].*side.*share).k;
      n += (scores[i].*side.*share).n;
    }
    return k / n;
  });
  std::vector<Counts> a, b;
  for (const auto& [of_a, of_b] : scores) {
    a.push_back(of_a.*share);
    b.push_back(of_b.*share);
  }
  out["a"] = RateJson(a, random.Fork("a"));
  out["b"] = RateJson(b, random.Fork("b"));
  return out;
}

Json TimeDifference(const Scores& scores, const RandomStream& random) {
  return DifferenceJson(scores, random, [&](const std::vector<int>& drawn, auto side) {
    double sim_s = 0.0, placed = 0.0;
    for (const int i : drawn) {
      sim_s += (scores[i].*side).sim_s;
      placed += (scores[i].*side).placed;
    }
    return sim_s / placed;
  });
}

Json ComparePair(const ArmPair& pair, std::uint64_t index) {
  std::map<std::int64_t, const RoundRecord*> of_b;
  for (const RoundRecord* record : pair.b.result->OfArm(pair.b.arm)) of_b[record->seed] = record;
  Scores scores;
  const auto of_a = pair.a.result->OfArm(pair.a.arm);
  for (const RoundRecord* record : of_a) {
    const auto partner = of_b.find(record->seed);
    if (partner == of_b.end()) continue;
    scores.emplace_back(ScoreOf(*record), ScoreOf(*partner->second));
  }
  if (scores.empty()) {
    throw Error(ErrorKind::kBadData,
                pair.a.name + " and " + pair.b.name +
                    " have no seed in common: paired comparison needs campaigns of one seed");
  }
  const RandomStream random =
      RandomStream(pair.a.result->identity["seed"].get<std::uint64_t>(), 0, "compare")
          .Fork("pair", index);
  Json out;
  out["a"] = pair.a.name;
  out["b"] = pair.b.name;
  out["pairs"] = scores.size();
  out["unpaired_a"] = of_a.size() - scores.size();
  out["unpaired_b"] = of_b.size() - scores.size();
  out["tests"] = Json::array({McNemarJson("first_pick", &RoundScore::first_pick, scores),
                              McNemarJson("flawless", &RoundScore::flawless, scores),
                              McNemarJson("emptied", &RoundScore::emptied, scores)});
  out["success"] = ShareDifference(&RoundScore::success, scores, random.Fork("success"));
  out["first_attempt"] = ShareDifference(&RoundScore::first_attempt, scores, random.Fork("first"));
  out["resolution"] = ShareDifference(&RoundScore::resolution, scores, random.Fork("resolution"));
  out["sim_s_per_placed_tube"] = TimeDifference(scores, random.Fork("time"));
  return out;
}

std::string Percent(const Json& rate) {
  const int k = rate["k"], n = rate["n"];
  char text[64];
  std::snprintf(text, sizeof text, "%d/%d = %.1f %%", k, n, n > 0 ? 100.0 * k / n : 0.0);
  return text;
}

std::string DifferenceText(const Json& difference, double scale, const char* unit) {
  const Json& interval = difference["bootstrap95"];
  if (difference["b_minus_a"].is_null() || interval[0].is_null()) return "not known";
  char text[96];
  std::snprintf(text, sizeof text, "%+.1f %s [%+.1f, %+.1f]",
                scale * difference["b_minus_a"].get<double>(), unit,
                scale * interval[0].get<double>(), scale * interval[1].get<double>());
  return text;
}

}  // namespace

std::vector<ArmPair> PairArms(const CampaignResult& a, const CampaignResult& b) {
  const auto choice = [](const CampaignResult& result, int arm) {
    return ArmChoice{&result, arm, result.ArmName(arm)};
  };
  std::vector<ArmPair> out;
  if (a.arms() != b.arms() && a.arms() != 1 && b.arms() != 1) {
    throw Error(ErrorKind::kBadData, "A has " + std::to_string(a.arms()) + " arms and B has " +
                                         std::to_string(b.arms()) +
                                         "; equally many are needed, or one against all");
  }
  for (int i = 0; i < std::max(a.arms(), b.arms()); ++i) {
    out.push_back({choice(a, a.arms() == 1 ? 0 : i), choice(b, b.arms() == 1 ? 0 : i)});
    if (out.back().a.name == out.back().b.name) {
      out.back().a.name += " (A)";
      out.back().b.name += " (B)";
    }
  }
  return out;
}

std::vector<ArmPair> PairArmsWithin(const CampaignResult& result) {
  if (result.arms() < 2) {
    throw Error(ErrorKind::kBadData, "the campaign has one arm ('" + result.ArmName(0) +
                                         "'); name a second campaign to compare it with");
  }
  std::vector<ArmPair> out;
  for (int i = 0; i < result.arms(); ++i) {
    for (int j = i + 1; j < result.arms(); ++j) {
      out.push_back({{&result, i, result.ArmName(i)}, {&result, j, result.ArmName(j)}});
    }
  }
  return out;
}

Json CompareArms(const std::vector<ArmPair>& pairs) {
  Json out;
  out["schema"] = "tubetwin/comparison/1";
  out["pairs"] = Json::array();
  std::vector<double> p_values;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    out["pairs"].push_back(ComparePair(pairs[i], i));
    for (const Json& test : out["pairs"].back()["tests"]) p_values.push_back(test["p"]);
  }
  const std::vector<double> adjusted = HolmAdjusted(p_values);
  std::size_t next = 0;
  for (Json& pair : out["pairs"]) {
    for (Json& test : pair["tests"]) test["p_holm"] = adjusted[next++];
  }
  out["tests"] = p_values.size();
  return out;
}

std::string CompareText(const Json& comparison) {
  std::string out;
  for (const Json& pair : comparison["pairs"]) {
    out += "A = " + pair["a"].get<std::string>() + "\nB = " + pair["b"].get<std::string>() + "\n" +
           std::to_string(pair["pairs"].get<int>()) + " pairs of rounds with the same seed";
    const int left = pair["unpaired_a"].get<int>() + pair["unpaired_b"].get<int>();
    if (left > 0) out += ", " + std::to_string(left) + " rounds without a partner left out";
    out += "\n";
    for (const Json& test : pair["tests"]) {
      char text[256];
      std::snprintf(text, sizeof text,
                    "  %-11s A %-18s B %-18s only A %d, only B %d, McNemar p = %.4g, Holm %.4g\n",
                    test["question"].get<std::string>().c_str(), Percent(test["a"]).c_str(),
                    Percent(test["b"]).c_str(), test["only_a"].get<int>(),
                    test["only_b"].get<int>(), test["p"].get<double>(),
                    test["p_holm"].get<double>());
      out += text;
    }
    for (const char* rate : {"success", "first_attempt", "resolution"}) {
      char text[256];
      std::snprintf(text, sizeof text, "  %-21s A %-20s B %-20s B - A %s\n", rate,
                    Percent(pair[rate]["a"]).c_str(), Percent(pair[rate]["b"]).c_str(),
                    DifferenceText(pair[rate], 100.0, "points").c_str());
      out += text;
    }
    out += "  simulated time per placed tube: B - A " +
           DifferenceText(pair["sim_s_per_placed_tube"], 1.0, "s") + "\n";
  }
  return out;
}

}  // namespace tubetwin
