#pragma once

#include <array>

#include <mujoco/mujoco.h>

#include "models/cell_model.h"
#include "models/physics.h"

namespace tubetwin {

// The two-jaw gripper's body. Two fingers slide towards each other along y of E on a carriage that
// moves out along z as they close (the tips' advance); a joint equality couples each pair, one
// actuator on the sum of both travels closes them. The tube is held by friction alone.

inline constexpr char kFingerLeftJoint[] = "finger_left";
inline constexpr char kFingerRightJoint[] = "finger_right";
inline constexpr char kCarriageJoint[] = "finger_carriage";
inline constexpr char kGripActuator[] = "grip";
inline constexpr char kPadLeftGeom[] = "pad_left";
inline constexpr char kPadRightGeom[] = "pad_right";

/// Servo of the sum of both travels, N/m and N s/m.
inline constexpr double kGripStiffness_N_m = 4000.0;
inline constexpr double kGripDamping_Ns_m = 60.0;

/// Advance of the pads as a polynomial of one finger's travel t (metres, 0 open):
/// c[0] + c[1] t + ... + c[4] t^4, least squares of TipAdvance(stroke - 2 t) with c[0] = 0.
struct AdvancePolynomial {
  std::array<double, 5> c{};
  double largest_error_m = 0.0;  ///< Against TipAdvance over the whole stroke.
};
AdvancePolynomial FitTipAdvance(const GripperSpec& spec);

/// Adds carriage, fingers, pads, couplings and actuator to `tool`, a body whose frame is K, and the
/// tool's own mass. Fully open at the start.
void AddGripper(mjSpec& spec, mjsBody& tool, const CellModel& model, const RoundPhysics& physics);

}  // namespace tubetwin
