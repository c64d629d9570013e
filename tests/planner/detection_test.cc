#include "planner/grasp/detection.h"

#include "tests/support/catch.h"

namespace tubetwin {
namespace {

Wrench Load(double force_N) {
  Wrench out;
  out.force_N.z() = force_N;
  return out;
}

TEST_CASE("Added load is counted in tubes against the reference, tolerance half a weight",
          "[unit]") {
  const double mass_kg = 0.055, weight_N = mass_kg * kGravity;
  const Wrench reference = Load(10.1);
  const auto held = [&](double tubes) {
    return DetectHeld(reference, Load(10.1 + tubes * weight_N), mass_kg, 0.5 * weight_N).outcome;
  };
  CHECK(held(0.0) == HeldOutcome::kNone);
  CHECK(held(0.49) == HeldOutcome::kNone);
  CHECK(held(0.51) == HeldOutcome::kOne);
  CHECK(held(1.0) == HeldOutcome::kOne);
  CHECK(held(1.49) == HeldOutcome::kOne);
  CHECK(held(1.51) == HeldOutcome::kSeveral);
  CHECK(held(3.0) == HeldOutcome::kSeveral);
}

TEST_CASE("The torque of a detection is what the load added", "[unit]") {
  Wrench reference, now;
  reference.torque_Nm = {0.1, 0.2, 0.3};
  now.torque_Nm = {0.4, 0.1, 0.3};
  CHECK(DetectHeld(reference, now, 0.1, 0.5).torque_Nm.isApprox(Vector3(0.3, -0.1, 0.0)));
}

}  // namespace
}  // namespace tubetwin
