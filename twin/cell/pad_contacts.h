#pragma once

#include <array>
#include <vector>

#include <mujoco/mujoco.h>

namespace tubetwin {

/// Puts back a term that the engine leaves out of contacts (its manual, "Dual problem": J' v is
/// "omitted due to the complexity of differentiating the contact frame"). Friction in the engine is
/// a damper on the relative speed without memory. A pad that swings on the arm and a tube that is a
/// free body differ by a centripetal acceleration j = J' v (0.9 m/s^2 in a brisk transfer), which
/// that damper alone must supply: the tube creeps through a grasp far below the friction limit, at
/// j (1/b + h/2), b the row's damping, h the step: millimetres per move.
/// With the relative surface velocity of each pad contact set to that same speed the damper drives
/// the contact to rest instead (hold test: 3.8 mm of creep become less than 0.1 mm). Forces stay
/// inside the same friction cone, so a grasp that is too weak slips as before.
class PadContacts {
 public:
  /// For contacts of the two pads. `model` gets its flag for surface velocities set.
  explicit PadContacts(mjModel& model);

  /// Corrects the contacts of `data`. Call between mj_step1 and mj_step2.
  void Correct(mjData& data);

 private:
  const mjModel& model_;
  std::array<int, 2> pads_;
  std::vector<mjtNum> jacp_, jacr_;  ///< [3 * nv] scratch.
};

}  // namespace tubetwin
