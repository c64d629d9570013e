#pragma once

#include <vector>

#include "perception/fragment/axis_points.h"

namespace tubetwin {

/// NaN columns before the first and after the last block of a row, so that windows need no test for
/// the image's limits.
inline constexpr int kRowMargin = 16;

/// One row of blocks, structure of arrays; column c is at index c + kRowMargin.
struct BlockRow {
  /// Directions x/z and y/z and the inverse depth 1/z of the foreground; NaN elsewhere. A plane is
  /// linear in these, and noise along the ray changes only the last.
  std::vector<float> u, v, w;
  std::vector<float> near, far;  ///< Of all returns; infinity and 0 without.
  /// Columns from and to (excluded) of stretches with some foreground.
  std::vector<std::pair<int, int>> spans;
};

/// Averages the pixels of a raster to blocks, one row of blocks at a time. Has working memory of
/// its own: one object per thread.
class DepthBlocks {
 public:
  DepthBlocks(const ViewRaster& raster, const Foreground& foreground);

  /// Writes row `row` of the raster's blocks into `out`; a row outside of the image is empty.
  void Fill(int row, BlockRow& out);

 private:
  void SumPixels(int row);
  void MeanOfBlocks(BlockRow& out);
  void KeepForeground(BlockRow& out);

  const ViewRaster& raster_;
  const Foreground foreground_;
  float R_NS_[9], p_NS_[3];
  std::vector<float> x_, y_, z_, count_, near_, far_;  ///< Of the pixels of one row of blocks.
};

/// Plane through the window around each of four neighbouring blocks.
struct WindowPlanes {
  float a[4], b[4], c[4];  ///< 1/z = a x/z + b y/z + c: (a, b, c) is normal, away from the sensor.
  float variance[4];       ///< Of 1/z about it.
  float count[4];
  float roundness[4];  ///< 0 for a line of blocks, 1 for a square.
};

/// Planes at columns c .. c + 3 of the middle one of `rows` (2 half + 1 of them). Neighbours that
/// are more than `reach_m` nearer or farther belong to another surface.
WindowPlanes FitWindows(const BlockRow* const* rows, int half, int column, float reach_m);

}  // namespace tubetwin
