#pragma once

#include "models/base/wrench.h"

namespace tubetwin {

/// How many tubes hang in the fingers, as the paper's Algorithm 1 decides it.
enum class HeldOutcome { kNone, kOne, kSeveral };
const char* ToString(HeldOutcome outcome);

struct Detection {
  HeldOutcome outcome = HeldOutcome::kNone;
  double force_N = 0.0;  ///< Load added since the reference, along gravity (positive: heavier).
  Vector3 torque_Nm = Vector3::Zero();  ///< Load torque added since the reference, frame K.
  double at_s = 0.0;  ///< Simulated time of the decision, from the start of the attempt.
};

/// Compares a wrench with the reference taken with empty fingers in the same orientation of the
/// tool (K's z straight down). `mass_kg`: one tube. `tolerance_N`: half a tube's weight is the
/// paper's choice.
Detection DetectHeld(const Wrench& reference_K, const Wrench& now_K, double mass_kg,
                     double tolerance_N);

}  // namespace tubetwin
