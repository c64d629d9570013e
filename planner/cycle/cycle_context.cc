#include "planner/cycle/cycle_context.h"

#include <algorithm>

namespace tubetwin {
namespace {

constexpr double kReleaseExtra_m = 0.030;  ///< Opening beyond the tube when letting go.

}  // namespace

void CycleContext::Released() {
  cell.carrying = false;
  cell.arm.SetPayload(0.0, Vector3::Zero());
  held = {};
}

double CycleContext::ReleaseOpening() const {
  return std::min(gripper.spec.stroke_m, 2 * setup.part.radius_m + kReleaseExtra_m);
}

StepOutcome CycleContext::Run(const CheckedPath& path, int stage) {
  const Timed timed(*this, &AttemptReport::SimTime::move);
  return executor.Run(path, stage);
}

StepOutcome CycleContext::CheckAndRun(const PickPath& path) {
  const Timed timed(*this, &AttemptReport::SimTime::move);
  return executor.CheckAndRun(path);
}

}  // namespace tubetwin
