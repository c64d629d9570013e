#pragma once

#include <memory>
#include <vector>

#include "models/base/frames.h"
#include "twin/render/scan/scan_geometry.h"

namespace tubetwin {

/// Pinhole of a scan: square pixels, principal point at the centre.
struct Pinhole {
  int width = 0, height = 0;
  float focal_px = 0;
  /// Point at depth 1 on the ray through the centre of a pixel.
  float x(int column) const { return (column + 0.5f - 0.5f * width) / focal_px; }
  float y(int row) const { return (row + 0.5f - 0.5f * height) / focal_px; }
};

/// What the camera's rays met, one plane per figure. Rows of `stride` values; rows and columns are
/// padded to whole ray packets, and the padding holds rays just outside the image.
struct HitImage {
  static constexpr int kPacketSide = 4;  ///< Rays are cast in squares of this many pixels.

  explicit HitImage(const Pinhole& pinhole);

  int stride = 0;
  /// Depth along z of S; 0: nothing was hit.
  std::unique_ptr<float[]> z_m;
  /// Cosine of the angle between surface normal and camera ray, 0..1.
  std::unique_ptr<float[]> cos_camera;
  /// Same for the projector's ray; 0: the projector's light does not get there (shadow, back side,
  /// outside of its frustum).
  std::unique_ptr<float[]> cos_projector;
  /// Cosine between the normal and the direction half way between camera and projector: 1 where the
  /// surface mirrors one into the other.
  std::unique_ptr<float[]> cos_mirror;
  /// Capsules first, then boxes, in the geometry's order; -1: nothing.
  std::unique_ptr<int[]> shape;

  std::size_t Index(int row, int column) const {
    return static_cast<std::size_t>(row) * stride + column;
  }
};

/// Embree scene of one geometry seen from one scanner pose; the only place that knows Embree.
/// Immutable after construction; CastRows may run on many threads.
class RayScene {
 public:
  /// Throws Error(kInternal) when Embree cannot build the scene.
  RayScene(const ScanGeometry& geometry, const RigidTransform& X_BS, const ScannerSpec& spec);
  ~RayScene();

  /// Casts camera and projector rays for rows [first, last); `first` is a multiple of kPacketSide.
  /// Without `shadows` the light gets everywhere, at a cosine of at least 0.001.
  void CastRows(const Pinhole& pinhole, int first, int last, bool shadows, HitImage& hits) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
