#include "hw_bridge/cell/left_over.h"

#include <cstdio>

namespace tubetwin {
namespace {

constexpr double kNothing_m = 0.004;
/// A tool that leans more says little: a sensor's own offset does not turn with it.
constexpr double kUpright = 0.99;
/// What the sensor's drift and cross-talk may add.
constexpr double kDrift_N = 0.15;

std::string Text(const char* format, double a, double b = 0.0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

}  // namespace

std::string LeftInFingers(const GripperState& state) {
  if (state.object != GripperObject::kContactClosing || state.opening_m < kNothing_m) return "";
  return Text("gripper: its fingers press on something of %.1f mm", 1e3 * state.opening_m);
}

std::string LeftOnWrist(const WrenchSample& sample, const JointVector& q, const CellModel& model,
                        const SafetyLimits& safety, double mass_kg) {
  const Matrix3 R_BK = FlangePose(model.arm, q).linear() * model.layout.X_FK.linear();
  if (!q.allFinite() || -R_BK(2, 2) < kUpright) return "";
  const double load_N = -(R_BK * sample.wrench_K.force_N).z();
  const double empty_N = safety.empty_load_N.empty()
                             ? (model.gripper.mass_kg + model.gripper.coupling_mass_kg) * kGravity
                             : safety.empty_load_N.front();
  if (!(load_N - empty_N > 0.5 * mass_kg * kGravity + kDrift_N)) return "";
  return Text("wrist: the tool weighs %.2f N, with empty fingers %.2f N", load_N, empty_N) +
         " (cell.safety.empty_load_N)";
}

}  // namespace tubetwin
