#pragma once

#include "planner/cycle/cycle_context.h"

namespace tubetwin {

/// A mean wrench, and whether it may be believed.
struct MeanWrench {
  StepOutcome step;
  Wrench mean_K;
};
MeanWrench MeasureWrench(CycleContext& context, double duration_s);

/// How many hang in the fingers, and whether that may be believed.
struct Weighing {
  StepOutcome step;
  Detection detection;
};
/// Lets time pass until the load on the sensor no longer swings (the means of successive windows,
/// over one period of the held part at least, lie within a share of what weighing must tell apart),
/// `max_s` at most; averages, and compares with the reference. Tool vertical and at rest.
Weighing Weigh(CycleContext& context, double max_s);

}  // namespace tubetwin
