#pragma once

#include <optional>
#include <vector>

#include "models/base/cloud/cloud.h"
#include "perception/view/view_image.h"

namespace tubetwin {

/// One view as the image of a pinhole camera. Its pixels are averaged in square blocks, of which
/// the number of pixels is chosen so that blocks have about the same size in space for every
/// scanner. Frame S, metres. Keeps a reference to its cloud.
struct ViewRaster {
  int width = 0, height = 0;              ///< In pixels; 0 when the cloud holds no point.
  double fx = 1, fy = 1, cx = 0, cy = 0;  ///< column = fx x/z + cx, row = fy y/z + cy.
  int block = 1;                          ///< Pixels on a block's side.
  double pitch_m = 0.0;                   ///< Width of a block at the median depth.
  RigidTransform X_NS = RigidTransform::Identity();
  const OrganizedCloud* cloud = nullptr;  ///< Holds the pixels; null: they are in projected_S.
  /// Pixels of a cloud that was not one camera's image and was projected onto one.
  std::vector<Eigen::Vector3f> projected_S;

  /// [height * width], NaN when invalid.
  const Eigen::Vector3f* pixels_S() const {
    return cloud != nullptr ? cloud->p_SP.data() : projected_S.data();
  }
  const Eigen::Vector3f& At(int column, int row) const {
    return pixels_S()[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(column)];
  }
  int block_columns() const { return width / block; }
  int block_rows() const { return height / block; }
};

/// Points nearer to the scanner are no measurements.
inline constexpr float kNearest_m = 0.05f;
/// A block that spans more depth than this shows an edge or a flying pixel.
inline constexpr float kEdgeDepth_m = 0.003f;

/// The raster of an organised cloud that fits a pinhole camera is the cloud's own. Every other
/// cloud is projected onto a pinhole camera at its own pose or, when points lie beside or behind
/// that, at a place 1.5 m above the bin. Blocks are about `pitch_m` wide. Throws Error(kBadData)
/// when the pose is not finite or the sizes disagree.
ViewRaster MakeViewRaster(const OrganizedCloud& cloud, double pitch_m);

/// Unit normal of the surface at a pixel, towards the sensor, frame S, from four neighbours `near`
/// to twice as many pixels away; nothing at holes and edges of the image. Neighbours next to each
/// other are rare on walls, which drop many returns.
std::optional<Vector3> NormalAt(const ViewRaster& view, int column, int row, int near);

/// The view's depth image, without depths: its cells are kBlocksPerCell blocks wide.
ViewImage MakeEmptyImage(const ViewRaster& raster);

}  // namespace tubetwin
