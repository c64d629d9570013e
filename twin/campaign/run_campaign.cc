#include "twin/campaign/run_campaign.h"

#include <poll.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <memory>
#include <set>

#include "models/base/files.h"
#include "models/base/json.h"
#include "models/base/step_timer.h"
#include "twin/campaign/campaign_round.h"
#include "twin/campaign/campaign_status.h"
#include "twin/campaign/record_line.h"
#include "twin/campaign/shard_file.h"

namespace tubetwin {
namespace {

constexpr int kPollMilliseconds = 200;  // How late a stop is noticed at most.
constexpr double kStatusEvery_s = 10.0;
constexpr int kTriesWhenKilled = 2;

class ShardRunner {
 public:
  ShardRunner(const Campaign& campaign, const RoundFunction& run, const CampaignRunOptions& options)
      : campaign_(campaign), run_(run), options_(options), began_s_(WallClock_s()) {
    const CampaignIdentity identity = IdentityOf(campaign, options.program_version);
    ClaimCampaignFolder(options.out_folder, identity);
    std::vector<std::string> notes;
    writer_ = std::make_unique<ShardWriter>(options.out_folder, options.shard,
                                            identity.fingerprint(), notes);
    for (const std::string& note : notes) Notice(note);
    CollectTasks();
  }

  CampaignRun Run() {
    WriteStatus("running");
    try {
      Loop();
    } catch (...) {
      workers_.clear();
      TryWriteStatus("failed");
      throw;
    }
    CampaignRun result;
    const bool whole = progress_.done == progress_.total;
    result.end = whole      ? CampaignEnd::kDone
                 : stopped_ ? CampaignEnd::kStopped
                            : CampaignEnd::kTimeLimit;
    WriteStatus(whole ? "done" : "stopped");
    result.progress = progress_;
    return result;
  }

 private:
  void Notice(const std::string& line) {
    if (options_.notice) options_.notice(line);
  }

  /// What is left to do: every round of the shard that was not found, all variants of a round
  /// together so that a campaign that ends early still compares like with like.
  void CollectTasks() {
    std::set<std::pair<int, int>> found;
    const int variants = static_cast<int>(campaign_.variants.size());
    progress_.variants = variants;
    progress_.work.resize(campaign_.variants.size());
    for (const RoundRecord& record : writer_->found()) {
      if (record.variant >= variants || record.round >= campaign_.rounds ||
          record.seed != RoundSeed(campaign_.seed, record.round)) {
        throw Error(ErrorKind::kBadData,
                    options_.out_folder + ": " + NameOf(record) + " is no round of this campaign");
      }
      found.emplace(record.round, record.variant);
      Count(record);
    }
    progress_.shard = options_.shard;
    for (int round = options_.shard.index; round < campaign_.rounds;
         round += options_.shard.count) {
      for (int variant = 0; variant < variants; ++variant) {
        ++progress_.total;
        if (found.count({round, variant}) == 0) {
          tasks_.push_back({{variant, round, RoundSeed(campaign_.seed, round), false}, 0});
        }
      }
    }
    found_ = progress_.done;
  }

  void Count(const RoundRecord& record) {
    ++progress_.done;
    for (const AttemptRecord& attempt : record.attempts) {
      ++progress_.attempts;
      progress_.successes += attempt.success == true ? 1 : 0;
    }
    progress_.faults += record.summary.crashed() ? 1 : 0;
    const auto work = WorkOf(FactsOf(record), HourOf::kCellAndComputing);
    if (!work) return;
    RoundWork& sum = progress_.work[static_cast<std::size_t>(record.variant)];
    sum.placed += work->placed;
    sum.cell_s += work->cell_s;
    sum.compute_s += work->compute_s;
  }

  bool MayBegin() {
    if (!stopped_ && options_.stop_requested && options_.stop_requested()) {
      stopped_ = true;
      grace_ends_s_ = WallClock_s() + options_.grace_s;
      Notice(workers_.empty()
                 ? "stopping"
                 : "stopping; the rounds in hand have " +
                       std::to_string(static_cast<int>(options_.grace_s)) + " s to end");
    }
    return !stopped_ && !refused_ &&
           !(options_.limit_s && WallClock_s() - began_s_ >= *options_.limit_s);
  }

  void Begin(std::pair<RoundTask, int> next) {
    RoundTask& task = next.first;
    writer_->RequireInPlace();  // Else it would make its folder anew, for rows that are lost.
    task.keep_failure = KeptFailures(options_.out_folder, options_.shard) < campaign_.keep.failures;
    workers_.push_back(
        {std::make_unique<RoundWorker>(task, run_, [this] { writer_->CloseInChild(); }),
         next.second + 1});
  }

