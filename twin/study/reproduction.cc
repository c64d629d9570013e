#include "twin/study/reproduction.h"

#include <array>
#include <functional>
#include <map>
#include <optional>

#include "models/base/error.h"
#include "models/base/json.h"
#include "twin/campaign/campaign_summary.h"
#include "twin/round/attempt_facts.h"
#include "twin/study/paper_2020.h"

namespace tubetwin {
namespace {

constexpr int kTubes = 7;
// Names of the arms: set and profile, as the tables find them again.
constexpr const char* kSets[] = {"A", "B"};
constexpr const char* kProfiles[] = {"leao2020", "best"};

/// One attempt with its computing times.
struct Attempt {
  AttemptFacts facts;
  bool simulator = false, upward = false, resolution = false;
  double total_s = 0.0, planning_s = 0.0, modelling_s = 0.0;
  bool timed = false;
};

struct ArmData {
  std::vector<std::vector<Attempt>> rounds;
  Counts emptied;
  RandomStream random;
};

ArmData DataOf(const CampaignResult& result, const std::string& name) {
  for (int arm = 0; arm < result.arms(); ++arm) {
    if (result.ArmName(arm) != name) continue;
    ArmData out{{},
                {},
                RandomStream(result.identity["seed"].get<std::uint64_t>(),
                             static_cast<std::uint64_t>(arm), "reproduction")};
    for (const RoundRecord* record : result.OfArm(arm)) {
      ++out.emptied.n;
      out.emptied.k += record->summary["emptied"] == true ? 1 : 0;
      std::vector<Attempt>& round = out.rounds.emplace_back();
      for (const AttemptFacts& facts : FactsOf(*record)) {
        Attempt attempt;
        attempt.facts = facts;
        const Json& row = *facts.row;
        attempt.simulator = row["used_simulator"] == true;
        attempt.resolution = row["resolution"]["used"] == true;
        const bool moved = row.contains("motion") && row["motion"].is_object();
        attempt.upward = moved && row["motion"]["name"].get<std::string>().starts_with("up");
        const std::size_t i = round.size();
        if (i < record->timings.size() && record->timings[i]["compute_s"].is_object()) {
          const Json& times = record->timings[i]["compute_s"];
          attempt.timed = true;
          attempt.total_s = times["total"];
          attempt.modelling_s = times["modelling"];
          attempt.planning_s = times["planning"].get<double>() + times["evaluator"].get<double>();
        }
        round.push_back(std::move(attempt));
      }
    }
    return out;
  }
  throw Error(ErrorKind::kBadData, "the campaign has no arm '" + name +
                                       "': it is not the one that `tubetwin reproduce` runs");
}

using Test = std::function<bool(const Attempt&)>;

std::vector<Counts> ByRound(const ArmData& arm, const Test& counted, const Test& good) {
  std::vector<Counts> out;
  for (const auto& round : arm.rounds) {
    Counts counts;
    for (const Attempt& attempt : round) {
      if (!counted(attempt)) continue;
      ++counts.n;
      counts.k += good(attempt) ? 1 : 0;
    }
    out.push_back(counts);
  }
  return out;
}

Json Rate(const ArmData& arm, const Test& counted, const Test& good) {
  return RateJson(ByRound(arm, counted, good), arm.random);
}

Json TimeJson(int n, double mean, double sd) {
  if (n < 2) return nullptr;
  const Interval interval = MeanInterval95(n, mean, sd);
  return Json{
      {"n", n}, {"mean", mean}, {"sd", sd}, {"mean95", Json::array({interval.low, interval.high})}};
}

Json Time(const ArmData& arm, const Test& counted, double Attempt::*value) {
  std::vector<double> values;
  for (const auto& round : arm.rounds) {
    for (const Attempt& attempt : round) {
      if (attempt.timed && counted(attempt)) values.push_back(attempt.*value);
    }
  }
  if (values.empty()) return nullptr;
  const Spread spread = SpreadOf(values);
  return TimeJson(spread.n, spread.mean, spread.sd);
}

bool Any(const Attempt&) { return true; }
bool Succeeded(const Attempt& a) { return a.facts.success; }
bool First(const Attempt& a) { return a.facts.first; }
bool Simulated(const Attempt& a) { return a.simulator; }
bool NotSimulated(const Attempt& a) { return !a.simulator; }
bool SimulatedUp(const Attempt& a) { return a.simulator && a.upward; }
bool SimulatedEscape(const Attempt& a) { return a.simulator && !a.upward; }
bool Resolved(const Attempt& a) { return a.resolution; }
Test Left(int tubes, const Test& test) {
  return [=](const Attempt& a) { return a.facts.tubes_left == tubes && test(a); };
}

/// Builds the rows of one set: `paper` beside one cell of each profile.
class Rows {
 public:
  Rows(std::string set, const std::vector<ArmData>& arms) : set_(std::move(set)), arms_(arms) {}

