#pragma once

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "models/arm/arm.h"
#include "models/cell_model.h"

namespace tubetwin {

/// Name of the arm's joint (and of its motor) with index 0 to 5 in the cell's model.
std::string ArmJointName(int joint);

/// Site at X_FK on the tool body, axes of K: where the wrist sensor measures.
inline constexpr char kWristSite[] = "wrist";
inline constexpr char kWristForce[] = "wrist_force";
inline constexpr char kWristTorque[] = "wrist_torque";

/// Adds base, links with hinges and motors (effort limits as force range), sensor and, where
/// it hangs on the flange, scanner to the world, and returns the body below the sensor, whose frame
/// is K: what hangs on it is weighed. Its geoms are arm shapes of the tool (palm); it has no
/// inertia yet.
mjsBody& AddArm(mjSpec& spec, const CellModel& model);

}  // namespace tubetwin
