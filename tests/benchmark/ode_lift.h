#pragma once

#include "scenes/pile.h"

namespace tubetwin {

/// The 2020 paper's kind of evaluator as a yardstick: the pile in ODE (quick step with Gazebo's 50
/// iterations, 1 ms), every rigid tube one body of capsules, the bin of boxes, friction pyramid.
/// Tube `index` is set to move up at `speed_m_s` for `lift_m` in every step; the others follow
/// contacts. Returns the wall seconds of the steps and the others' displacement. One thread.
struct OdeLift {
  double wall_s = 0.0, simulated_s = 0.0, displacement_m = 0.0;
};
OdeLift LiftInOde(const Pile& pile, int index, double lift_m, double speed_m_s, double hold_s);

}  // namespace tubetwin