  void Add(Json& rows, const std::string& what, std::optional<int> tubes_left, Json paper,
           const std::function<Json(const ArmData&)>& cell) const {
    Json row{{"set", set_}, {"what", what}, {"tubes_left", nullptr}};
    if (tubes_left) row["tubes_left"] = *tubes_left;
    row["paper"] = std::move(paper);
    for (std::size_t i = 0; i < arms_.size(); ++i) row[kProfiles[i]] = cell(arms_[i]);
    row["apart"] = Json::array();
    for (const char* profile : kProfiles) {
      if (Apart(row["paper"], row[profile])) row["apart"].push_back(profile);
    }
    rows.push_back(std::move(row));
  }

  /// One row for each number of tubes, then one over all.
  void AddByTubes(Json& rows, const std::string& what, const std::array<Counts, 7>& paper,
                  const Test& counted, const Test& good) const {
    Counts sum;
    for (int left = kTubes; left >= 1; --left) {
      const Counts& counts = paper[static_cast<std::size_t>(kTubes - left)];
      sum.k += counts.k;
      sum.n += counts.n;
      Add(rows, what, left, RateJson(counts),
          [&](const ArmData& arm) { return Rate(arm, Left(left, counted), Left(left, good)); });
    }
    Add(rows, what, std::nullopt, RateJson(sum),
        [&](const ArmData& arm) { return Rate(arm, counted, good); });
  }

 private:
  /// Whether both cells say something and their intervals do not meet.
  static bool Apart(const Json& paper, const Json& ours) {
    if (!paper.is_object() || !ours.is_object()) return false;
    const char* key = paper.contains("wilson95") ? "wilson95" : "mean95";
    if (paper["n"] == 0 || ours["n"] == 0) return false;
    return paper[key][1].get<double>() < ours[key][0].get<double>() ||
           ours[key][1].get<double>() < paper[key][0].get<double>();
  }

