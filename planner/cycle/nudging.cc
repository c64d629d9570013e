#include <algorithm>
#include <cmath>

#include "planner/cycle/round_steps.h"
#include "planner/pick/make_path.h"
#include "planner/pick/nudge.h"

namespace tubetwin {
namespace {

constexpr double kWindow_s = 0.05;  ///< Averaging out the sensor's noise.

/// Presses and drags; what was felt goes into the report.
StepOutcome RunStroke(CycleContext& c, const CheckedPath& path, int stroke,
                      const Wrench& unloaded_K, NudgeReport& report) {
  StepOutcome press = c.Run(path, NudgeStage(stroke, StrokeStage::kPress));
  if (!press.ok()) return press;
  report.contact = report.contact || press.contact();
  const MeanWrench load = MeasureWrench(c, kWindow_s);
  if (!load.step.ok()) return load.step;
  report.press_N = std::max(report.press_N, (load.mean_K - unloaded_K).force_N.norm());
  const Vector3 from_B = c.executor.X_BE().translation();
  StepOutcome drag = c.Run(path, NudgeStage(stroke, StrokeStage::kDrag));
  if (!drag.ok()) return drag;
  report.stopped = report.stopped || drag.contact();
  report.travel_m += (c.executor.X_BE().translation() - from_B).norm();
  return c.Run(path, NudgeStage(stroke, StrokeStage::kLift));
}

/// All strokes, until one is stopped by its force limit.
StepOutcome RunStrokes(CycleContext& c, const CheckedPath& path, int strokes, NudgeReport& report) {
  if (StepOutcome step = c.Run(path, 0); !step.ok()) return step;
  const MeanWrench unloaded = MeasureWrench(c, c.setup.cycle.weigh_window_s);
  if (!unloaded.step.ok()) return unloaded.step;
  for (int k = 0; k < strokes && !report.stopped; ++k) {
    if (StepOutcome step = RunStroke(c, path, k, unloaded.mean_K, report); !step.ok()) return step;
  }
  return {};
}

/// Runs a nudge. What is refused on the way ends it where it is, and is in the report.
StepOutcome Push(CycleContext& c, const Nudge& nudge) {
  c.observer.OnStep("nudging tube " + std::to_string(nudge.tube) + " by " +
                    std::to_string(std::lround(1e3 * nudge.travel_m)) + " mm");
  NudgeReport report;
  report.tube = nudge.tube;
  report.direction_N = nudge.direction_N;
  const PathCheck check = c.executor.Check(
      MakeNudgePath(nudge, c.cell.model.gripper, c.cell.bin, c.setup.cycle, c.setup.planner));
  StepOutcome step;
  if (const MotionRejection* refusal = RefusalOf(check)) {
    step = StepOutcome::Refused(refusal->reason);
  } else {
    step =
        RunStrokes(c, std::get<CheckedPath>(check), static_cast<int>(nudge.strokes.size()), report);
  }
  if (step.refused()) report.rejected = step.reason;
  c.report.nudges.push_back(report);
  if (!step.ok() && !step.refused()) return step;
  PathBuilder up(c.setup.cycle);
  up.Line("up", By(Vector3(0, 0, c.setup.cycle.approach_m)));
  const StepOutcome raised = c.CheckAndRun(up.path());
  return raised.refused() ? StepOutcome() : raised;
}

}  // namespace

NudgeStep TryNudge(CycleContext& c, const PickProblem& problem) {
  if (static_cast<int>(c.report.nudges.size()) >= c.setup.planner.nudges) return {};
  const double began = WallClock_s();
  const MotionPlanner& planner = c.executor.planner();
  const NudgeResult result =
      PlanNudge(problem, PathFeasibility(planner, c.cell.bin, c.setup.cycle, c.setup.part.radius_m),
                NudgePathFeasibility(planner, c.cell.bin, c.setup.cycle, c.setup.planner));
  c.report.compute_s.planning += WallClock_s() - began;
  c.report.rejections.insert(c.report.rejections.end(), result.rejections.begin(),
                             result.rejections.end());
  if (!result.nudge) return {};
  const CycleContext::During recovering(c, &AttemptReport::Phases::recover);
  const StepOutcome step = Push(c, *result.nudge);
  return {step, result.nudge->tube};
}

}  // namespace tubetwin
