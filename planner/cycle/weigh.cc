#include "planner/cycle/weigh.h"

#include <algorithm>
#include <cstdio>
#include <deque>

namespace tubetwin {
namespace {

constexpr double kWindow_s = 0.1;  ///< Averaging out what the sensor's noise and servos do.
constexpr int kSteadyWindows = 3;
constexpr double kSteadyShare = 0.15;  ///< Of the weighing's tolerance.
constexpr double kBeforeTare_s = 0.3;
/// Empty fingers do not weigh so much more or less within a round: the sensor drifts by a tenth.
constexpr double kTareShift_N = 2.0;
/// By more than this nothing hanging pushes up on the tool, and nothing grows heavier in the air.
constexpr double kImpossible_N = 3.0;
constexpr int kUnseenTubes = 2;  ///< Besides those that were seen these may hang in the fingers.

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

std::string Newtons(double force_N) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f N", force_N);
  return text;
}

StepOutcome Disbelieved(const std::string& reason) {
  return {StepOutcome::Status::kTrouble, WaitOutcome::Status::kSensorFault, reason};
}

/// Whether wrist and gripper say the same of what is held; trouble when they do not.
StepOutcome Agreement(const GripperState& fingers, const Detection& weighed) {
  const bool apart = fingers.opening_m >= kNothingOpening_m;
  const bool holds = apart && (fingers.object == GripperObject::kContactClosing ||
                               fingers.object == GripperObject::kMoving);
  const bool weighs = weighed.outcome != HeldOutcome::kNone;
  // Fingers that stand apart and press on nothing hold nothing, but were not told to be there.
  if (holds ? weighs : !weighs && !apart) return {};
  char opening[32];
  std::snprintf(opening, sizeof opening, "%.1f mm", 1e3 * fingers.opening_m);
  return Disbelieved("wrist and gripper disagree: the wrist weighs " + Newtons(weighed.force_N) +
                     ", the gripper says " +
                     (holds ? "that it holds something of " : "that it stands at ") + opening +
                     (holds ? "" : " and holds nothing") + "; the fingers stay closed");
}

}  // namespace

StepOutcome Tare(CycleContext& c) {
  const CycleContext::Timed timed(c, &AttemptReport::SimTime::settle);
  const CycleContext::During weighing(c, &AttemptReport::Phases::weigh);
  Wait(c.cell, kBeforeTare_s);
  const MeanWrench tare = MeasureWrench(c, c.setup.cycle.weigh_window_s);
  if (!tare.step.ok()) return tare.step;
  if (!c.first_reference_K) c.first_reference_K = tare.mean_K;
  const double shift_N = (tare.mean_K.force_N - c.first_reference_K->force_N).norm();
  if (shift_N > kTareShift_N) {
    return Disbelieved("wrist: its load with empty fingers is " + Newtons(shift_N) +
                       " off what it was in this round, " + Newtons(kTareShift_N) +
                       " allowed: another client may have biased it");
  }
  c.reference_K = tare.mean_K;
  c.observer.OnReference(c.reference_K);
  return {};
}

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

Weighing WeighHeld(CycleContext& c, double max_s, const Detection* before) {
  Weighing out = Weigh(c, max_s);
  if (!out.step.ok()) return out;
  const double force_N = out.detection.force_N;
  const double all_N =
      (c.report.tubes_in_bin + kUnseenTubes) * c.setup.part.mass_kg * kGravity + kImpossible_N;
  if (force_N < -kImpossible_N) {
    out.step = Disbelieved("wrist: the fingers weigh " + Newtons(-force_N) +
                           " less than when they were empty");
  } else if (force_N > all_N) {
    out.step = Disbelieved("wrist: the fingers hold " + Newtons(force_N) + ", at most " +
                           Newtons(all_N) + " were in the bin");
  } else if (before != nullptr && force_N > before->force_N + kImpossible_N) {
    out.step = Disbelieved("wrist: what is held weighs " + Newtons(force_N) + ", it weighed " +
                           Newtons(before->force_N) + " before");
  } else {
    out.step = Agreement(c.cell.gripper.State(), out.detection);
  }
  return out;
}

}  // namespace tubetwin