  void Loop() {
    for (;;) {
      while (MayBegin() && !tasks_.empty() && static_cast<int>(workers_.size()) < options_.jobs) {
        const auto next = tasks_.front();
        tasks_.pop_front();
        Begin(next);
      }
      if (workers_.empty()) break;
      Wait();
      ReadWorkers();
      if (stopped_ && WallClock_s() >= grace_ends_s_ && !workers_.empty()) {
        Notice(std::to_string(workers_.size()) + " rounds in hand did not end in time, dropped");
        workers_.clear();
      }
      Tell();
    }
    if (refused_) throw *refused_;
  }

  void Wait() {
    std::vector<pollfd> fds;
    for (const Worker& worker : workers_) fds.push_back({worker.process->fd(), POLLIN, 0});
    ::poll(fds.data(), fds.size(), kPollMilliseconds);  // A signal ends it early, that is all.
  }

  struct Worker {
    std::unique_ptr<RoundWorker> process;
    int tries = 1;
  };

  void ReadWorkers() {
    for (Worker& worker : workers_) {
      if (auto result = worker.process->Read()) Take(worker, *result);
      if (worker.process->ended()) {
        progress_.peak_memory_kB =
            std::max(progress_.peak_memory_kB, worker.process->peak_memory_kB());
        if (!worker.process->note().empty()) {
          Notice(NameOf(worker.process->task()) + ": " + worker.process->note());
        }
      }
    }
    std::erase_if(workers_, [](const Worker& worker) { return worker.process->ended(); });
  }

  static std::string NameOf(const RoundTask& task) {
    RoundRecord named;
    named.variant = task.variant;
    named.round = task.round;
    return tubetwin::NameOf(named);
  }
  static std::string NameOf(const RoundRecord& record) { return tubetwin::NameOf(record); }

  void Take(const Worker& worker, RoundWorker::Result& result) {
    using Kind = RoundWorker::Result::Kind;
    const RoundTask& task = worker.process->task();
    if (result.kind == Kind::kRefused) {
      if (!refused_) refused_ = result.error;
      return;
    }
    if (result.kind == Kind::kKilled && worker.tries < kTriesWhenKilled) {
      Notice(NameOf(task) + ": " + result.reason + "; it runs once more");
      tasks_.push_front({task, worker.tries});
      return;
    }
    RoundRecord record;
    if (result.kind == Kind::kRows) {
      record = std::move(result.output.record);
    } else {
      const std::string reason =
          (result.kind == Kind::kThrown ? "the round failed: " : "the round crashed: ") +
          result.reason;
      Notice(NameOf(task) + ": " + reason);
      record.variant = task.variant;
      record.round = task.round;
      record.seed = task.seed;
      SetCrashed(campaign_.variants[task.variant].tubes, reason, worker.process->seconds(), record);
    }
    writer_->Append(record);
    Count(record);
    const double elapsed_s = WallClock_s() - began_s_;
    progress_.rounds_per_hour = 3600.0 * (progress_.done - found_) / elapsed_s;
    tell_next_s_ = 0.0;
  }

  void Tell() {
    const double now = WallClock_s();
    progress_.running = static_cast<int>(workers_.size());
    progress_.seconds_left = std::nullopt;
    if (progress_.rounds_per_hour > 0.0) {
      progress_.seconds_left =
          3600.0 * (progress_.total - progress_.done) / progress_.rounds_per_hour;
    }
    if (options_.progress && now >= tell_next_s_) {
      options_.progress(progress_);
      tell_next_s_ = now + 0.5;
    }
    if (now >= status_next_s_) WriteStatus("running");
  }

  void WriteStatus(const std::string& state) {
    progress_.running = static_cast<int>(workers_.size());
    writer_->RequireInPlace();
    WriteShardStatus(options_.out_folder, progress_, state);
    status_next_s_ = WallClock_s() + kStatusEvery_s;
  }

  void TryWriteStatus(const std::string& state) {
    try {
      WriteStatus(state);
    } catch (const Error&) {  // Full disk, no folder: the error on its way says why.
    }
  }

  const Campaign& campaign_;
  const RoundFunction& run_;
  const CampaignRunOptions& options_;
  const double began_s_;
  std::unique_ptr<ShardWriter> writer_;
  std::deque<std::pair<RoundTask, int>> tasks_;  ///< With how often each was tried.
  std::vector<Worker> workers_;
  ShardProgress progress_;
  int found_ = 0;  ///< Rounds that were done before.
  bool stopped_ = false;
  double grace_ends_s_ = 0.0, tell_next_s_ = 0.0, status_next_s_ = 0.0;
  std::optional<Error> refused_;
};

}  // namespace

CampaignRun RunCampaign(const Campaign& campaign, const RoundFunction& run,
                        const CampaignRunOptions& options) {
  TT_CHECK(options.jobs >= 1);
  return ShardRunner(campaign, run, options).Run();
}

}  // namespace tubetwin
