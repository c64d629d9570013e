#pragma once

#include <vector>

#include "scenes/pile.h"
#include "twin/cell/twin_cell.h"

namespace tubetwin {

/// What really is the case in a twin cell. For scoring only: twin/round is the one reader (a
/// test checks the includes). Const access, nothing here changes the world.
class Truth {
 public:
  explicit Truth(const TwinCell& cell);

  struct Tube {
    int id = 0;
    Polyline centerline_B;
    Vector3 centre_of_mass_B = Vector3::Zero();
    double speed_m_s = 0.0;     ///< Largest speed of any of its links.
    bool touches_pads = false;  ///< Both pads.
    bool hangs = false;  ///< Carried by the gripper: contact component with the pads, not the bin.
    bool over_tray = false;  ///< Centre of mass over the tray's surface.
    bool over_bin = false;   ///< Any part over the bin's inside.
    bool outside = false;    ///< Below the bin's floor or tray, or at rest on neither.
  };
  std::vector<Tube> Tubes() const;
  /// Number of tubes that the gripper carries.
  int Held() const;
  Pile CurrentPile() const;
  RigidTransform X_BS() const;  ///< True scanner pose.

 private:
  const TwinCell& cell_;
};

}  // namespace tubetwin
