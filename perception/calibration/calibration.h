#pragma once

#include <string>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "models/base/parallel.h"
#include "models/bin.h"

namespace tubetwin {

/// A cloud of the empty bin, and where the flange was when it was taken.
struct CalibrationView {
  std::string name;      ///< For messages: its file.
  OrganizedCloud cloud;  ///< Its own X_NS is not looked at.
  RigidTransform X_BF = RigidTransform::Identity();
};

/// A place where the tip of a known tool touched the bin's floor or the inner face of a wall.
struct CalibrationTouch {
  std::string name;  ///< For messages: "touch 3".
  bool on_floor = false;
  Vector3 p_B = Vector3::Zero();
};

/// What was seen and touched of a bin of known size, and where all is thought to be.
struct CalibrationInput {
  std::vector<CalibrationView> views;
  std::vector<CalibrationTouch> touches;
  /// The camera on the flange, or in B for one on a stand.
  RigidTransform X_FS = RigidTransform::Identity();
  bool on_stand = false;
  Bin bin;
};

/// How far the points of one plane in one view, or one touch, are from that plane.
struct PlaneResidual {
  std::string name;   ///< Of the view or the touch.
  std::string plane;  ///< "floor", "wall +x".
  int points = 0;
  double rms_m = 0.0;  ///< Of a view without the twentieth part that is furthest off: edges.
};

/// Where scanner or bin are, as all views and touches together tell.
struct Calibration {
  RigidTransform X_FS = RigidTransform::Identity();  ///< X_BS for a scanner on a stand.
  RigidTransform X_BN = RigidTransform::Identity();
  double rms_m = 0.0;                    ///< Over all points and touches.
  std::vector<PlaneResidual> residuals;  ///< In the order of views and touches.
  /// One sigma of what was looked for in the direction that is known least, when each plane of a
  /// view is known to 0.1 mm, each touch to 0.3 mm and the bin's size to 0.5 mm, or as badly as the
  /// worst residual says. Turns count by what they move at 0.3 m.
  double uncertainty_m = 0.0;
  double lean_rad = 0.0;  ///< Of the bin's floor against B's xy plane.
  /// From the start value to what was found.
  double moved_m = 0.0, turned_rad = 0.0;
};

/// The largest residual of a calibration that may be used.
inline constexpr double kMaxResidual_m = 0.001;
/// A start value that is further off may be that of the bin turned by half a turn.
inline constexpr double kDoubtfulTurn_rad = kPi / 4;

// Both take floor and inner walls as planes at right angles, as far apart as the bin's size says,
// to half a millimetre, and find by least squares where scanner or bin must be so that all that was
// seen and touched lies on them. The bin may be anywhere as long as its floor and two walls that
// meet are seen together; of the turns that look the same the one nearest to `bin.X_BN` is taken.
// Both throw Error(kBadData) with what is lacking or wrong: too few planes, poses too much alike, a
// bin that is not empty or of another size, a residual over kMaxResidual_m (naming the worst view
// and plane). Results do not depend on the thread count.

/// Finds X_BN: its place and yaw (a cell file has no other turn), with the scanner where it is said
/// to be.
Calibration CalibrateBin(const CalibrationInput& input, Parallelism parallelism);

/// Finds X_FS (X_BS on a stand) from views at differently turned flanges. The bin's whole pose is
/// found with it and need not be known or level. A scanner on a stand always looks alike: it needs
/// touches besides.
Calibration CalibrateHandEye(const CalibrationInput& input, Parallelism parallelism);

}  // namespace tubetwin
