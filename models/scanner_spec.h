#pragma once

#include <string>
#include <vector>

#include "models/base/frames.h"
#include "models/model_file.h"

namespace tubetwin {

/// A structured-light scanner as figures, read from a scanner file (models/scanners): metres and
/// pixels of the full image. Pinhole without distortion, principal point at the centre, square
/// pixels: a unit's own intrinsics are its calibration and not published.
struct ScannerSpec {
  std::string name;
  int full_width = 0, full_height = 0;
  std::vector<std::string> resolutions;  ///< "1032x772": sizes of a scan; the first is the default.
  double focal_px = 0.0;                 ///< At full width.
  double baseline_m = 0.0;               ///< Camera to projector.
  double toe_in_deg = 0.0;               ///< Camera towards projector; the projector alike.
  double sweet_spot_m = 0.0;             ///< Distance where it is best.
  double range_min_m = 0.0, range_max_m = 0.0;  ///< Data sheet.
  double soft_min_m = 0.0, soft_max_m = 0.0;    ///< No returns beyond.
  /// Where a point comes back with a probability of a half beyond and before the data sheet's
  /// range, and the width of that logistic curve.
  double far_half_m = 0.0, far_width_m = 0.0, near_half_m = 0.0, near_width_m = 0.0;
  double projector_width_deg = 0.0;   ///< Whole angle.
  double projector_height_deg = 0.0;  ///< Whole angle.
  double sigma_m = 0.0;               ///< 1 sigma of depth at the sweet spot, normal incidence.
  double scan_time_s = 0.0;
  double mass_kg = 0.0;                     ///< With bracket.
  double mass_centre_m = 0.0;               ///< Along z of the housing's frame (HousingPose).
  Vector3 inertia_box_m = Vector3::Zero();  ///< Sides of the box whose inertia it has.
  /// Housing: length along the baseline, width across, depth along the line of sight.
  double housing_x_m = 0.0, housing_y_m = 0.0, housing_z_m = 0.0;
};

/// Columns and rows of one of the spec's resolutions. Throws Error(kConfig) naming those for
/// another text; empty: the first.
struct ScanSize {
  int width = 0, height = 0;
};
ScanSize SizeOfScan(const ScannerSpec& spec, const std::string& resolution);

/// Pose of the housing's frame (H) in the camera frame S: origin on the front face half way between
/// camera and projector, x along the baseline to the projector, z out of the front. Both apertures
/// lie in the front face (z 0 of H); the camera is turned by `toe_in_deg` towards the projector, so
/// the housing stands askew in S. The projector is on S's +x side: with the arm's scan poses the
/// side away from the robot's base, so the forearm never stands in the light.
RigidTransform HousingPose(const ScannerSpec& spec);

/// Pose of the projector (P, z along its optical axis) in S: mirror image of the camera in H.
RigidTransform ProjectorPose(const ScannerSpec& spec);

/// Of a scanner file, shipped or a user's own. Throws Error(kConfig) with file:line:column.
ScannerSpec ReadScanner(const ModelFile& file);

}  // namespace tubetwin
