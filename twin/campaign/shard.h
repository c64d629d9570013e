#pragma once

#include <functional>
#include <optional>
#include <string>

namespace tubetwin {

/// Part `index` of a campaign that is split into `count`: rounds r with r mod count = index, of all
/// variants. Counts from 0.
struct Shard {
  int index = 0;
  int count = 1;
  bool Owns(int round) const { return round % count == index; }
  std::string Name() const;  ///< "3/17"
  friend bool operator==(const Shard&, const Shard&) = default;
};

/// "3/17". Throws Error(kUsage) for anything else and for an index that is not below the count.
Shard ParseShard(const std::string& text);

/// The shard that this process is to run: `shard` ("i/n", empty when not given), else the index
/// that a scheduler gave (SLURM_ARRAY_TASK_ID, JOB_COMPLETION_INDEX, both from 0 or, for Slurm,
/// from the array's first task; PARALLEL_SEQ from 1) of `shards` parts, or of Slurm's own count;
/// else the whole. PARALLEL_SEQ counts jobs in the order in which they start, so it is heeded only
/// with `shards` or when nothing else is given. Throws Error(kUsage) when sources contradict each
/// other, when a count is missing or an index is not below it, naming the variables. `environment`:
/// getenv, or a test's.
Shard ChooseShard(const std::string& shard, std::optional<int> shards,
                  const std::function<const char*(const char*)>& environment);

}  // namespace tubetwin
