#pragma once

#include <array>
#include <string>

#include "models/model_file.h"

namespace tubetwin {

/// A wrist force/torque sensor as figures, read from a sensor file (models/wrists). Order of the
/// axes: Fx Fy Fz Tx Ty Tz, in K (its tool face).
struct WristSpec {
  std::string name;
  std::array<double, 6> range{};  ///< Largest reading, N and N m.
  std::array<double, 6> count{};  ///< One step of a reading, N and N m.
  double corner_Hz = 0.0;         ///< Of its low-pass.
  double mass_kg = 0.0;
  double inertia_side_m = 0.0;  ///< Side of the square block, as high as it, whose inertia it has.
  double radius_m = 0.0;        ///< Of its body, which fills the flange to X_FK.
};

/// Of a force sensor file, shipped or a user's own. Throws Error(kConfig) with file:line:column.
WristSpec ReadWrist(const ModelFile& file);

}  // namespace tubetwin
