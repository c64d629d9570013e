#include "planner/motion/path_builder.h"
#include "planner/resolution/strategies.h"

namespace tubetwin {
namespace {

constexpr double kRest_s = 1.0;
constexpr double kWeakTorque_Nm = 0.02;  ///< Below, the torque's axis is arbitrary.

}  // namespace

Vector3 LoadAxis(const ResolutionInput& input) {
  // Turning about it in the positive sense lets the heavy side go down.
  Vector3 axis_B = input.X_BE.linear() * input.load_torque_K;
  axis_B.z() = 0.0;
  return axis_B.norm() > kWeakTorque_Nm ? axis_B.normalized() : Vector3(Vector3::UnitX());
}

RigidTransform TiltStation(const ResolutionInput& input) {
  return MakeTransform(RotZ(input.yaw_rad) * input.X_BE.linear(), input.layout.p_BTilt);
}

PickPath TiltPath(const ResolutionInput& input, const Vector3& axis_B,
                  const std::vector<double>& angles_deg) {
  PathBuilder path(input.paths, input.ramp_s);
  path.Line("to the tilt station", To(TiltStation(input)), input.lift_speed_m_s);
  const Vector3 turned_axis_B = RotZ(input.yaw_rad) * axis_B;
  const double speed_rad_s = Radians(input.config.speed_deg_s);
  for (std::size_t i = 0; i < angles_deg.size(); ++i) {
    if (i > 0) path.NextStage();
    const Vector3 rotation_B = Radians(angles_deg[i]) * turned_axis_B;
    path.Turn("tilting by " + std::to_string(static_cast<int>(angles_deg[i])) + " degrees",
              rotation_B, speed_rad_s);
    path.Pause("rest", kRest_s);
    path.Turn("level again", -rotation_B, speed_rad_s);
  }
  return path.path();
}

}  // namespace tubetwin
