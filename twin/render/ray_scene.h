#pragma once

#include <memory>
#include <vector>

#include "hw_bridge/base/frames.h"
#include "twin/render/scan_geometry.h"

namespace tubetwin {

/// What one camera ray met. Frame S.
struct RayHit {
  float z_m = 0;            ///< Depth along S's z; 0: nothing was hit.
  float cos_camera = 0;     ///< Of the angle between surface normal and camera ray, 0..1.
  float cos_projector = 0;  ///< Same for the projector's ray; 0 or less: the projector's light does
                            ///< not get there (shadow, back side, outside of its frustum).
  int shape = -1;           ///< Capsules first, then boxes, in the geometry's order.
};

/// Pinhole of a scan: square pixels, principal point at the centre.
struct Pinhole {
  int width = 0, height = 0;
  float focal_px = 0;
  /// Point at depth 1 on the ray through the centre of a pixel.
  float x(int column) const { return (column + 0.5f - 0.5f * width) / focal_px; }
  float y(int row) const { return (row + 0.5f - 0.5f * height) / focal_px; }
};

/// Embree scene of one geometry seen from one scanner pose; the only place that knows Embree.
/// Immutable after construction; CastRows may run on many threads.
class RayScene {
 public:
  /// Throws Error(kInternal) when Embree cannot build the scene.
  RayScene(const ScanGeometry& geometry, const RigidTransform& X_BS, const ScannerSpec& spec);
  ~RayScene();

  /// Casts camera and projector rays for rows [first, last); `hits` is the whole image.
  void CastRows(const Pinhole& pinhole, int first, int last, std::vector<RayHit>& hits) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
