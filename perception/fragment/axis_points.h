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

/// Which points can belong to a tube in, on or out over the bin; everything else is the known cell.
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
  /// Floor points end here: noise at twice the data sheet plus hand-eye error stays below.
  static constexpr float kFloor_m = 0.003f;
  /// Points this close to a wall belong to it; of a tube that leans there only the strip that turns
  /// to the wall is lost.
  static constexpr float kWall_m = 0.0025f;
  /// Nothing that lies in a bin is higher; the gripper's fingers are.
  static constexpr float kCeiling_m = 0.25f;
  float half_x_, half_y_, wall_, margin_;
};

/// What a part of a view shows of the foreground: blocks with a normal from a small window of their
/// neighbours, and those without, where the surface grazes the ray, ends or is not smooth.
struct SurfaceOfView {
  std::vector<SurfacePoint> points;
  std::vector<Eigen::Vector3f> rejected_N;
};

/// Rows of blocks that are looked at together; results do not depend on who looks at which.
inline constexpr int kRowsPerBand = 64;
static_assert(kRowsPerBand % kBlocksPerCell == 0);

/// Reads the pixels of the band'th kRowsPerBand rows of blocks (and of a few neighbours) once:
/// returns the surface there and fills the depths of that part of `image`, which belongs to
/// `raster`. Points come in raster order. Thread safe for different bands.
SurfaceOfView LookAtBand(const ViewRaster& raster, const Foreground& foreground, double radius_m,
                         int band, ViewImage& image);

}  // namespace tubetwin
