#include "twin/app/campaign_progress.h"

#include <algorithm>
#include <chrono>

#include "models/base/error.h"
#include "twin/campaign/campaign_round.h"
#include "twin/campaign/campaign_status.h"
#include "twin/report/write_report.h"

namespace tubetwin {
namespace {

/// Tells of a running shard: in place on a terminal, else a line now and then.
class Teller {
 public:
  explicit Teller(const Common& common) : common_(common), line_(!common.quiet) {}
  void Progress(const ShardProgress& progress) {
    line_.Show(ProgressText(progress));
    if (line_.enabled() || progress.done == told_) return;
    const auto now = std::chrono::steady_clock::now();
    if (told_ >= 0 && now - told_at_ < std::chrono::seconds(30)) return;
    Say(common_, ProgressText(progress));
    told_ = progress.done;
    told_at_ = now;
  }
  void Notice(const std::string& text) {
    line_.Clear();
    Complain(text);
  }

 private:
  const Common& common_;
  ProgressLine line_;
  int told_ = -1;
  std::chrono::steady_clock::time_point told_at_;
};

}  // namespace

int RunCampaignWithProgress(const Campaign& campaign, CampaignRunOptions options,
                            const Common& common) {
  if (options.jobs <= 0) options.jobs = Parallelism::All().threads;
  options.program_version = TUBETWIN_VERSION;
  options.stop_requested = StopOnSignals();
  CampaignRun run;
  {
    Teller teller(common);
    options.progress = [&](const ShardProgress& progress) { teller.Progress(progress); };
    options.notice = [&](const std::string& text) { teller.Notice(text); };
    const CampaignRoundOptions round{options.out_folder, Parallelism{std::max(1, common.threads)},
                                     TUBETWIN_VERSION, [](const std::string& folder) {
                                       WriteRoundReport(folder, folder + "/report.html",
                                                        /*computing_times=*/false);
                                     }};
    run = RunCampaign(
        campaign, [&](const RoundTask& task) { return RunCampaignRound(campaign, task, round); },
        options);
  }
  Say(common, ProgressText(run.progress));
  if (run.end == CampaignEnd::kDone) return 0;
  Complain(std::string(run.end == CampaignEnd::kStopped ? "stopped" : "the time is up") + " with " +
           std::to_string(run.progress.done) + " of " + std::to_string(run.progress.total) +
           " rounds saved; run again to go on");
  return static_cast<int>(ErrorKind::kInterrupted);
}

}  // namespace tubetwin
