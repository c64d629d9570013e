#include "twin/campaign/shard.h"

#include <map>

#include "models/base/error.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;
using Variables = std::map<std::string, std::string>;

Shard Choose(const std::string& shard, std::optional<int> shards, const Variables& variables) {
  return ChooseShard(shard, shards, [&](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  });
}

void CheckChoiceRefused(const std::string& shard, std::optional<int> shards,
                        const Variables& variables, const std::string& said) {
  INFO(said);
  try {
    Choose(shard, shards, variables);
    FAIL("not refused");
  } catch (const Error& e) {
    CHECK(e.kind() == ErrorKind::kUsage);
    CHECK_THAT(e.what(), Contains(said));
  }
}

}  // namespace

TEST_CASE("shards count from 0 and every round belongs to exactly one") {
  for (int round = 0; round < 100; ++round) {
    int owners = 0;
    for (int i = 0; i < 17; ++i) owners += Shard{i, 17}.Owns(round) ? 1 : 0;
    CHECK(owners == 1);
  }
  CHECK(Shard{3, 17}.Owns(20));
  CHECK(ParseShard("3/17") == Shard{3, 17});
}

TEST_CASE("a shard that does not exist is refused with what there is") {
  CheckChoiceRefused("5/4", {}, {}, "the last of 4 is 3/4");
  CheckChoiceRefused("4/4", {}, {}, "the last of 4 is 3/4");
  CheckChoiceRefused("0/0", {}, {}, "i/n is needed");
  CheckChoiceRefused("-1/4", {}, {}, "i/n is needed");
  CheckChoiceRefused("1", {}, {}, "i/n is needed");
  CheckChoiceRefused("1/4x", {}, {}, "i/n is needed");
  CheckChoiceRefused("", 0, {}, "--shards 0");
}

TEST_CASE("the shard comes from the option, else from a scheduler, else it is the whole") {
  CHECK(Choose("", {}, {}) == Shard{0, 1});
  CHECK(Choose("", 1, {}) == Shard{0, 1});
  CHECK(Choose("2/5", {}, {}) == Shard{2, 5});
  CHECK(Choose("2/5", 5, {}) == Shard{2, 5});
  CHECK(Choose("", {}, {{"SLURM_ARRAY_TASK_ID", "3"}, {"SLURM_ARRAY_TASK_COUNT", "4"}}) ==
        Shard{3, 4});
  CHECK(Choose("", {},
               {{"SLURM_ARRAY_TASK_ID", "4"},
                {"SLURM_ARRAY_TASK_COUNT", "4"},
                {"SLURM_ARRAY_TASK_MIN", "1"}}) == Shard{3, 4});
  CHECK(Choose("", 17, {{"SLURM_ARRAY_TASK_ID", "5"}, {"SLURM_ARRAY_TASK_COUNT", "2"}}) ==
        Shard{5, 17});
  CHECK(Choose("", 6, {{"JOB_COMPLETION_INDEX", "0"}}) == Shard{0, 6});
  CHECK(Choose("", 6, {{"PARALLEL_SEQ", "6"}}) == Shard{5, 6});
  // GNU parallel may start shards in any order: its count of jobs says nothing of --shard {}/17.
  CHECK(Choose("9/17", {}, {{"PARALLEL_SEQ", "2"}}) == Shard{9, 17});
}

TEST_CASE("sources that contradict each other are an error that names both") {
  CheckChoiceRefused("1/4", {}, {{"SLURM_ARRAY_TASK_ID", "3"}, {"SLURM_ARRAY_TASK_COUNT", "4"}},
                     "--shard 1/4 contradicts SLURM_ARRAY_TASK_ID=3");
  CheckChoiceRefused("3/5", {}, {{"SLURM_ARRAY_TASK_ID", "3"}, {"SLURM_ARRAY_TASK_COUNT", "4"}},
                     "4 shards or 5");
  CheckChoiceRefused("1/4", {}, {{"JOB_COMPLETION_INDEX", "2"}}, "JOB_COMPLETION_INDEX=2");
  CheckChoiceRefused("1/4", 4, {{"PARALLEL_SEQ", "1"}}, "PARALLEL_SEQ=1");
  CheckChoiceRefused("1/4", 5, {}, "4 shards or 5");
  CheckChoiceRefused("", 4, {{"PARALLEL_SEQ", "2"}, {"JOB_COMPLETION_INDEX", "2"}}, "contradicts");
}

TEST_CASE("a scheduler's index without a count, beyond it, or no number is an error") {
  CheckChoiceRefused("", {}, {{"PARALLEL_SEQ", "2"}}, "give --shards n");
  CheckChoiceRefused("", {}, {{"JOB_COMPLETION_INDEX", "2"}}, "give --shards n");
  CheckChoiceRefused("", {}, {{"SLURM_ARRAY_TASK_ID", "2"}}, "give --shards n");
  CheckChoiceRefused("", 4, {}, "which of them");
  CheckChoiceRefused("", 4, {{"JOB_COMPLETION_INDEX", "4"}}, "no such shard of 4");
  CheckChoiceRefused("", 4, {{"PARALLEL_SEQ", "0"}}, "no such shard of 4");
  CheckChoiceRefused("", 4, {{"PARALLEL_SEQ", "two"}}, "PARALLEL_SEQ=two");
  CheckChoiceRefused("", {},
                     {{"SLURM_ARRAY_TASK_ID", "9"},
                      {"SLURM_ARRAY_TASK_COUNT", "2"},
                      {"SLURM_ARRAY_TASK_MIN", "3"}},
                     "the array has gaps");
}

}  // namespace tubetwin
