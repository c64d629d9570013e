#pragma once

#include <array>
#include <string>

#include <mujoco/mujoco.h>

#include "models/bin.h"

namespace tubetwin {

/// How a bin is built into a scene.
struct BinBodyOptions {
  RigidTransform X_WN = RigidTransform::Identity();  ///< Bin in the scene's world.
  double friction = 0.3;
  double contact_time_s = 0.005;
  std::array<double, 3> colour_rgb = {0.35, 0.38, 0.42};
};

/// Adds the bin to the world body: floor `bin_floor` and walls `bin_wall_x+`, `bin_wall_x-`,
/// `bin_wall_y+`, `bin_wall_y-`, boxes of Bin::kWallThickness_m; the walls stand beside the floor
/// area and reach down to its lower face.
void AddBin(mjSpec& spec, const Bin& bin, const BinBodyOptions& options);

/// Adds a horizontal plane `ground` (normal along the X_WP's z) with the same contact physics.
void AddGround(mjSpec& spec, const RigidTransform& X_WP, const BinBodyOptions& options);

}  // namespace tubetwin
