#pragma once

#include <vector>

#include "models/base/frames.h"

namespace tubetwin {

/// Blocks of ViewRaster on the side of a cell of the depth image.
inline constexpr int kBlocksPerCell = 2;

/// Depths of one view, for the question what it sees at a place. Columns and rows like the camera
/// image; frame S, metres.
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

/// What a view says about a piece of tube whose axis passes through a point, from least to most.
enum class Sight {
  kOutside,      ///< The view does not reach there.
  kUnknown,      ///< No return there.
  kHidden,       ///< Something nearer is in the way.
  kSurface,      ///< A surface lies where the tube's would.
  kSeenThrough,  ///< The view looks past the place: no tube is there.
};

/// Looks at the tube axis point `p_NC` from one view. `slack_m`: how much deeper than the tube's
/// surface the view must see before the tube is denied.
Sight LookAt(const ViewImage& view, const Vector3& p_NC, double radius_m, double slack_m);

}  // namespace tubetwin
