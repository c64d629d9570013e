#include "models/layout.h"

#include <algorithm>
#include <cmath>

#include "models/scanner_spec.h"

namespace tubetwin {
namespace {

constexpr double kScanHeight_m = 0.515;   // scanner origin over the floor
constexpr double kCovered_m = 0.13;       // everything up to here over the floor is seen
constexpr double kTipsBeyondE_m = 0.019;  // closed fingers, with what they advance while closing
constexpr double kTipsOverWall_m = 0.05;

/// Places of the views along one direction, relative to the middle of the bin. The study's own
/// places for the sizes that it was made for; otherwise evenly spread, the outer views flush with
/// the walls.
std::vector<double> ViewOffsets(double extent_m, double field_m) {
  constexpr double kTolerance_m = 0.005;  // the study's floor is 0.80 x 0.60
  if (extent_m > 0.70 && extent_m < 0.80 + kTolerance_m) {
    const std::vector<double> studied = {-0.29, -0.10, 0.10, 0.29};
    if (2 * studied.back() + field_m >= extent_m) return studied;
  }
  if (extent_m > 0.50 && extent_m < 0.60 + kTolerance_m) {
    const std::vector<double> studied = {-0.145, 0.145};
    if (2 * studied.back() + field_m >= extent_m) return studied;
  }
  const int count = std::max(1, static_cast<int>(std::ceil(extent_m / field_m - 1e-9)));
  std::vector<double> offsets;
  for (int i = 0; i < count; ++i) {
    const double share = count == 1 ? 0.5 : static_cast<double>(i) / (count - 1);
    offsets.push_back((share - 0.5) * std::max(0.0, extent_m - field_m));
  }
  return offsets;
}

}  // namespace

std::vector<RigidTransform> DefaultScanPoses(const Bin& bin) {
  const ScannerSpec spec;
  const CellLayout layout;
  const double tips_below_m =
      (layout.X_FS.inverse() * layout.X_FE.translation()).z() + kTipsBeyondE_m;
  const double height_m = std::max(kScanHeight_m, bin.wall_m() + kTipsOverWall_m + tips_below_m);
  // Field at the top of what has to be seen, where it is smallest.
  const double depth_m = height_m - kCovered_m;
  constexpr double kEdge_m = 0.004;  // not counted on: the outermost pixels
  const double field_x_m = spec.full_width * depth_m / spec.focal_px - kEdge_m;
  const double field_y_m = spec.full_height * depth_m / spec.focal_px - kEdge_m;
  const Matrix3 R_BN = bin.X_BN.linear().cwiseAbs();
  const double extent_x_m = R_BN(0, 0) * bin.size_m[0] + R_BN(0, 1) * bin.size_m[1];
  const double extent_y_m = R_BN(1, 0) * bin.size_m[0] + R_BN(1, 1) * bin.size_m[1];
  const Matrix3 R_BS = RotX(kPi);  // straight down, image x along B's x
  std::vector<RigidTransform> X_BS;
  bool forward = true;
  for (const double x : ViewOffsets(extent_x_m, field_x_m)) {
    auto row = ViewOffsets(extent_y_m, field_y_m);
    if (!forward) std::reverse(row.begin(), row.end());  // to and fro: the shortest way
    forward = !forward;
    for (const double y : row) {
      X_BS.push_back(MakeTransform(R_BS, bin.X_BN.translation() + Vector3(x, y, height_m)));
    }
  }
  return X_BS;
}

}  // namespace tubetwin
