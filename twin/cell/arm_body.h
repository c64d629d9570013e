#pragma once

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "models/arm/arm.h"
#include "models/layout.h"

namespace tubetwin {

/// Name of the arm's joint (and of its motor) with index 0 to 5 in the cell's model.
std::string ArmJointName(int joint);

// On the flange above the sensor's tool face, so not weighed: transducer with its plates (centre
// half way to the tool face), scanner with bracket (centre in the housing's frame H).
inline constexpr double kSensorMass_kg = 0.45;
inline constexpr double kScannerMass_kg = 1.25;
inline constexpr double kScannerCentre_m = -0.034;  ///< Along H's z: middle of the housing.

/// Site at X_FK on the tool body, axes of K: where the wrist sensor measures.
inline constexpr char kWristSite[] = "wrist";
inline constexpr char kWristForce[] = "wrist_force";
inline constexpr char kWristTorque[] = "wrist_torque";

/// Adds base, links with hinges and motors (effort limits as force range), sensor and scanner
/// housing to the world, and returns the body below the sensor, whose frame is K: what hangs on it
/// is weighed. Its geoms are arm shapes of the tool (palm); it has no inertia yet.
mjsBody& AddArm(mjSpec& spec, const ArmModel& arm, const CellLayout& layout);

}  // namespace tubetwin
