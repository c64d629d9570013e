#pragma once

#include <optional>

#include "planner/cycle/cycle_context.h"
#include "planner/cycle/weigh.h"

namespace tubetwin {

// Steps of a round that have a file of their own: resolve.cc, place.cc, recover.cc, nudging.cc.

/// The fingers go up so far after they let something go.
inline constexpr double kRetreat_m = 0.15;

/// How many hang in the fingers after a step that moved them.
struct HeldStep {
  StepOutcome step;
  HeldOutcome held = HeldOutcome::kSeveral;
};

/// Tries to shake off all but the held tube with the round's strategy; the tool ends upright and at
/// rest. Refused when the arm can run none of its paths.
HeldStep Resolve(CycleContext& context, const Vector3& load_torque_K);

/// How placing ended: kPlaced, or kDropped when the tube was lost on the way.
struct PlaceStep {
  StepOutcome step;
  AttemptOutcome outcome = AttemptOutcome::kDropped;
};
/// Lays the held tube into the next slot that the arm can reach with a path that it can run.
/// `line_E`: its centerline relative to E. Refused when there is none.
PlaceStep Place(CycleContext& context, const Polyline& line_E);

/// Lowers what hangs in the fingers into the bin until it is felt or the fingers are near the
/// floor, opens and retreats. Over the bin's middle where the arm is not over the bin or cannot
/// lower there.
StepOutcome PutBack(CycleContext& context);

/// Opens the fingers and goes up, nothing being held. The way up is left out where it is refused:
/// every way to the next place begins by going up.
StepOutcome OpenAndRetreat(CycleContext& context, double opening_m);

/// Where no tube can be grasped: pushes one to where it can be and puts that into the report.
/// Closed fingers press on it until the wrist feels it, drag it along under a force limit and come
/// up again. The tube's id, or nothing when no tube can be pushed or it was done often enough.
struct NudgeStep {
  StepOutcome step;
  std::optional<int> tube;
};
NudgeStep TryNudge(CycleContext& context, const PickProblem& problem);

/// Puts what `left` says that is in the fingers back into the bin, slowly, on an operator's word.
Acknowledgement PutBackLeftOver(CycleContext& context, const std::string& left);

/// After a stop or fault of the arm: asks the operator, if there is one, and goes on only on their
/// word: ready again, straight up, what is held back into the bin.
Acknowledgement GoOnAfterStop(CycleContext& context, const StepOutcome& trouble);

}  // namespace tubetwin
