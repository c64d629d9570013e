#include "twin/live/kept_devices.h"

#include <algorithm>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr double kStiffness_1_s =
    20.0;                           ///< Of the bend towards the real joints, critically damped.
constexpr double kNear_rad = 0.05;  ///< From further off it comes at half a radian per second.
constexpr double kAcceleration_rad_s2 = 6.0;

}  // namespace

ShadowArm::ShadowArm(const Arm& real, ServoArm& twin) : real_(real), twin_(twin) {
  reference_.q = twin.Servo().q;
}

void ShadowArm::Follow() {
  const std::string fault = twin_.Servo().fault;
  if (!fault.empty()) throw Error(ErrorKind::kDevice, "the twin of the arm is blocked: " + fault);
  const ArmState real = real_.State();
  if (!real.q.allFinite() || !real.qd.allFinite()) return;  // The cell's watch says it.
  const double period_s = Seconds(kControlPeriod);
  for (int i = 0; i < kNumJoints; ++i) {
    const double off = std::clamp(real.q[i] - reference_.q[i], -kNear_rad, kNear_rad);
    const double bend = kStiffness_1_s * kStiffness_1_s * off +
                        2.0 * kStiffness_1_s * (real.qd[i] - reference_.qd[i]);
    reference_.qdd[i] = std::clamp(bend, -kAcceleration_rad_s2, kAcceleration_rad_s2);
    reference_.qd[i] += period_s * reference_.qdd[i];
    reference_.q[i] += period_s * reference_.qd[i];
  }
  twin_.Follow(reference_);
}

double ShadowArm::Off_rad() const {
  return (real_.State().q - twin_.Servo().q).cwiseAbs().maxCoeff();
}

}  // namespace tubetwin
