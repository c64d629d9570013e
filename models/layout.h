#pragma once

#include <vector>

#include "models/base/frames.h"
#include "models/bin.h"

namespace tubetwin {

/// Where things stand in the cell and how the tools hang on the flange. Metres, frame B.
/// From the reach study: every point of the bin and the tray is reached with the tool vertical, and
/// at the tilt station the tool tilts 45 degrees about any horizontal axis through E.
struct CellLayout {
  // Tool stack.
  RigidTransform X_FK = Translation(0, 0, 0.033);  ///< Sensor's tool face.
  RigidTransform X_FE = Translation(0, 0, 0.177);  ///< Between the closed pads.
  /// Scanner camera on a bracket at the flange above the sensor's tool face: it is not weighed. The
  /// camera looks along the flange's z, so the housing stands askew and its projector's end is the
  /// lowest, 101 mm beyond the flange: over the bin's walls when the pads are at the floor.
  RigidTransform X_FS = Translation(0, 0.115, 0.030);

  // Tray: surface centre, axes along B.
  RigidTransform X_BT = Translation(0.05, -0.78, 0.10);
  double tray_size_m = 0.60;    ///< Square surface.
  double tray_zone_m = 0.40;    ///< Square that E may reach.
  double slot_pitch_m = 0.055;  ///< Distance of neighbouring slots along the tray's x.

  /// E at the tilt station (pads pointing down).
  Vector3 p_BTilt = Vector3(0.60, 0.0, 0.575);

  /// E's height over the bin floor while carrying.
  double carry_height_m = 0.45;
};

/// Tubes of at least this radius are looked at alike; thinner ones hide in narrower shadows.
inline constexpr double kThinnestUsual_m = 0.010;

/// The places to scan from: scanner poses in B, camera looking straight down, the long image side
/// along B's x. Where the projector would stand beyond a wall so high that its shadow could hide a
/// tube of `radius_m`, the scanner looks from inside that wall, tilted outward.
std::vector<RigidTransform> DefaultScanPoses(const Bin& bin, double radius_m = kThinnestUsual_m);

/// Masses below the sensor's tool face, for the tare and for payload. kg, position in K.
inline constexpr double kGripperMass_kg = 0.93;
inline constexpr double kCouplingMass_kg = 0.10;

}  // namespace tubetwin
