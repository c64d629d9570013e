#pragma once

#include <vector>

#include "hw_bridge/base/cloud.h"

namespace tubetwin {

/// One view reduced to blocks of pixels of about equal size in space: what all later steps look at.
/// Columns and rows of blocks like the camera image; frame S, metres.
struct ViewImage {
  int width = 0, height = 0;  ///< In blocks; 0 when the cloud holds no point.
  double pitch_m = 0.0;       ///< Width of a block at the median depth.
  /// Pinhole of the block image: column = fx x/z + cx, row = fy y/z + cy; a block's centre has
  /// whole numbers.
  double fx = 1.0, fy = 1.0, cx = 0.0, cy = 0.0;
  RigidTransform X_NS = RigidTransform::Identity();
  RigidTransform X_SN = RigidTransform::Identity();
  std::vector<Eigen::Vector3f> p_S;  ///< Mean of a block; NaN when nothing or an edge is in it.
  std::vector<float> z_near;         ///< Smallest and largest depth of a block; NaN without return.
  std::vector<float> z_far;

  std::size_t Index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
};

/// Reduces a cloud to blocks of about `pitch_m`. An organised cloud whose points are those of a
/// pinhole camera keeps its raster; every other cloud is seen anew through a pinhole at its own
/// pose, or, when points lie beside or behind that, at a place 1.5 m above the bin.
/// Throws Error(kBadData) when the pose is not finite or the sizes disagree.
ViewImage MakeViewImage(const OrganizedCloud& cloud, double pitch_m);

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
