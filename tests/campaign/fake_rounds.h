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
#include "models/base/random.h"
#include "twin/campaign/campaign.h"
#include "twin/campaign/merge.h"
#include "twin/campaign/run_campaign.h"

namespace tubetwin {

/// A campaign of variants with three tubes that differ in the planner's exclude_free.
inline Campaign FakeCampaign(int rounds, int variants = 1, std::int64_t seed = 1) {
  Campaign campaign;
  campaign.seed = seed;
  campaign.rounds = rounds;
  for (int i = 0; i < variants; ++i) {
    CampaignVariant variant;
    variant.name = "variant " + std::to_string(i);
    variant.scenario.pile.count = 3 + i;
    variant.tubes = 3 + i;
    campaign.variants.push_back(variant);
  }
  return campaign;
}

/// One attempt: `placed` and `outside` are how many tubes lie there after it.
inline AttemptRecord FakeAttempt(int number, AttemptOutcome outcome, bool success, int placed,
                                 int outside = 0, double sim_s = 30.0) {
  AttemptRecord attempt;
  attempt.attempt = number;
  attempt.used_simulator = sim_s > 31.0;
  attempt.outcome = outcome;
  attempt.success = attempt.in_tolerance = success;
  attempt.sim_s = AttemptReport::SimTime{5.0, sim_s - 8.0, 2.0, 1.0};
  attempt.truth.emplace();
  for (int i = 0; i < placed; ++i) attempt.truth->placed_ids.push_back(i);
  for (int i = 0; i < outside; ++i) attempt.truth->outside_ids.push_back(100 + i);
  if (success) attempt.truth->placement_error_mm = attempt.truth->placement_error_deg = 7.5;
  return attempt;
}

inline RoundSummary FakeSummary(int start, int placed, int outside, double sim_s) {
  RoundSummary summary;
  summary.tubes_start = start;
  summary.placed = placed;
  summary.outside = outside;
  summary.success = Counts{0, 0};
  summary.tolerance = PlacementTolerance();
  summary.emptied = placed == start;
  summary.end = RoundEnd::kEmpty;
  summary.sim_s = sim_s;
  return summary;
}

/// The record with a summary that tells what its attempts tell.
inline RoundRecord Summed(RoundRecord record) {
  const AttemptCounts rows = CountAttempts(record.attempts);
  record.summary.attempts = rows.attempts;
  record.summary.success = rows.success;
  record.summary.first_attempt = rows.first_attempt;
  record.summary.dropped = rows.dropped;
  return record;
}

/// A round in no time, of random outcome by its seed and variant; timings come from the clock's
/// mood.
inline RoundOutput FakeRound(const Campaign& campaign, const RoundTask& task) {
  RandomStream random(static_cast<std::uint64_t>(task.seed), 0, "fake");
  RoundOutput out;
  const int start = campaign.variants[task.variant].tubes;
  const double chance = task.variant == 0 ? 0.7 : 0.9;
  int placed = 0, number = 1;
  double sim_s = 0.0;
  for (int tries = 0; placed < start && tries < 2 * start; ++tries) {
    const bool success = random.Uniform() < chance;
    placed += success ? 1 : 0;
    const double took_s = random.Uniform(25.0, 35.0);
    sim_s += took_s;
    const auto outcome = success ? AttemptOutcome::kPlaced : AttemptOutcome::kNothingHeld;
    out.record.attempts.push_back(FakeAttempt(number, outcome, success, placed, 0, took_s));
    AttemptTiming timing{number, AttemptReport::ComputeTime(), static_cast<double>(::clock())};
    timing.compute_s->total = 0.1 * (tries + 1);
    out.record.timings.push_back(timing);
    number = success ? 1 : number + 1;
  }
  out.record.summary = FakeSummary(start, placed, 0, sim_s);
  out.record = Summed(std::move(out.record));
  return out;
}

/// A result whose rounds are given by hand.
inline CampaignResult Result(std::vector<RoundRecord> records, int variants = 1) {
  CampaignResult result;
  Campaign campaign = FakeCampaign(static_cast<int>(records.size()) / variants, variants);
  result.identity = IdentityOf(campaign, "test");
  result.records = std::move(records);
  return result;
}

inline RoundRecord Record(int round, std::vector<AttemptRecord> attempts, RoundSummary summary) {
  RoundRecord record;
  record.round = round;
  record.seed = RoundSeed(1, round);
  record.attempts = std::move(attempts);
  record.summary = std::move(summary);
  return Summed(std::move(record));
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
