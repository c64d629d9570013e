// Rounds with a straight tube that lies along a wall, where no finger fits beside it.

#include "models/base/error.h"
#include "models/base/files.h"
#include "scenes/pile.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tube_scenes.h"
#include "twin/round/round.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

constexpr double kGap_m = 0.0003;  ///< Between tube and wall at the start.
/// The fingers lean on a tube with the force that ends the way down and what the arm needs to stop.
constexpr double kMostPress_N = 20.0;

/// One straight `pvc_a`, its axis from `from_N` to `to_N`.
void SaveStraightTube(const Vector3& from_N, const Vector3& to_N, const std::string& file) {
  Pile pile;
  pile.part = LoadPart("pvc_a");
  PileTube tube;
  tube.id = 1;
  tube.radius_m = pile.part.radius_m;
  tube.mass_kg = pile.part.mass_kg;
  tube.centerline_N = StraightLine(from_N, to_N);
  pile.tubes = {tube};
  SavePile(pile, file);
}

RoundRecord Run(const std::string& pile, int nudges, const std::string& out) {
  Scenario scenario;
  scenario.pile.file = pile;
  scenario.planner.nudges = nudges;
  RoundOptions options;
  options.out_folder = out;
  options.parallelism = Parallelism{1};
  options.keep = RoundKeep::kRows;
  return RunRound(scenario, options).record;
}

TEST_CASE("a tube along a wall is left with no nudges and placed after one") {
  const TemporaryFolder folder;
  const double r = LoadPart("pvc_a").radius_m, y = 0.29 - r - kGap_m;
  SaveStraightTube({-0.22, y, r}, {0.28, y, r}, folder / "pile.json");

  const RoundRecord without = Run(folder / "pile.json", 0, folder / "without");
  REQUIRE(without.attempts.size() == 1);
  CHECK(without.attempts[0].outcome == AttemptOutcome::kNoPlan);
  CHECK(without.attempts[0].nudges.empty());
  CHECK(without.summary.placed == 0);
  CHECK(without.summary.end == RoundEnd::kNoPlan);
  CHECK_THAT(without.summary.end_detail, Contains("bin's wall"));

  const RoundRecord with = Run(folder / "pile.json", 2, folder / "with");
  CHECK(with.summary.placed == 1);
  CHECK(with.summary.end == RoundEnd::kEmpty);
  REQUIRE(with.attempts.size() == 1);
  CHECK(with.attempts[0].outcome == AttemptOutcome::kPlaced);
  CHECK(with.attempts[0].success == true);
  REQUIRE(with.attempts[0].nudges.size() == 1);
  const NudgeReport& nudge = with.attempts[0].nudges[0];
  CHECK(nudge.direction_N.y() == Approx(-1.0));
  CHECK(nudge.contact);
  CHECK_FALSE(nudge.stopped);
  CHECK(nudge.rejected == "");
  CHECK(nudge.travel_m == Approx(0.056).margin(0.001));  // Rolled 28 mm.
  CHECK(nudge.press_N < kMostPress_N);

  Run(folder / "pile.json", 2, folder / "again");
  CHECK(ReadFile(folder / "again/picks.jsonl") == ReadFile(folder / "with/picks.jsonl"));
}

TEST_CASE("a tube in a corner is placed after at most two nudges") {
  const TemporaryFolder folder;
  const double r = LoadPart("pvc_a").radius_m;
  const double x = 0.385 - r - kGap_m, y = 0.29 - r - kGap_m;
  SaveStraightTube({x, y - 0.5, r}, {x, y, r}, folder / "pile.json");
  CHECK(Run(folder / "pile.json", 0, folder / "without").summary.placed == 0);
  const RoundRecord with = Run(folder / "pile.json", 2, folder / "with");
  CHECK(with.summary.placed == 1);
  REQUIRE(!with.attempts.empty());
  CHECK(!with.attempts[0].nudges.empty());
  CHECK(with.attempts[0].nudges.size() <= 2);
}

}  // namespace
}  // namespace tubetwin
