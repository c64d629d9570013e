#pragma once

#include <cstdint>

#include "planner/pick/pick_plan.h"

namespace tubetwin {

/// Tubes that nothing covers any more once tube `id` is gone.
int ReleasedBy(const TubeScene& scene, int id);

/// What to pick and how, best first. Free tubes go straight up without asking the simulator (Leão
/// et al. 2020, section 3.3); only when no plan for one survives, or `config.exclude_free`, the
/// motions of covered tubes are scored by `evaluate`: the least covered tubes first, among them
/// those that free most others, in batches of about `max_candidates` motions until one of them
/// brings another tube along with a probability of at most `accept_extra` and gives a plan; each
/// motion once, then the best `refined` with all samples, until the best of all has them. Ranks:
/// free tubes; covered tubes; free and then covered tubes that are in doubt (shorter than
/// `min_length_share` of the part or of little confidence; the plan's note says which); motions
/// that jammed in the simulator. Within a rank by cost: the grasp's, plus doubt about the tube,
/// less the tubes that it sets free, plus ExtraProbability. Plans are checked by `feasible` in this
/// order, each with either of the gripper's two equal yaws, until `max_plans` are found; places of
/// one tube at least 20 mm apart, so that a second try is another try. Classes are those of
/// `config.classes`. Nothing to pick is an empty list; `rejections` says why for every tube. The
/// order of the scene's tubes and crossings changes nothing.
PlanResult PlanPicks(const PickProblem& problem, const EvaluateFunction& evaluate,
                     const FeasibilityFunction& feasible, std::uint64_t seed = 1);

}  // namespace tubetwin
