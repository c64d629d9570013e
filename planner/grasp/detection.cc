#include "planner/grasp/detection.h"

namespace tubetwin {

const char* ToString(HeldOutcome outcome) {
  switch (outcome) {
    case HeldOutcome::kNone:
      return "none";
    case HeldOutcome::kOne:
      return "one";
    case HeldOutcome::kSeveral:
      return "several";
  }
  return "none";
}

Detection DetectHeld(const Wrench& reference_K, const Wrench& now_K, double mass_kg,
                     double tolerance_N) {
  const Wrench added_K = now_K - reference_K;
  Detection out;
  // The paper's F_z points up and falls with load; here the load along K's z (down) rises.
  out.force_N = added_K.force_N.z();
  out.torque_Nm = added_K.torque_Nm;
  const double weight_N = mass_kg * kGravity;
  if (out.force_N > weight_N + tolerance_N) {
    out.outcome = HeldOutcome::kSeveral;
  } else if (out.force_N < weight_N - tolerance_N) {
    out.outcome = HeldOutcome::kNone;
  } else {
    out.outcome = HeldOutcome::kOne;
  }
  return out;
}

}  // namespace tubetwin
