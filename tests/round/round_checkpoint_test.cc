// Rounds that go on from a stored moment in which several tubes hang in the fingers.

#include "twin/round/round_checkpoint.h"

#include <filesystem>

#include "models/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/round/round.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

/// Found by trying: its first attempt lifts both tubes, and one is shaken off or not.
constexpr std::int64_t kTangledSeed = 5046900498176052;

Scenario Tangled() {
  Scenario scenario;
  scenario.seed = kTangledSeed;
  scenario.pile.part = "hose_b";
  scenario.pile.count = 2;
  scenario.pile.arrangement = "threaded";
  scenario.planner.exclude_free = true;
  scenario.planner.samples = 1;
  scenario.planner.separated = 0;  // A tip would take one alone.
  return scenario;
}

RoundRecord Run(const Scenario& scenario, const std::string& out) {
  RoundOptions options;
  options.out_folder = out;
  options.parallelism = Parallelism{1};
  options.keep = RoundKeep::kRows;
  return RunRound(scenario, options).record;
}

/// The first attempt, every digit of it.
Json Row(const RoundRecord& record) { return ToJson(record.attempts.at(0), RowPlace()); }

}  // namespace

TEST_CASE("a round that goes on from a stored moment is the uninterrupted round, bit by bit") {
  const TemporaryFolder folder;
  const RoundRecord whole = Run(Tangled(), folder / "whole");
  REQUIRE_FALSE(whole.attempts.empty());
  REQUIRE(whole.attempts[0].detection->outcome == HeldOutcome::kSeveral);
  REQUIRE(whole.attempts[0].truth->held == 2);
  CHECK_FALSE(fs::exists(folder / "whole/held.pile.json"));

  Scenario until = Tangled();
  until.cycle.end_at_several = true;
  const RoundRecord stored = Run(until, folder / "stored");
  CHECK(stored.attempts.empty());
  CHECK(stored.summary.end == RoundEnd::kStored);

  Scenario from;
  from.pile.file = folder / "stored/held.pile.json";
  const RoundRecord rest = Run(from, folder / "rest");
  REQUIRE(rest.attempts.size() == 1);
  CHECK(Row(rest) == Row(whole));  // Every digit: forces, times, what truth says.

  // The archived start goes on the same wherever the folder is.
  Scenario archived;
  archived.pile.file = folder / "rest/given.pile.json";
  CHECK(Row(Run(archived, folder / "again")) == Row(rest));

  // Only what comes after the moment depends on the strategy.
  from.resolution.strategy = "none";
  const RoundRecord none = Run(from, folder / "none");
  CHECK(Row(none)["detection"] == Row(whole)["detection"]);
  CHECK_FALSE(none.attempts[0].resolution_used);
  CHECK(none.attempts[0].outcome == AttemptOutcome::kPutBack);

  // Another cell's state is refused, not forced in.
  from.physics.randomize = false;
  CHECK_THROWS_WITH(Run(from, folder / "other"), Contains("belongs to another cell"));
}

}  // namespace tubetwin
