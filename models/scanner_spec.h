#pragma once

#include "models/base/frames.h"

namespace tubetwin {

/// Photoneo PhoXi 3D Scanner S as figures, metres and pixels of the full image. Sources: [P] the
/// 2020 paper's data sheet values, [X] the vendor's later sheets, [U] the vendor's URDF, [W] the
/// vendor's wiki, [C] calculated from those. Intrinsics of a unit are its own calibration and not
/// published: pinhole without distortion, principal point at the centre, square pixels.
struct ScannerSpec {
  int full_width = 2064, full_height = 1544;  ///< [P] 3.2 million points.
  double focal_px = 2534.0;                   ///< [C] 442 mm * 2064 / 360 mm, at full width.
  double baseline_m = 0.235;    ///< [U] Camera to projector, twice 117.4 mm ([X] says 230).
  double toe_in_deg = 15.45;    ///< [U] Camera towards projector; the projector alike [C].
  double sweet_spot_m = 0.442;  ///< [P]; the axes cross at 440.6 mm [C].
  double range_min_m = 0.384, range_max_m = 0.520;  ///< [P] Data sheet; soft in the twin.
  double soft_min_m = 0.300, soft_max_m = 1.200;    ///< Assumed: no returns beyond.
  double projector_width_deg = 47.5;                ///< [W] +-1, whole angle.
  double projector_height_deg = 36.0;               ///< [W] +-2.
  double sigma_m = 0.00005;  ///< [P] 1 sigma of depth at the sweet spot, normal incidence.
  double scan_time_s = 0.6;  ///< Assumed, within the 0.25 to 2.25 s of the exposures.
  /// [U] Housing: length along the baseline, width across, depth along the line of sight.
  double housing_x_m = 0.2956, housing_y_m = 0.0766, housing_z_m = 0.0679;
};

/// Pose of the housing's frame (H) in the camera frame S: origin on the front face half way between
/// camera and projector, x along the baseline to the projector, z out of the front. Both apertures
/// lie in the front face (z 0 of H); the camera is turned by `toe_in_deg` towards the projector, so
/// the housing stands askew in S. The projector is on S's +x side: with the arm's scan poses the
/// side away from the robot's base, so the forearm never stands in the light.
RigidTransform HousingPose(const ScannerSpec& spec);

/// Pose of the projector (P, z along its optical axis) in S: mirror image of the camera in H.
RigidTransform ProjectorPose(const ScannerSpec& spec);

}  // namespace tubetwin
