#pragma once

#include <functional>
#include <optional>
#include <string>

#include "models/base/error.h"
#include "twin/round/records/round_record.h"

namespace tubetwin {

/// One round to run.
struct RoundTask {
  int variant = 0;
  int round = 0;
  std::int64_t seed = 0;
  bool keep_failure = false;  ///< Keep its folder when an attempt fails.
};

/// What a round function gives back.
struct RoundOutput {
  RoundRecord record;  ///< Its variant, round and seed are the task's, whatever stands here.
  /// What may still be done when the rows are safe (films); empty: nothing. Returns what a person
  /// should know of it, or nothing.
  std::function<std::string()> afterwards;
};

/// Runs one round in a process of its own. Anything it throws but what speaks of the machine
/// (folders, disk, devices, configuration) becomes the round's result.
using RoundFunction = std::function<RoundOutput(const RoundTask&)>;

/// A child process that runs one round and sends back what came of it: a crash takes only that
/// round with it, and memory cannot grow from round to round. The child ignores SIGINT, SIGTERM and
/// SIGHUP (the parent decides) and is killed by the system when the parent dies. Fork from a
/// process with one thread only.
class RoundWorker {
 public:
  /// `in_child` runs first in the child (closing what the parent holds).
  RoundWorker(const RoundTask& task, const RoundFunction& run,
              const std::function<void()>& in_child);
  /// Kills the child if it still runs.
  ~RoundWorker();
  RoundWorker(const RoundWorker&) = delete;
  RoundWorker& operator=(const RoundWorker&) = delete;

  const RoundTask& task() const { return task_; }
  int fd() const { return fd_; }  ///< Becomes readable when Read() has something to do.

  /// What a round came to.
  struct Result {
    enum class Kind {
      kRows,     ///< The round ran to its end.
      kThrown,   ///< It threw: `reason`.
      kCrashed,  ///< Its process died of itself (segmentation fault, abort): `reason`.
      kKilled,   ///< Its process was killed from outside (SIGKILL, out of memory): `reason`.
      kRefused,  ///< The machine does not let it run (disk, folder, device): `error`.
    };
    Kind kind = Kind::kRows;
    RoundOutput output;
    std::string reason;
    std::optional<Error> error;
  };
  /// Takes what the child has sent; the result once it is whole, the first time it is.
  std::optional<Result> Read();
  /// The child has ended and its result was taken.
  bool ended() const { return ended_; }
  /// What the child had to say afterwards, for people; empty: nothing.
  const std::string& note() const { return note_; }
  double seconds() const;                                  ///< Since it began.
  long peak_memory_kB() const { return peak_memory_kB_; }  ///< Of an ended child.

 private:
  std::optional<Result> TakeLine();
  Result FromExit(int status) const;

  RoundTask task_;
  int pid_ = -1;
  int fd_ = -1;
  double began_s_ = 0.0;
  std::string buffer_;
  std::string note_;
  bool has_result_ = false;
  bool ended_ = false;
  long peak_memory_kB_ = 0;
};

}  // namespace tubetwin
