#pragma once

#include <array>

#include "models/base/config/config.h"
#include "models/base/frames.h"
#include "models/base/json_fwd.h"

namespace tubetwin {

/// Pose of the bin in the cell: floor centre at (0.60, 0, 0.10), long side along B's y.
inline RigidTransform DefaultBinPose() {
  return MakeTransform(RotZ(kPi / 2), Vector3(0.60, 0.0, 0.10));
}

/// An open box. Inner sizes, metres; frame N has its origin at the centre of the floor.
struct Bin {
  std::array<double, 3> size_m = {0.77, 0.58,
                                  0.09};  ///< long (x of N), short (y of N), wall height
  RigidTransform X_BN = DefaultBinPose();
  static constexpr double kWallThickness_m = 0.02;

  double half_x_m() const { return 0.5 * size_m[0]; }
  double half_y_m() const { return 0.5 * size_m[1]; }
  double wall_m() const { return size_m[2]; }
  Vector3 up_B() const { return X_BN.linear().col(2); }
};

Json ToJson(const Bin& bin);
Bin BinFromJson(const JsonView& view);

/// "0.80,0.60,0.09". Throws Error(kUsage) naming the text and what is allowed
/// (three numbers; 0.1 to 3 m, 0.1 to 3 m, 0.01 to 1 m).
std::array<double, 3> ParseBinSize(const std::string& text);

}  // namespace tubetwin
