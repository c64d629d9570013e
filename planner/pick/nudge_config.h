#pragma once

#include "models/base/config/config.h"

namespace tubetwin {

/// Pushing tubes free that cannot be grasped; keys of config table [planner]. Not in the paper.
struct NudgeConfig {
  /// Where no tube can be grasped, one is pushed free and the bin looked into again, so many times
  /// before each pick. 0: never.
  int nudges = 2;
  double nudge_press_N = 3.0;     ///< Force that ends the way down onto a tube.
  double nudge_force_N = 15.0;    ///< Force along the way that ends a push.
  double nudge_speed_m_s = 0.03;  ///< Of the fingers while they push.

  void Visit(ConfigVisitor& v);
};

}  // namespace tubetwin
