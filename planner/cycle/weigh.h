#pragma once

#include "planner/cycle/cycle_context.h"

namespace tubetwin {

/// A mean wrench, and whether it may be believed.
struct MeanWrench {
  StepOutcome step;
  Wrench mean_K;
};
MeanWrench MeasureWrench(CycleContext& context, double duration_s);

/// The load of empty fingers, for all that is weighed after it; kept in the context. Trouble when
/// it is not that of the round's begin: the sensor was biased by somebody, or lies.
StepOutcome Tare(CycleContext& context);

/// How many hang in the fingers, and whether that may be believed.
struct Weighing {
  StepOutcome step;
  Detection detection;
};
/// Lets time pass until the load on the sensor no longer swings (the means of successive windows,
/// over one period of the held part at least, lie within a share of what weighing must tell apart),
/// `max_s` at most; averages, and compares with the reference. Tool vertical and at rest. A hose
/// that is still held down by others, or bent against the floor, may push up on the fingers.
Weighing Weigh(CycleContext& context, double max_s);

/// Weigh() of what was lifted and hangs free. Trouble when it is less than nothing, more than all
/// that was seen, more than `before` by more than a tube's swing, or when wrist and gripper
/// disagree whether anything is held: one of the two is wrong then, and nobody may open the fingers
/// on its word.
Weighing WeighHeld(CycleContext& context, double max_s, const Detection* before = nullptr);

}  // namespace tubetwin
