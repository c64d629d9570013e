#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "models/bin.h"
#include "perception/view/view_raster.h"

namespace tubetwin {

/// A surface point with the place where a tube's axis would be behind it. Frame N.
struct SurfacePoint {
  Eigen::Vector3f p_N;
  Eigen::Vector3f n_N;  ///< Unit normal, towards the view's sensor.
  Eigen::Vector3f a_N;  ///< p - r n.
  float weight;         ///< Cosine of the incidence.
};

/// Which points can belong to a tube in the bin, on its rim or hanging out of it; all others belong
/// to the cell (floor, walls, gripper) and are ignored.
class Foreground {
 public:
  /// `margin_m`: how far outside the walls a tube may reach.
  Foreground(const Bin& bin, double margin_m)
      : half_x_(static_cast<float>(bin.half_x_m())),
        half_y_(static_cast<float>(bin.half_y_m())),
        wall_(static_cast<float>(bin.wall_m())),
        margin_(static_cast<float>(margin_m)) {}

  /// Of a point in N. Has no branches, so that whole rows are tested at once; false for NaN.
  bool Contains(float x, float y, float z) const {
    constexpr float kThick_m = static_cast<float>(Bin::kWallThickness_m);
    const float out = std::max(std::abs(x) - half_x_, std::abs(y) - half_y_);
    // Distance to the solid frame of the four walls: 0 within half_x .. half_x + thickness.
    const float sideways = std::max(std::max(-out, out - kThick_m), 0.0f);
    const float above = std::max(0.0f, z - wall_);
    const bool off_wall = sideways * sideways + above * above > kWall_m * kWall_m;
    return (z >= kFloor_m) & (z <= std::max(kCeiling_m, wall_ + 0.1f)) & (out <= margin_) &
           off_wall;
  }

 private:
  /// Points below are floor: its noise at twice the data sheet's value plus the hand-eye error
  /// stays under this height.
  static constexpr float kFloor_m = 0.003f;
  /// Points this close to a wall are wall. Of a tube that leans against it only the strip that
  /// faces the wall is lost.
  static constexpr float kWall_m = 0.0025f;
  /// Higher points are the gripper's fingers: nothing that lies in a bin reaches so high.
  static constexpr float kCeiling_m = 0.25f;
  float half_x_, half_y_, wall_, margin_;
};

/// The foreground in a part of a view: blocks whose normal could be fitted to a small window of
/// neighbours, and the positions of those without a normal (the surface is seen at a grazing angle,
/// ends there or is not smooth).
struct SurfaceOfView {
  std::vector<SurfacePoint> points;
  std::vector<Eigen::Vector3f> rejected_N;
};

/// Rows of blocks that are read together: the unit of work for one thread.
inline constexpr int kRowsPerBand = 64;
static_assert(kRowsPerBand % kBlocksPerCell == 0);

/// Reads band number `band` (kRowsPerBand rows of blocks) of a view: returns the surface there, in
/// raster order, and fills that part of the view's depth image `image`, made by MakeEmptyImage.
/// Thread safe for different bands.
SurfaceOfView ExtractSurfaceBand(const ViewRaster& raster, const Foreground& foreground,
                                 double radius_m, int band, ViewImage& image);

}  // namespace tubetwin
