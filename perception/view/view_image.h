#pragma once

#include <vector>

#include "models/base/frames.h"

namespace tubetwin {

/// Blocks of ViewRaster on the side of a cell of the depth image.
inline constexpr int kBlocksPerCell = 2;

/// Depth image of one view, to find out what the view says about a place (QueryVisibility). Columns
/// and rows as in the camera image; frame S, metres.
struct ViewImage {
  int width = 0, height = 0;  ///< In cells; 0 when the cloud holds no point.
  double pitch_m = 0.0;       ///< Width of a cell at the median depth.
  /// Pinhole of the cells: column = fx x/z + cx, row = fy y/z + cy; a cell's centre has whole
  /// numbers.
  double fx = 1.0, fy = 1.0, cx = 0.0, cy = 0.0;
  RigidTransform X_NS = RigidTransform::Identity();
  RigidTransform X_SN = RigidTransform::Identity();
  std::vector<float> z_near;  ///< Smallest and largest depth of a cell; NaN without return.
  std::vector<float> z_far;

  std::size_t Index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
};

/// What a view says about the claim that a tube's axis passes through a point; the later in this
/// list, the stronger the statement.
enum class Visibility {
  kOutside,      ///< The point is outside of the image.
  kUnknown,      ///< There are no depths around the point.
  kHidden,       ///< Something nearer to the scanner occludes the point.
  kSurface,      ///< A surface is where the tube's surface would be.
  kSeenThrough,  ///< The view sees something farther away: no tube is there.
};

/// What one view says about a tube of that radius with its axis through `p_NC`. `slack_m`: how far
/// behind the tube's surface the view must see for kSeenThrough.
Visibility QueryVisibility(const ViewImage& view, const Vector3& p_NC, double radius_m,
                           double slack_m);

}  // namespace tubetwin
