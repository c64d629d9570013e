#pragma once

namespace tubetwin {

/// PhoXi 3D Scanner S as figures. Pinhole without distortion, principal point at the centre, square
/// pixels; projector beside the camera along -x or +x of S. Metres, pixels of the full image.
struct ScannerSpec {
  int full_width = 2064, full_height = 1544;
  double focal_px = 2534.0;   ///< At full width; 442 mm * 2064 / 360 mm.
  double baseline_m = 0.235;  ///< Camera to projector.
  double toe_in_deg = 15.45;  ///< Each of camera and projector, towards the other.
  double sweet_spot_m = 0.442;
  double range_min_m = 0.384, range_max_m = 0.520;  ///< Data sheet; soft in the twin.
  double soft_min_m = 0.300, soft_max_m = 1.200;
  double sigma_m = 0.00005;  ///< Range noise at the sweet spot, normal incidence.
  double scan_time_s = 0.6;
  /// Housing, metres, long side along x of S (baseline).
  double housing_x_m = 0.2956, housing_y_m = 0.0766, housing_z_m = 0.0679;
};

}  // namespace tubetwin
