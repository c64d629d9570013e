#pragma once

#include <mujoco/mujoco.h>

namespace tubetwin {

/// How a geom rubs and gives way where it touches another: sliding friction `friction`, torsional
/// friction of a contact patch of 2 mm, and the stiffness that all scenes have. Of two geoms that
/// touch, the one with the higher `priority` decides; of equals the larger friction counts.
inline void SetSurface(mjsGeom& geom, double friction, int priority, double contact_time_s) {
  geom.condim = 4;
  geom.priority = priority;
  geom.friction[0] = friction;
  geom.friction[1] = 0.002;
  geom.solref[0] = contact_time_s;
  geom.solref[1] = 1.0;
  geom.solimp[0] = 0.95;
  geom.solimp[1] = 0.99;
  geom.solimp[2] = 0.001;
}

/// Time constant of contacts where the step allows it, s.
inline constexpr double kContactTime_s = 0.005;

}  // namespace tubetwin
