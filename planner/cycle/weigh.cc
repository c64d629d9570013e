#include "planner/cycle/weigh.h"

#include <algorithm>
#include <deque>

namespace tubetwin {
namespace {

constexpr double kWindow_s = 0.1;  ///< Averaging out what the sensor's noise and servos do.
constexpr int kSteadyWindows = 3;
constexpr double kSteadyShare = 0.15;  ///< Of the weighing's tolerance.

double Tolerance_N(const CycleContext& c) {
  return c.setup.cycle.tolerance_share * c.setup.part.mass_kg * kGravity;
}

StepOutcome WaitForSteadyLoad(CycleContext& c, double max_s) {
  const double band_N = kSteadyShare * Tolerance_N(c);
  const int windows = std::max(kSteadyWindows, static_cast<int>(c.held.period_s / kWindow_s) + 2);
  const TimeNs end = c.cell.clock.Now() + FromSeconds(max_s);
  std::deque<double> means_N;
  while (c.cell.clock.Now() + FromSeconds(kWindow_s) <= end) {
    const MeanWrench window = MeasureWrench(c, kWindow_s);
    if (!window.step.ok()) return window.step;
    means_N.push_back(window.mean_K.force_N.z());
    if (static_cast<int>(means_N.size()) > windows) means_N.pop_front();
    const auto [min, max] = std::minmax_element(means_N.begin(), means_N.end());
    if (static_cast<int>(means_N.size()) == windows && *max - *min < band_N) return {};
  }
  c.cell.clock.AdvanceTo(end);
  return {};
}

}  // namespace

MeanWrench MeasureWrench(CycleContext& c, double duration_s) {
  const WrenchOutcome wrench = AverageWrench(c.cell, duration_s);
  if (wrench.outcome.status != WaitOutcome::Status::kDone) {
    return {StepOutcome::Trouble(wrench.outcome, "weighing"), {}};
  }
  return {{}, wrench.mean_K};
}

Weighing Weigh(CycleContext& c, double max_s) {
  const CycleContext::Timed timed(c, &AttemptReport::SimTime::weigh);
  const CycleContext::During weighing(c, &AttemptReport::Phases::weigh);
  if (StepOutcome steady = WaitForSteadyLoad(c, max_s); !steady.ok()) return {steady, {}};
  const MeanWrench now = MeasureWrench(c, c.setup.cycle.weigh_window_s);
  if (!now.step.ok()) return {now.step, {}};
  Weighing out;
  out.detection = DetectHeld(c.reference_K, now.mean_K, c.setup.part.mass_kg, Tolerance_N(c));
  out.detection.at_s = Seconds(c.cell.clock.Now() - c.attempt_began);
  return out;
}

}  // namespace tubetwin
