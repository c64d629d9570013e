#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <stdexcept>
#include <string>
#include <vector>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/random.h"
#include "twin/campaign/campaign.h"
#include "twin/campaign/merge.h"
#include "twin/campaign/run_campaign.h"

namespace tubetwin {

/// A campaign of arms with three tubes that differ in the planner's exclude_free.
inline Campaign FakeCampaign(int rounds, int arms = 1, std::int64_t seed = 1) {
  Campaign campaign;
  campaign.seed = seed;
  campaign.rounds = rounds;
  for (int i = 0; i < arms; ++i) {
    CampaignArm arm;
    arm.name = "arm " + std::to_string(i);
    arm.scenario.pile.count = 3 + i;
    arm.tubes = 3 + i;
    campaign.arms.push_back(arm);
  }
  return campaign;
}

/// One attempt: `placed` and `outside` are how many tubes lie there after it.
inline Json FakeRow(int attempt, const std::string& outcome, bool success, int placed,
                    int outside = 0, double sim_s = 30.0) {
  Json row;
  row["round"] = 0;
  row["attempt"] = attempt;
  row["used_simulator"] = sim_s > 31.0;
  row["resolution"] = Json{{"used", false}, {"strategy", nullptr}, {"outcome", nullptr}};
  row["outcome"] = outcome;
  row["success"] = success;
  row["sim_s"] =
      Json{{"scan", 5.0}, {"move", sim_s - 8.0}, {"weigh", 2.0}, {"settle", 1.0}, {"total", sim_s}};
  row["truth"] = Json{{"placed_ids", Json::array()}, {"outside_ids", Json::array()}};
  for (int i = 0; i < placed; ++i) row["truth"]["placed_ids"].push_back(i);
  for (int i = 0; i < outside; ++i) row["truth"]["outside_ids"].push_back(100 + i);
  return row;
}

inline Json FakeSummary(int start, int placed, int outside, double sim_s) {
  return Json{{"tubes_start", start},  {"placed", placed}, {"attempts", 0},
              {"outside", outside},    {"dropped", 0},     {"emptied", placed == start},
              {"end_reason", "empty"}, {"sim_s", sim_s}};
}

/// A round in no time, of random outcome by its seed and arm; timings come from the clock's mood.
inline RoundOutput FakeRound(const Campaign& campaign, const RoundTask& task) {
  RandomStream random(static_cast<std::uint64_t>(task.seed), 0, "fake");
  RoundOutput out;
  const int start = campaign.arms[task.arm].tubes;
  const double chance = task.arm == 0 ? 0.7 : 0.9;
  int placed = 0, attempt = 1;
  double sim_s = 0.0;
  for (int tries = 0; placed < start && tries < 2 * start; ++tries) {
    const bool success = random.Uniform() < chance;
    placed += success ? 1 : 0;
    const double took_s = random.Uniform(25.0, 35.0);
    sim_s += took_s;
    out.picks.push_back(
        FakeRow(attempt, success ? "placed" : "nothing_held", success, placed, 0, took_s));
    out.timings.push_back(Json{{"round", 0},
                               {"attempt", attempt},
                               {"compute_s", Json{{"total", 0.1 * (tries + 1)}}},
                               {"wall_s", static_cast<double>(::clock())}});
    attempt = success ? 1 : attempt + 1;
  }
  out.summary = FakeSummary(start, placed, 0, sim_s);
  return out;
}

/// A result of one arm whose rounds are given by hand.
inline CampaignResult Result(std::vector<RoundRecord> records, int arms = 1) {
  CampaignResult result;
  Campaign campaign = FakeCampaign(static_cast<int>(records.size()) / arms, arms);
  result.identity = CampaignIdentity(campaign, "test");
  result.records = std::move(records);
  return result;
}

inline RoundRecord Record(int round, std::vector<Json> picks, Json summary) {
  RoundRecord record;
  record.round = round;
  record.seed = RoundSeed(1, round);
  record.picks = std::move(picks);
  record.summary = std::move(summary);
  return record;
}

inline CampaignRunOptions Options(const std::string& folder, Shard shard = {}) {
  CampaignRunOptions options;
  options.out_folder = folder;
  options.shard = shard;
  options.jobs = 2;
  options.program_version = "test";
  return options;
}

inline RoundFunction Rounds(const Campaign& campaign) {
  return [&campaign](const RoundTask& task) { return FakeRound(campaign, task); };
}

inline CampaignRun RunAll(const Campaign& campaign, const std::string& folder, Shard shard = {}) {
  return RunCampaign(campaign, Rounds(campaign), Options(folder, shard));
}

/// Bytes of what a merge of `folders` writes and every run must repeat.
inline std::string MergedBytes(const std::vector<std::string>& folders, const std::string& out) {
  WriteMerged(ReadShards(folders), out);
  return ReadFile(out + "/picks.jsonl") + ReadFile(out + "/rounds.jsonl") +
         ReadFile(out + "/summary.json") + ReadFile(out + "/campaign.json");
}

template <class Call>
Error Refusal(const Call& call) {
  try {
    call();
  } catch (const Error& e) {
    return e;
  }
  throw std::runtime_error("nothing was refused");
}

/// Runs `body` in a child; its exit code, or minus the signal that ended it. With `kill_after_us`
/// the child is killed then.
template <class Body>
int InChild(const Body& body, int kill_after_us = -1) {
  const pid_t child = ::fork();
  if (child == 0) {
    try {
      body();
      ::_exit(0);
    } catch (const Error& e) {
      ::_exit(static_cast<int>(e.kind()));
    } catch (...) {
      ::_exit(99);
    }
  }
  if (kill_after_us >= 0) {
    ::usleep(static_cast<useconds_t>(kill_after_us));
    ::kill(child, SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

inline int LinesOf(const std::string& file) {
  const std::string text = ReadFile(file);
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace tubetwin
