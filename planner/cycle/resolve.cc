#include "planner/cycle/round_steps.h"

namespace tubetwin {
namespace {

constexpr double kYawStep_deg = 20.0;  ///< Turns of the tool at the tilt station that are tried.
constexpr int kMaxYawSteps = 8;        ///< In either sense.

/// The strategy's path, the tool turned about the vertical as little as the arm needs to run it (to
/// keep the scanner off the forearm while it tilts), or the refusal without any turn.
PathCheck CheckTurned(const CycleContext& c, const ResolutionStrategy& strategy,
                      ResolutionInput input) {
  std::optional<PathCheck> first;
  for (int k = 0; k < 2 * kMaxYawSteps; ++k) {
    input.yaw_rad = Radians(kYawStep_deg * ((k + 1) / 2) * (k % 2 == 0 ? 1 : -1));
    PathCheck check = c.executor.Check(strategy.make(input));
    if (RefusalOf(check) == nullptr) return check;
    if (!first) first = std::move(check);
  }
  return *std::move(first);
}

/// What a stage is called: by what it does besides going somewhere.
std::string CaptionOf(const CheckedPath& path, int stage) {
  std::string caption;
  for (const CheckedPath::Segment& checked : path.segments()) {
    const PathSegment& segment = checked.segment;
    if (segment.stage != stage) continue;
    if (std::holds_alternative<Turn>(segment.what)) return segment.label;
    if (caption.empty() || caption == "to the tilt station") caption = segment.label;
  }
  return caption;
}

}  // namespace

HeldStep Resolve(CycleContext& c, const Vector3& load_torque_K) {
  const ResolutionStrategy& strategy = c.strategy;
  if (strategy.make == nullptr) return {};
  const PathCheck check = CheckTurned(
      c, strategy,
      {c.executor.X_BE(), load_torque_K, c.cell.model.layout, c.cell.bin, c.setup.resolution,
       c.setup.cycle, c.setup.planner.lift_speed_m_s, c.held.period_s, 0.0});
  if (const MotionRejection* refusal = RefusalOf(check)) {
    return {StepOutcome::Refused(strategy.name + ": " + refusal->reason)};
  }
  const CheckedPath& path = std::get<CheckedPath>(check);
  const CycleContext::During recovering(c, &AttemptReport::Phases::recover);
  HeldOutcome held = HeldOutcome::kSeveral;
  for (int stage = 0; stage < path.num_stages() && held == HeldOutcome::kSeveral; ++stage) {
    c.observer.OnStep("several held: " + CaptionOf(path, stage));
    if (StepOutcome step = c.Run(path, stage); !step.ok()) return {step};
    const Weighing weighing = WeighHeld(c, c.setup.cycle.settle_s);
    if (!weighing.step.ok()) return {weighing.step};
    held = weighing.detection.outcome;
  }
  return {{}, held};
}

}  // namespace tubetwin
