#pragma once

#include <vector>

#include <embree3/rtcore.h>

#include "hw_bridge/base/frames.h"

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
RTCGeometry NewCapsuleGeometry(RTCDevice device, const std::vector<RayCapsule>& capsules);

}  // namespace tubetwin
