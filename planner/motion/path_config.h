#pragma once

#include "models/base/config/config.h"

namespace tubetwin {

/// Speeds, forces and heights of the paths that the pick cycle runs; keys of config table [cycle].
struct PathConfig {
  double transfer_speed_m_s = 0.6, transfer_acceleration_m_s2 = 1.0;
  double approach_speed_m_s = 0.20, guarded_speed_m_s = 0.02;
  double guard_force_N = 8.0;
  double grip_force_N = 60.0, grip_speed_m_s = 0.10;
  double approach_m = 0.08;  ///< Height over the grasp where the straight descent begins.
  double guarded_m = 0.010;  ///< Last part of the descent, guarded.
  double first_lift_m = 0.03;

  void Visit(ConfigVisitor& v);
};

}  // namespace tubetwin
