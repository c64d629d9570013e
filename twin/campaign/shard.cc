#include "twin/campaign/shard.h"

#include <charconv>
#include <vector>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr int kMostShards = 1000000;

[[noreturn]] void Fail(const std::string& problem) { throw Error(ErrorKind::kUsage, problem); }

std::optional<int> WholeNumber(const std::string& text) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stopped != end || value < 0) return std::nullopt;
  return value;
}

/// What one source says; a count of 0: it does not say.
struct Claim {
  std::string source;  ///< "--shard 3/17", "PARALLEL_SEQ=4"
  int index = 0;
  int count = 0;
};

class Environment {
 public:
  explicit Environment(const std::function<const char*(const char*)>& get) : get_(get) {}

  std::optional<int> Number(const char* name) const {
    const char* text = get_(name);
    if (text == nullptr || *text == '\0') return std::nullopt;
    const auto value = WholeNumber(text);
    if (!value) {
      Fail(std::string(name) + "=" + text + ": a whole number from 0 is needed; give --shard i/n");
    }
    return value;
  }

 private:
  const std::function<const char*(const char*)>& get_;
};

std::optional<Claim> SlurmClaim(const Environment& environment, bool count_given) {
  const auto id = environment.Number("SLURM_ARRAY_TASK_ID");
  if (!id) return std::nullopt;
  Claim claim{"SLURM_ARRAY_TASK_ID=" + std::to_string(*id), *id, 0};
  if (count_given) return claim;  // Part of an array may be run again: its own count is no help.
  const auto count = environment.Number("SLURM_ARRAY_TASK_COUNT");
  if (!count) return claim;
  const int first = environment.Number("SLURM_ARRAY_TASK_MIN").value_or(0);
  claim.source += " of SLURM_ARRAY_TASK_COUNT=" + std::to_string(*count);
  if (first > 0) claim.source += " from SLURM_ARRAY_TASK_MIN=" + std::to_string(first);
  claim.index = *id - first;
  claim.count = *count;
  if (claim.index < 0 || claim.index >= claim.count) {
    Fail(claim.source + ": the array has gaps; say how many shards there are in all: --shards n");
  }
  return claim;
}

}  // namespace

std::string Shard::Name() const { return std::to_string(index) + "/" + std::to_string(count); }

Shard ParseShard(const std::string& text) {
  const auto slash = text.find('/');
  const auto index = WholeNumber(text.substr(0, slash));
  const auto count =
      slash == std::string::npos ? std::nullopt : WholeNumber(text.substr(slash + 1));
  if (!index || !count || *count < 1 || *count > kMostShards) {
    Fail("--shard '" + text + "': i/n is needed, for example 0/4; shards count from 0");
  }
  if (*index >= *count) {
    Fail("--shard " + text + ": there is no shard " + std::to_string(*index) +
         "; shards count from 0, the last of " + std::to_string(*count) + " is " +
         std::to_string(*count - 1) + "/" + std::to_string(*count));
  }
  return {*index, *count};
}

Shard ChooseShard(const std::string& shard, std::optional<int> shards,
                  const std::function<const char*(const char*)>& get) {
  const Environment environment(get);
  if (shards && (*shards < 1 || *shards > kMostShards)) {
    Fail("--shards " + std::to_string(*shards) + ": 1 to " + std::to_string(kMostShards) +
         " are allowed");
  }
  std::vector<Claim> claims;
  if (!shard.empty()) {
    const Shard given = ParseShard(shard);
    claims.push_back({"--shard " + shard, given.index, given.count});
  }
  if (const auto slurm = SlurmClaim(environment, shards.has_value())) claims.push_back(*slurm);
  if (const auto index = environment.Number("JOB_COMPLETION_INDEX")) {
    claims.push_back({"JOB_COMPLETION_INDEX=" + std::to_string(*index), *index, 0});
  }
  const auto sequence = environment.Number("PARALLEL_SEQ");
  if (sequence && (shards || claims.empty())) {
    claims.push_back({"PARALLEL_SEQ=" + std::to_string(*sequence), *sequence - 1, 0});
  }
  if (claims.empty()) {
    if (shards && *shards != 1) {
      Fail("--shards " + std::to_string(*shards) +
           ": which of them? Give --shard i/n, or run it as an array (SLURM_ARRAY_TASK_ID, "
           "JOB_COMPLETION_INDEX, PARALLEL_SEQ)");
    }
    return {};
  }
  Claim chosen{"", claims.front().index, shards.value_or(0)};
  for (const Claim& claim : claims) {
    if (claim.index != chosen.index) {
      Fail(claims.front().source + " contradicts " + claim.source + ": shard " +
           std::to_string(chosen.index) + " or " + std::to_string(claim.index) + "?");
    }
    if (chosen.count == 0) chosen.count = claim.count;
    if (claim.count != 0 && claim.count != chosen.count) {
      Fail(claim.source + " contradicts " +
           (shards ? "--shards " + std::to_string(*shards) : claims.front().source) + ": " +
           std::to_string(claim.count) + " shards or " + std::to_string(chosen.count) + "?");
    }
  }
  if (chosen.count == 0) {
    Fail(claims.front().source +
         " is set but not of how many; give --shards n (or --shard 0/1 for the whole campaign)");
  }
  if (chosen.index < 0 || chosen.index >= chosen.count) {
    Fail(claims.front().source + ": there is no such shard of " + std::to_string(chosen.count) +
         "; the first is 0" + (sequence ? " (PARALLEL_SEQ 1)" : ""));
  }
  return {chosen.index, chosen.count};
}

}  // namespace tubetwin
