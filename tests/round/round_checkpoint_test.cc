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

RoundResult Run(const Scenario& scenario, const std::string& out) {
  RoundOptions options;
  options.out_folder = out;
  options.parallelism = Parallelism{1};
  options.keep = RoundKeep::kRows;
  return RunRound(scenario, options);
}

}  // namespace

TEST_CASE("a round that goes on from a stored moment is the uninterrupted round, bit by bit") {
  const TemporaryFolder folder;
  const RoundResult whole = Run(Tangled(), folder / "whole");
  REQUIRE_FALSE(whole.rows.empty());
  REQUIRE(whole.rows[0]["detection"]["outcome"] == "several");
  REQUIRE(whole.rows[0]["truth"]["held"] == 2);
  CHECK_FALSE(fs::exists(folder / "whole/held.pile.json"));

  Scenario until = Tangled();
  until.cycle.end_at_several = true;
  const RoundResult stored = Run(until, folder / "stored");
  CHECK(stored.rows.empty());
  CHECK(stored.summary["end_reason"] == "stored");

  Scenario from;
  from.pile.file = folder / "stored/held.pile.json";
  const RoundResult rest = Run(from, folder / "rest");
  REQUIRE(rest.rows.size() == 1);
  CHECK(rest.rows[0] == whole.rows[0]);  // Every digit: forces, times, what truth says.

  // The archived start goes on the same wherever the folder is.
  Scenario archived;
  archived.pile.file = folder / "rest/given.pile.json";
  CHECK(Run(archived, folder / "again").rows[0] == rest.rows[0]);

  // Only what comes after the moment depends on the strategy.
  from.resolution.strategy = "none";
  const RoundResult none = Run(from, folder / "none");
  CHECK(none.rows[0]["detection"] == whole.rows[0]["detection"]);
  CHECK(none.rows[0]["resolution"]["used"] == false);
  CHECK(none.rows[0]["outcome"] == "put_back");

  // Another cell's state is refused, not forced in.
  from.physics.randomize = false;
  CHECK_THROWS_WITH(Run(from, folder / "other"), Contains("belongs to another cell"));
}

}  // namespace tubetwin
