#pragma once

#include <vector>

#include "models/base/config/config.h"

namespace tubetwin {

/// What the functions of cell.h allow before they stop the arm: table [cell.safety]. All times are
/// cell time. No substitute for the controller's own safety functions.
struct SafetyLimits {
  double arm_silence_s = 0.15;  ///< Age of the newest state of a moving arm.
  /// Age of the newest wrench where it guards a motion or is weighed.
  double wrist_silence_s = 0.05;
  double gripper_silence_s = 0.5;  ///< Age of the newest gripper state.
  double deviation_deg = 3.0;      ///< Of any joint from the path, wherever along it.
  double hold_s = 120.0;           ///< How long a controller may hold the arm back.
  /// What the wrist tells along gravity with empty fingers, tool down, one number; none: what the
  /// cell model's tool weighs.
  std::vector<double> empty_load_N;
  /// Trajectories are stretched until E moves no faster; 0: as planned.
  double max_speed_m_s = 0.0;
  /// The same until Cell::proven; 0: no other limit. A real arm's own, so not visited here.
  double start_speed_m_s = 0.0;

  void Visit(ConfigVisitor& v);

  /// For a cell whose clock runs `rate` times as fast as the wall's. Jitter of hosts and networks
  /// is wall time: what is silent for too short a wall time is not called lost.
  SafetyLimits AtRate(double rate) const;
};

}  // namespace tubetwin
