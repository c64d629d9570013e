#pragma once

#include <string>

#include "twin/live/dry_run.h"
#include "twin/report/dry_run_page.h"
#include "twin/round/round.h"

namespace tubetwin {

/// A rehearsal of one attempt on `real`, connected to look only: runs it, writes dry_run.json and
/// the page report.html into the result folder. Throws as RunCellRound() does.
struct DryRun {
  RoundResult round;
  DryRunStory story;
  DryRunReport report;
};
DryRun RunDry(Cell& real, const Scenario& scenario, RoundOptions options);

}  // namespace tubetwin
