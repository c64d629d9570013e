#pragma once

#include "twin/app/common.h"
#include "twin/campaign/run_campaign.h"

namespace tubetwin {

/// Runs a campaign's shard, telling on stderr how it goes; SIGTERM and SIGINT end it cleanly.
/// options.jobs 0: all cores; --threads is per round (default 1). Fills in the program's version,
/// stop, progress and notices. Returns 0 when done, 75 when there is more to do.
int RunCampaignWithProgress(const Campaign& campaign, CampaignRunOptions options,
                            const Common& common);

}  // namespace tubetwin
