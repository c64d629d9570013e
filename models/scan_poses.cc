#include <algorithm>
#include <cmath>

#include "models/cell_model.h"

namespace tubetwin {
namespace {

constexpr double kTipsBeyondE_m = 0.019;  // closed fingers, with what they advance while closing
constexpr double kTipsOverWall_m = 0.05;

/// Places of the views along one direction, relative to the middle of the bin: the layout's own for
/// the sizes that they were made for, where they see up to the walls; otherwise evenly spread, the
/// outer views flush with the walls.
std::vector<double> ViewOffsets(double extent_m, double field_m,
                                const CellLayout::ScanOffsets& known) {
  if (!known.offsets_m.empty() && extent_m > known.extent_m[0] && extent_m < known.extent_m[1] &&
      2 * known.offsets_m.back() + field_m >= extent_m) {
    return known.offsets_m;
  }
  const int count = std::max(1, static_cast<int>(std::ceil(extent_m / field_m - 1e-9)));
  std::vector<double> offsets;
  for (int i = 0; i < count; ++i) {
    const double share = count == 1 ? 0.5 : static_cast<double>(i) / (count - 1);
    offsets.push_back((share - 0.5) * std::max(0.0, extent_m - field_m));
  }
  return offsets;
}

/// Looking straight down from (x, y), height `z`, all in B; or, when the projector stands beyond
/// the bin's wall at `wall_x` and that wall's shadow could hide a tube, from inside the bin, tilted
/// outward: then the projector is inside too and lights the floor up to the wall.
RigidTransform LookFrom(const ScannerSpec& spec, double x, double y, double z, double wall_x,
                        double wall_m, double floor_z, double radius_m) {
  // A narrower shadow hides no tube: it rises out of it. Thick ones are looked at like those of
  // 20 mm.
  const double max_shadow_m = 2.2 * std::min(radius_m, kThinnestUsual_m);
  // Just enough that the wall is still seen as high as from the place straight above.
  const double tilt = Radians(10.0);
  constexpr double kInside_m = 0.004;
  const double toe_in = Radians(spec.toe_in_deg);
  const Vector3 p_SP = spec.baseline_m * Vector3(std::cos(toe_in), 0, std::sin(toe_in));
  const Matrix3 down = RotX(kPi);  // image x along B's x
  const Vector3 p_BP = Vector3(x, y, z) + down * p_SP;
  const double rim_z = floor_z + wall_m;
  const double shadow_m = wall_m * (p_BP.x() - wall_x) / (p_BP.z() - rim_z);
  if (shadow_m < max_shadow_m) return MakeTransform(down, Vector3(x, y, z));
  const Matrix3 tilted = RotY(-tilt) * down;
  return MakeTransform(tilted, Vector3(wall_x - kInside_m - (tilted * p_SP).x(), y, z));
}

/// Views straight down that cover the bin.
std::vector<RigidTransform> CoveringPoses(const CellModel& model, const Bin& bin, double radius_m) {
  const ScannerSpec& spec = model.scanner;
  const CellLayout& layout = model.layout;
  const double tips_below_m =
      (layout.X_FS.inverse() * layout.X_FE.translation()).z() + kTipsBeyondE_m;
  const double height_m =
      std::max(layout.scan_height_m, bin.wall_m() + kTipsOverWall_m + tips_below_m);
  // Field at the top of what has to be seen, where it is smallest.
  const double depth_m = height_m - layout.scan_covered_m;
  constexpr double kEdge_m = 0.004;  // not counted on: the outermost pixels
  const double field_x_m = spec.full_width * depth_m / spec.focal_px - kEdge_m;
  const double field_y_m = spec.full_height * depth_m / spec.focal_px - kEdge_m;
  const Matrix3 R_BN = bin.X_BN.linear().cwiseAbs();
  const double extent_x_m = R_BN(0, 0) * bin.size_m[0] + R_BN(0, 1) * bin.size_m[1];
  const double extent_y_m = R_BN(1, 0) * bin.size_m[0] + R_BN(1, 1) * bin.size_m[1];
  std::vector<RigidTransform> X_BS;
  bool forward = true;
  const Vector3& p_BN = bin.X_BN.translation();
  for (const double x : ViewOffsets(extent_x_m, field_x_m, layout.scan_offsets_x)) {
    auto row = ViewOffsets(extent_y_m, field_y_m, layout.scan_offsets_y);
    if (!forward) std::reverse(row.begin(), row.end());  // to and fro: the shortest way
    forward = !forward;
    for (const double y : row) {
      X_BS.push_back(LookFrom(spec, p_BN.x() + x, p_BN.y() + y, p_BN.z() + height_m,
                              p_BN.x() + 0.5 * extent_x_m, bin.wall_m(), p_BN.z(), radius_m));
    }
  }
  return X_BS;
}

}  // namespace

std::vector<RigidTransform> ScanPosesOf(const CellModel& model, const Bin& bin, double radius_m) {
  const CellLayout& layout = model.layout;
  if (layout.scanner_mount == CellLayout::ScannerMount::kStand) return {layout.X_BS};
  if (!layout.scan_poses_BS.empty()) return layout.scan_poses_BS;
  return CoveringPoses(model, bin, radius_m);
}

}  // namespace tubetwin
