#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/base/json_fwd.h"
#include "twin/campaign/run_campaign.h"

namespace tubetwin {

/// Writes FOLDER/status/shard-*.json: where a shard is, by whom and when. `state`: "running",
/// "stopped", "done", "failed".
void WriteShardStatus(const std::string& folder, const ShardProgress& progress,
                      const std::string& state);

/// One line for a terminal: rounds, rate, time left, parts an hour of each variant, success with
/// its interval.
std::string ProgressText(const ShardProgress& progress);

/// Seconds as "45 s", "12 min", "3.4 h", "2.1 d".
std::string DurationText(double seconds);

/// Where a whole campaign is, from its folder alone.
struct CampaignStatus {
  int rounds = 0;    ///< Of all variants, each variant's counted on its own.
  int variants = 1;  ///< So many share them evenly.
  int done = 0;      ///< Saved, in all shards of the folder.
  int faults = 0;
  int successes = 0, attempts = 0;
  int shards = 0;  ///< That the campaign is split into; 0 before the first began.
  struct ShardLine {
    std::string name;   ///< "3/17"
    std::string state;  ///< As written, "silent" when running but long unheard of, "" when unknown.
    std::string where;  ///< "process 12 on host"
    int done = 0, total = 0;
    double rounds_per_hour = 0.0;  ///< 0 unless running.
    double age_s = 0.0;            ///< Since its last sign of life.
  };
  std::vector<ShardLine> lines;  ///< Of the shards that have begun.
  /// Of each variant with rounds done: its name, and parts an hour with computing time.
  std::vector<std::pair<std::string, PartsPerHour>> parts_per_hour;
  double rounds_per_hour = 0.0;  ///< Of all that run.
  std::optional<double> seconds_left;
  std::vector<std::string> problems;  ///< Damaged lines; their rounds count as not done.
};

/// Throws Error(kMissing) when the folder is no campaign's.
CampaignStatus ReadCampaignStatus(const std::string& folder);
Json ToJson(const CampaignStatus& status);
std::string ToText(const CampaignStatus& status);

}  // namespace tubetwin
