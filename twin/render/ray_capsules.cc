#include "twin/render/ray_capsules.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <embree3/rtcore.h>

namespace tubetwin {
namespace {

/// Rays of a packet as Embree lays them out: each figure `count` times, one after the other.
struct Packet {
  float *org_x, *org_y, *org_z, *near, *dir_x, *dir_y, *dir_z, *far;
  Packet(RTCRayN* rays, unsigned count) {
    float* at = reinterpret_cast<float*>(rays);
    org_x = at, org_y = at + count, org_z = at + 2 * count, near = at + 3 * count;
    dir_x = at + 4 * count, dir_y = at + 5 * count, dir_z = at + 6 * count, far = at + 8 * count;
  }
};

constexpr unsigned kLanes = 16;  // Rays that are tested at a time.

struct Meeting {
  float t[kLanes], x[kLanes], y[kLanes], z[kLanes];  ///< Ray parameter, outward normal (not unit).
  int hit[kLanes];
};

/// First meeting of rays [first, first + count) with the capsule from outside. The ray's origin is
/// moved next to the capsule and the cylinder is solved across its axis, so that single precision
/// suffices. Without branches: the compiler makes vector instructions of it.
template <class Count>
void Meet(const RayCapsule& capsule, const Packet& rays, unsigned first, Count count,
          Meeting& out) {
  const Eigen::Vector3f axis = capsule.b - capsule.a, middle = 0.5f * (capsule.a + capsule.b);
  const float ax = axis.x(), ay = axis.y(), az = axis.z();
  const float per_axis2 = 1.0f / std::max(axis.squaredNorm(), 1e-14f);
  const float r2 = capsule.radius_m * capsule.radius_m;
  for (unsigned i = 0; i < count; ++i) {
    const unsigned k = first + i;
    const float dx = rays.dir_x[k], dy = rays.dir_y[k], dz = rays.dir_z[k];
    const float dd = dx * dx + dy * dy + dz * dz;
    const float shift = (dx * (middle.x() - rays.org_x[k]) + dy * (middle.y() - rays.org_y[k]) +
                         dz * (middle.z() - rays.org_z[k])) /
                        dd;
    // From end a to the moved origin.
    const float ox = rays.org_x[k] + shift * dx - capsule.a.x();
    const float oy = rays.org_y[k] + shift * dy - capsule.a.y();
    const float oz = rays.org_z[k] + shift * dz - capsule.a.z();
    const float along_d = (ax * dx + ay * dy + az * dz) * per_axis2;
    const float along_o = (ax * ox + ay * oy + az * oz) * per_axis2;
    const float px = dx - along_d * ax, py = dy - along_d * ay, pz = dz - along_d * az;
    const float qx = ox - along_o * ax, qy = oy - along_o * ay, qz = oz - along_o * az;
    // The floor keeps a ray along the axis finite; its ends decide then.
    const float a = std::max(px * px + py * py + pz * pz, 1e-12f * dd);
    const float b = px * qx + py * qy + pz * qz;
    const float c = qx * qx + qy * qy + qz * qz - r2;
    const float h = b * b - a * c;
    const float t_side = (-b - std::sqrt(std::max(h, 0.0f))) / a;
    const float along = along_o + t_side * along_d;
    const bool side = along > 0.0f && along < 1.0f;
    // Else the sphere at the end on that side; rays that miss the cylinder miss it as well.
    const float end = along <= 0.0f ? 0.0f : 1.0f;
    const float ex = ox - end * ax, ey = oy - end * ay, ez = oz - end * az;
    const float b_end = dx * ex + dy * ey + dz * ez;
    const float h_end = b_end * b_end - dd * (ex * ex + ey * ey + ez * ez - r2);
    const float t_end = (-b_end - std::sqrt(std::max(h_end, 0.0f))) / dd;
    const float t = side ? t_side : t_end;
    const float from = side ? along : end;
    out.t[i] = shift + t;
    out.x[i] = ox + t * dx - from * ax;
    out.y[i] = oy + t * dy - from * ay;
    out.z[i] = oz + t * dz - from * az;
    out.hit[i] = (h >= 0.0f) & (side | (h_end >= 0.0f)) & (shift + t > rays.near[k]) &
                 (shift + t < rays.far[k]);
  }
}

/// Calls `take(ray, lane, meeting)` for each ray of the packet that meets the capsule.
template <class Take>
void ForMeetings(const RayCapsule& capsule, const Packet& rays, const int* valid, unsigned count,
                 Take take) {
  Meeting meeting;
  for (unsigned first = 0; first < count; first += kLanes) {
    const unsigned n = std::min(kLanes, count - first);
    if (n == kLanes) {
      Meet(capsule, rays, first, std::integral_constant<unsigned, kLanes>(), meeting);
    } else {
      Meet(capsule, rays, first, n, meeting);
    }
    for (unsigned i = 0; i < n; ++i) {
      if (meeting.hit[i] != 0 && valid[first + i] != 0) take(first + i, i, meeting);
    }
  }
}

const RayCapsule& CapsuleOf(const void* capsules, unsigned id) {
  return static_cast<const RayCapsule*>(capsules)[id];
}

void Bounds(const RTCBoundsFunctionArguments* args) {
  constexpr float kMargin_m = 1e-6f;  // Over the rounding of the sums.
  const RayCapsule& capsule = CapsuleOf(args->geometryUserPtr, args->primID);
  const float reach = capsule.radius_m + kMargin_m;
  const Eigen::Vector3f low = capsule.a.cwiseMin(capsule.b).array() - reach;
  const Eigen::Vector3f high = capsule.a.cwiseMax(capsule.b).array() + reach;
  RTCBounds& out = *args->bounds_o;
  out.lower_x = low.x(), out.lower_y = low.y(), out.lower_z = low.z();
  out.upper_x = high.x(), out.upper_y = high.y(), out.upper_z = high.z();
}

void Intersect(const RTCIntersectFunctionNArguments* args) {
  const unsigned n = args->N;
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
  const Packet rays(RTCRayHitN_RayN(args->rayhit, n), n);
  ForMeetings(CapsuleOf(args->geometryUserPtr, args->primID), rays, args->valid, n,
              [&](unsigned ray, unsigned lane, const Meeting& meeting) {
                rays.far[ray] = meeting.t[lane];
                RTCHitN_Ng_x(hits, n, ray) = meeting.x[lane];
                RTCHitN_Ng_y(hits, n, ray) = meeting.y[lane];
                RTCHitN_Ng_z(hits, n, ray) = meeting.z[lane];
                RTCHitN_primID(hits, n, ray) = args->primID;
                RTCHitN_geomID(hits, n, ray) = args->geomID;
              });
}

void Occluded(const RTCOccludedFunctionNArguments* args) {
  const Packet rays(args->ray, args->N);
  ForMeetings(CapsuleOf(args->geometryUserPtr, args->primID), rays, args->valid, args->N,
              [&](unsigned ray, unsigned, const Meeting&) {
                rays.far[ray] = -std::numeric_limits<float>::infinity();
              });
}

}  // namespace

RTCGeometryTy* NewCapsuleGeometry(RTCDeviceTy* device, const std::vector<RayCapsule>& capsules) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  if (geometry == nullptr) return nullptr;
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(capsules.size()));
  // Embree hands the pointer back and never writes through it.
  rtcSetGeometryUserData(geometry, const_cast<RayCapsule*>(capsules.data()));
  rtcSetGeometryBoundsFunction(geometry, Bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, Intersect);
  rtcSetGeometryOccludedFunction(geometry, Occluded);
  return geometry;
}

}  // namespace tubetwin
