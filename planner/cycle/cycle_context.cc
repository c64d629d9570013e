#include "planner/cycle/cycle_context.h"

#include <algorithm>
#include <utility>

namespace tubetwin {
namespace {

constexpr double kReleaseExtra_m = 0.030;  ///< Opening beyond the tube when letting go.

}  // namespace

CycleContext::Phase CycleContext::Enter(Phase phase) {
  const TimeNs now = cell.clock.Now();
  report.phases_s.*phase_ += Seconds(now - phase_began_);
  phase_began_ = now;
  return std::exchange(phase_, phase);
}

void CycleContext::BeginPhases() {
  phase_ = &AttemptReport::Phases::look;
  phase_began_ = cell.clock.Now();
}

void CycleContext::Released() {
  cell.carried_opening_m.reset();
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
