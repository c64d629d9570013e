#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "models/base/parallel.h"
#include "twin/campaign/campaign.h"
#include "twin/campaign/round_worker.h"
#include "twin/campaign/shard.h"

namespace tubetwin {

/// How many rounds of a shard stand in FOLDER/failures.
int KeptFailures(const std::string& folder, const Shard& shard);

/// Whether round `round` is one of the stated sample; the same rounds whatever the shards.
bool IsSampled(const Campaign& campaign, int round);

/// Name of the folder of a kept round: "variant-00-round-000005".
std::string RoundFolderName(int variant, int round);
/// Variant and round of such a name, or of "arm-00-round-000005" as earlier versions wrote; nothing
/// for any other name.
std::optional<std::pair<int, int>> RoundOfFolderName(const std::string& name);

struct CampaignRoundOptions {
  std::string out_folder;  ///< Of the campaign.
  Parallelism parallelism;
  std::string program_version;
  /// As RoundOptions': makes the page of a kept round's folder, anew when films were drawn.
  std::function<void(const std::string& folder)> write_report;
};

/// Runs one round of a campaign with RunRound(). Its result folder stays as failures/NAME when an
/// attempt failed and the task says so, as samples/NAME when it is sampled, else nothing stays. A
/// kept folder holds start pile, recording, report and config.resolved.toml (`tubetwin run` of it
/// repeats the round), and for each failed attempt its state, clouds and film; a sampled round's
/// film shows it whole. Films are drawn when the rows are safe; without EGL there is none, and the
/// note says so. Throws as RunRound() does.
RoundOutput RunCampaignRound(const Campaign& campaign, const RoundTask& task,
                             const CampaignRoundOptions& options);

}  // namespace tubetwin
