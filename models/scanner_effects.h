#pragma once

#include "models/base/config/config.h"

namespace tubetwin {

/// What makes a scan worse than its geometry, each alone to switch (part of config table
/// [cell.scanner]). Depth z along the camera's axis, incidence between surface normal and ray.
/// Figures without a source are assumptions for a PhoXi S: no noise model of it is published.
struct ScannerEffects {
  /// Empty where something stands between surface and projector, the surface looks away from it, or
  /// its frustum ends.
  bool shadows = true;
  /// Empty outside of the data sheet's range.
  bool hard_range = false;
  /// Beyond that range empty with probability 1/(1+exp((far half - z)/far width)), nearer with
  /// 1/(1+exp((z - near half)/near width)); the scanner's figures (ScannerSpec).
  bool soft_range = true;
  /// Empty with probability 1/(1+exp((75 - a)/3)), a the larger of the incidences of camera and
  /// projector in degrees.
  bool incidence = true;
  /// Light that comes back, s = albedo * cos(projector's incidence) * (sweet spot / z)^2, may be
  /// too little: empty with probability 1/(1+(s/0.03)^4). Dark rubber (albedo 0.12) loses 0.4 % at
  /// 442 mm and normal incidence, half at 76 degrees; at 520 mm 1.3 % and half at 70 degrees.
  bool weak_signal = true;
  /// The mirror image of the projector saturates the camera: empty with probability gloss *
  /// exp(-d^2 / (2 (4 deg)^2)), d between the surface normal and the direction half way between
  /// camera and projector. Also brightens the intensity by that amount.
  bool highlights = true;
  /// At depth edges (a neighbour of 3 x 3 more than 3 mm nearer or farther) 30 % empty, 20 % at a
  /// depth between both, without label.
  bool flying_pixels = true;
  /// Where another surface faces this one within 4 mm (valleys between tubes, bin corners) light
  /// goes two ways: 2 % of points are off by N(0, 1 mm) in depth.
  bool interreflections = true;
  /// Depth error with the scanner's sigma times (z / sweet spot)^2 / cos(camera's incidence, at
  /// most 80 degrees), correlated over 3 to 5 pixels.
  bool noise = true;
  /// Calibration error: a smooth deformation of depth, 0.05 mm rms, wavelength 100 mm, fixed in the
  /// scanner's frame.
  bool bias = true;

  /// Shadows only: exact points where the scanner can see.
  static ScannerEffects Exact();
  void Visit(ConfigVisitor& v);
};

}  // namespace tubetwin
