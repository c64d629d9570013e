#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/base/frames.h"

namespace tubetwin {

/// Where things stand in a cell and how the tools hang on the flange: part of a CellModel. Metres,
/// frame B (the arm's base) unless a name says otherwise.
struct CellLayout {
  // Tool stack.
  RigidTransform X_FK = RigidTransform::Identity();  ///< Sensor's tool face.
  RigidTransform X_FE = RigidTransform::Identity();  ///< Between the closed pads.

  // Scanner.
  enum class ScannerMount { kFlange, kStand } scanner_mount = ScannerMount::kFlange;
  /// On the flange: the camera, on a bracket above the sensor's tool face, so it is not weighed.
  RigidTransform X_FS = RigidTransform::Identity();
  /// On a stand: the camera.
  RigidTransform X_BS = RigidTransform::Identity();
  /// On a stand: E, tool pointing down, while it looks, so that the arm does not stand in its view.
  Vector3 p_BClear = Vector3::Zero();

  /// Where a scanner on the flange looks from: poses of the camera, or none: planned so that they
  /// cover the bin.
  std::vector<RigidTransform> scan_poses_BS;
  double scan_height_m = 0.0;   ///< Of planned views: camera over the floor.
  double scan_covered_m = 0.0;  ///< They see everything up to this over the floor.
  /// Places of planned views along B's x or y, from the bin's middle, for bins whose extent there
  /// lies between the two of `extent_m`; other bins get evenly spread ones.
  struct ScanOffsets {
    std::vector<double> offsets_m;
    std::array<double, 2> extent_m{};
  };
  ScanOffsets scan_offsets_x, scan_offsets_y;

  // Bin, where no pile and no configuration says otherwise.
  std::array<double, 3> bin_size_m{};  ///< Long, short, wall height.
  RigidTransform X_BN = RigidTransform::Identity();

  // Tray: surface centre; x along the columns of slots.
  RigidTransform X_BT = RigidTransform::Identity();
  double tray_size_m = 0.0;   ///< Square surface.
  double tray_zone_m = 0.0;   ///< Square that E may reach.
  double slot_pitch_m = 0.0;  ///< Distance of neighbouring slots along the tray's x.

  /// E at the station where several tubes are shaken off (pads pointing down).
  Vector3 p_BTilt = Vector3::Zero();
  /// E's height over the bin floor while carrying.
  double carry_height_m = 0.0;

  /// Plate that the cell stands on: a slab under this height.
  double plate_z_m = 0.0;
  std::array<double, 2> plate_centre_m{}, plate_size_m{};

  /// What else nothing may touch: stands, fences, pillars.
  struct KeepOut {
    std::string name;
    RigidTransform X_BBox = RigidTransform::Identity();
    Vector3 half_m = Vector3::Zero();
  };
  std::vector<KeepOut> keep_out;
};

}  // namespace tubetwin
