#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "twin/campaign/campaign.h"
#include "twin/campaign/round_worker.h"
#include "twin/campaign/shard.h"
#include "twin/round/records/throughput.h"

namespace tubetwin {

/// Where a shard is, for progress lines and status files.
struct ShardProgress {
  Shard shard;
  int done = 0, total = 0;  ///< Rounds, each variant's counted on its own.
  int running = 0;
  int faults = 0;                   ///< Rounds that threw or crashed.
  int successes = 0, attempts = 0;  ///< By truth, over all rounds done.
  int variants = 1;
  /// Of the rounds done of each variant: placed tubes, and cell and computing time.
  std::vector<RoundWork> work;
  double rounds_per_hour = 0.0;        ///< Of this process; 0 before its first round ended.
  std::optional<double> seconds_left;  ///< Nothing as long as there is no rate.
  long peak_memory_kB = 0;             ///< Largest of the processes of rounds so far.
};

struct CampaignRunOptions {
  std::string out_folder;
  Shard shard;
  int jobs = 1;
  std::optional<double> limit_s;  ///< No round begins after that many seconds.
  double grace_s = 20.0;          ///< How long rounds in hand may go on after a stop.
  std::string program_version;
  std::function<bool()> stop_requested;
  std::function<void(const ShardProgress&)> progress;   ///< After each round and every 0.5 s.
  std::function<void(const std::string& line)> notice;  ///< What a person should know.
};

enum class CampaignEnd { kDone, kStopped, kTimeLimit };

struct CampaignRun {
  CampaignEnd end = CampaignEnd::kDone;
  ShardProgress progress;
};

/// Runs the rounds of one shard that its file does not hold yet, `jobs` at a time, each in a
/// process of its own, round by round through all variants, and saves each as it ends. Killed at
/// any moment it loses the rounds in hand and nothing else; run again it goes on. On a stop no
/// round begins, those in hand have `grace_s` to end, the rest are dropped. A round that throws or
/// crashes becomes a row that says so (outcome "fault"); one whose process was killed from outside
/// runs once more first. Keeps FOLDER/status/ up to date. Throws Error(kCannotCreate) for a folder
/// of another campaign, Error(kInterrupted) when another process has the shard, and the machine's
/// errors that rounds met (Error(kIo) when the disk is full) with everything before them saved. One
/// thread.
CampaignRun RunCampaign(const Campaign& campaign, const RoundFunction& run,
                        const CampaignRunOptions& options);

}  // namespace tubetwin
