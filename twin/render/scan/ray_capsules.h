#pragma once

#include <vector>

#include "models/base/frames.h"

// Embree's handles, named here so that its headers stay in .cc files.
struct RTCDeviceTy;
struct RTCGeometryTy;

namespace tubetwin {

/// A capsule as rays meet it, single precision.
struct RayCapsule {
  Eigen::Vector3f a, b;
  float radius_m;
};

/// New Embree geometry (not committed) whose primitives are the capsules, for packets of rays: one
/// exact test of all rays of a packet at a time, several times faster than Embree's own round
/// curves, which take the rays one by one. Hits give the outward normal. `capsules` must outlive
/// the geometry. Returns null when Embree has no memory.
RTCGeometryTy* NewCapsuleGeometry(RTCDeviceTy* device, const std::vector<RayCapsule>& capsules);

}  // namespace tubetwin
