// A new extraction motion, as planner/extraction/README.md explains: one function, one line.
#include "planner/pick/make_path.h"
#include "planner/pick/pick_planner.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/support/planning.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

// [example]
/// "hop": up a little, a rest at the top of it, and up: what lies loosely on the tube rolls off.
MotionSet MakeHop(const ExtractionInput& input) {
  CandidateMotion hop = BeginMotion(input, "hop", "hop");
  hop.speed_m_s = 0.1;
  GoUp(hop, 0.06);
  GoUp(hop, input.config.lift_m);
  return {{hop}, {}};
}

/// Its line in the registry.
const ExtractionMotion kHop = {"hop", ExtractionMotion::Tier::kFirst, MakeHop};
// [example]

TEST_CASE("Example: a motion of one's own is asked about, chosen and can be run", "[unit]") {
  const TubeScene scene =
      PerfectScene({StraightLine({-0.15, 0, kRadius}, {0.25, 0, kRadius}),
                    StraightLine({0.05, -0.2, 3 * kRadius}, {0.05, 0.2, 3 * kRadius})},
                   kRadius);
  const EvaluateFunction evaluate = [](const TubeScene&, const Part&, const Bin&,
                                       const EvaluationRequest& request) {
    EvaluationResult result;
    for (const CandidateMotion& candidate : request.candidates) {
      CandidateScore score;
      score.tube = candidate.tube;
      score.motion = candidate.name;
      score.samples.assign(static_cast<std::size_t>(request.samples), 0.0);
      result.candidates.push_back(score);
    }
    return result;
  };
  PlannerConfig config;
  config.exclude_free = true;  // Only the lower tube may be taken, and only so.
  Part part;
  part.length_m = 0.40;
  const Bin bin;
  const std::vector<Vector3> no_points;
  const MotionPlanner planner(PaperCell(), bin);
  const PathConfig paths;
  const PlanResult result = PlanPicks({scene, no_points, part, bin, FirstGripper(), config, {kHop}},
                                      evaluate, PathFeasibility(planner, bin, paths, kRadius));
  REQUIRE_FALSE(result.plans.empty());
  CHECK(result.plans.front().motion.kind == "hop");
  CHECK(result.plans.front().target == 1);
}

}  // namespace
}  // namespace tubetwin
