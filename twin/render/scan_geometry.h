#pragma once

#include <cstdint>
#include <vector>

#include "hw_bridge/base/cloud.h"
#include "hw_bridge/base/parallel.h"
#include "hw_bridge/base/random.h"
#include "models/scanner_spec.h"

namespace tubetwin {

/// What rays can hit: exact shapes, frame B, each with the label that its points get.
struct ScanGeometry {
  struct Capsule {
    Vector3 a, b;
    double radius_m;
    std::uint32_t label;
    float albedo;  ///< 0..1, share of the light that comes back.
  };
  struct Box {
    RigidTransform X_BBox;
    Vector3 half_m;
    std::uint32_t label;
    float albedo;
  };
  std::vector<Capsule> capsules;
  std::vector<Box> boxes;
};

struct ScanSettings {
  int width = 1032, height = 772;
  ScannerSpec spec;
  bool hard_range = false;  ///< Cut at the data sheet's range.
  bool noise = true;        ///< Off: exact geometry, shadows kept.
  double noise_scale = 1.0;
  bool labels = false;
};

/// Pose of the projector (P, z along its optical axis) in the camera frame S. Camera and projector
/// stand symmetrically in the housing, `baseline_m` apart, each turned by `toe_in_deg` towards the
/// other; the projector is on S's +x side. With the arm's scan poses that is the side away from the
/// robot's base, so the forearm never stands in the light.
RigidTransform ProjectorPose(const ScannerSpec& spec);

/// One scan by ray casting (Embree): camera rays, projector shadow, incidence drop-out, flying
/// pixels at edges, soft range, noise (design.md 5; details at the top of scan.cc). `X_BS` is the
/// true pose; the result's X_NS is left to the caller. Intensity is albedo times the cosine of the
/// projector's incidence. Random numbers depend on stream and pixel only: the same cloud for any
/// thread count. Throws Error(kInternal) when Embree fails.
OrganizedCloud CastScan(const ScanGeometry& geometry, const RigidTransform& X_BS,
                        const ScanSettings& settings, RandomStream stream, Parallelism parallelism);

}  // namespace tubetwin