  std::string set_;
  const std::vector<ArmData>& arms_;
};

std::array<Counts, 7> Of(const std::array<int, 7>& uses, const std::array<int, 7>& attempts) {
  std::array<Counts, 7> out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {uses[i], attempts[i]};
  return out;
}

std::array<int, 7> Sum(const std::array<int, 7>& a, const std::array<int, 7>& b) {
  std::array<int, 7> out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = a[i] + b[i];
  return out;
}

int Total(const std::array<int, 7>& values) {
  int sum = 0;
  for (const int value : values) sum += value;
  return sum;
}

void AddShares(const Rows& rows, const PaperSet& paper, std::map<int, Json>& tables) {
  rows.Add(tables[3], "bins emptied", std::nullopt, RateJson(paper.emptied),
           [](const ArmData& arm) { return RateJson(arm.emptied); });
  rows.AddByTubes(tables[4], "placed on the first attempt", paper.first_attempt, Succeeded, First);
  rows.AddByTubes(tables[5], "simulator, upwards", Of(paper.up_uses, paper.attempts), Any,
                  SimulatedUp);
  rows.AddByTubes(tables[5], "simulator, escape", Of(paper.escape_uses, paper.attempts), Any,
                  SimulatedEscape);
  rows.AddByTubes(tables[5], "simulator used",
                  Of(Sum(paper.up_uses, paper.escape_uses), paper.attempts), Any, Simulated);
  const auto success = [&](const char* what, Counts counts, const Test& counted) {
    rows.Add(tables[6], what, std::nullopt, RateJson(counts),
             [&](const ArmData& arm) { return Rate(arm, counted, Succeeded); });
  };
  success("upwards", paper.up, SimulatedUp);
  success("escape", paper.escape, SimulatedEscape);
  success("with simulator", {paper.up.k + paper.escape.k, paper.up.n + paper.escape.n}, Simulated);
  rows.AddByTubes(tables[7], "resolution used", Of(paper.resolution_uses, paper.attempts), Any,
                  Resolved);
  rows.Add(tables[8], "resolution led to a pick", std::nullopt, RateJson(paper.resolution),
           [](const ArmData& arm) { return Rate(arm, Resolved, Succeeded); });
}

void AddTimes(const Rows& rows, const PaperSet& paper, Json& table) {
  const int all = Total(paper.attempts);
  const int with = Total(paper.up_uses) + Total(paper.escape_uses);
  struct Case {
    const char* name;
    int n;
    Test counted;
  };
  const Case cases[] = {{"all", all, Any},
                        {"without simulation", all - with, NotSimulated},
                        {"with simulation", with, Simulated}};
  const auto add = [&](const std::string& what, int n, PaperSet::Time time, const Test& counted,
                       double Attempt::*value) {
    rows.Add(table, what, std::nullopt, TimeJson(n, time.mean_s, time.sd_s),
             [&](const ArmData& arm) { return Time(arm, counted, value); });
  };
  for (std::size_t i = 0; i < 3; ++i) {
    add(std::string("total processing, ") + cases[i].name, cases[i].n, paper.total[i],
        cases[i].counted, &Attempt::total_s);
  }
  add("modelling", all, paper.modelling, Any, &Attempt::modelling_s);
  for (std::size_t i = 0; i < 3; ++i) {
    add(std::string("planning, ") + cases[i].name, cases[i].n, paper.planning[i], cases[i].counted,
        &Attempt::planning_s);
  }
}

}  // namespace

std::string ReproductionToml(std::int64_t seed, int rounds) {
  std::string out =
      "# Leao et al., Appl. Sci. 2020, 10, 2264: 20 rounds of each set of seven tubes.\n";
  out += "seed = " + std::to_string(seed) + "\nrounds = " + std::to_string(rounds) + "\n";
  // One scan on the whole bin at full resolution; the profile brings the paper's other parameters.
  // The paper prints no limits of joints, and those of its authors' later join data (the profile's
  // 3 cm and 30 degrees) leave no hose of set B whole: a bend of 150 degrees is two or three
  // cylinders.
  const char* const sets[] = {
      "# Limits of joints are not in the paper.\n"
      "set = {scan.overhead_m = 0.80, scan.resolution = \"2064x1544\", "
      "perception.leao2020.join_distance_m = 0.05, perception.leao2020.join_angle_deg = 70}\n",
      "set = {scan.views = 8}\n"};
  for (int profile = 0; profile < 2; ++profile) {
    for (int set = 0; set < 2; ++set) {
      out += std::string("\n[[arm]]\nname = \"") + kSets[set] + " " + kProfiles[profile] +
             "\"\npart = \"" + (set == 0 ? "pvc_a" : "hose_b") +
             "\"\ncount = " + std::to_string(kTubes) + "\nprofile = \"" + kProfiles[profile] +
             "\"\n" + sets[profile];
    }
  }
  return out;
}

Json ReproductionTables(const CampaignResult& result) {
  std::map<int, Json> rows;
  for (int table = 3; table <= 9; ++table) rows[table] = Json::array();
  for (int set = 0; set < 2; ++set) {
    std::vector<ArmData> arms;
    for (const char* profile : kProfiles) {
      arms.push_back(DataOf(result, std::string(kSets[set]) + " " + profile));
    }
    const Rows builder(kSets[set], arms);
    const PaperSet& paper = set == 0 ? kPaperSetA : kPaperSetB;
    AddShares(builder, paper, rows);
    AddTimes(builder, paper, rows[9]);
  }
  static const std::map<int, const char*> kTitles = {
      {3, "Rounds in which the bin was emptied"},
      {4, "Picked tubes that were placed on the first attempt"},
      {5, "Attempts with simulation, and the trajectory it chose"},
      {6, "Success of attempts with simulation"},
      {7, "Attempts with entanglement resolution"},
      {8, "Success of attempts with entanglement resolution"},
      {9, "Computing times of an attempt"}};
  Json out{{"schema", "tubetwin/reproduction/1"},
           {"seed", result.identity["seed"]},
           {"rounds", result.rounds()},
           {"tables", Json::array()}};
  for (const auto& [table, title] : kTitles) {
    out["tables"].push_back(Json{{"table", table}, {"title", title}, {"rows", rows[table]}});
  }
  return out;
}

}  // namespace tubetwin
