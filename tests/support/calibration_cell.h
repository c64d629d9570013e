#pragma once

#include <cstdint>

#include "perception/calibration/calibration.h"
#include "tests/support/paper_scan.h"

namespace tubetwin::test {

/// An empty bin under the twin's scanner on the flange of the paper's arm, with its noise: what
/// calibrations are made from.
class CalibrationCell {
 public:
  explicit CalibrationCell(std::uint64_t seed);

  RigidTransform X_FS;         ///< The true one.
  Bin bin;                     ///< Where it truly is.
  double wall_off_m = 0.0;     ///< The wall at +x of N stands so much further in.
  double part_radius_m = 0.0;  ///< A tube lies in the bin.

  /// X_NS of a camera that looks into one of the four corners, tilted outwards and turned about the
  /// vertical.
  static RigidTransform IntoCorner(int corner, double tilt_rad, double turn_rad);
  /// `count` views into the corners in turn, four tilted by about `tilt_deg`, the next
  /// four by a quarter of it, turned by up to `turn_deg`; start values are the true ones.
  CalibrationInput Views(int count, double tilt_deg, double turn_deg = 180.0) const;
  /// One view from there.
  CalibrationView View(const RigidTransform& X_BS, int number) const;
  /// A pose moved by `shift_m` and turned by `turn_rad` in random directions.
  RigidTransform Disturbed(const RigidTransform& X, double shift_m, double turn_rad) const;

 private:
  std::uint64_t seed_;
};

}  // namespace tubetwin::test
