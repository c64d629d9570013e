#include "twin/render/scan/ray_capsules.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <embree3/rtcore.h>

namespace tubetwin {
namespace {

constexpr unsigned kLanes = 16;  // Rays that are tested at a time.

/// Some rays of a packet, copied so that nothing else can change them.
struct Lanes {
  float org_x[kLanes], org_y[kLanes], org_z[kLanes], near[kLanes];
  float dir_x[kLanes], dir_y[kLanes], dir_z[kLanes], time[kLanes], far[kLanes];
};

/// Rays [first, first + n) of a packet of `count`, as Embree lays them out: each figure `count`
/// times, in the order of Lanes.
void Load(const RTCRayN* rays, unsigned count, unsigned first, unsigned n, Lanes& out) {
  const float* from = reinterpret_cast<const float*>(rays) + first;
  float* to = out.org_x;
  for (unsigned figure = 0; figure < sizeof(Lanes) / sizeof out.org_x; ++figure) {
    std::memcpy(to, from, n * sizeof(float));
    from += count;
    to += kLanes;
  }
}

struct Meeting {
  float t[kLanes], x[kLanes], y[kLanes], z[kLanes];  ///< Ray parameter, outward normal (not unit).
  int hit[kLanes];
};

// By value, so that no choice between addresses keeps the compiler from vector instructions.
float Larger(float a, float b) { return a > b ? a : b; }
float Smaller(float a, float b) { return a < b ? a : b; }

/// First meeting of rays with the capsule from outside. The ray's origin is
/// moved next to the capsule and the cylinder is solved across its axis, so that single precision
/// suffices. Without branches: the compiler makes vector instructions of it.
void Meet(const RayCapsule& capsule, const Lanes& rays, Meeting& out) {
  const Eigen::Vector3f axis = capsule.b - capsule.a, middle = 0.5f * (capsule.a + capsule.b);
  const float ax = axis.x(), ay = axis.y(), az = axis.z();
  const float mx = middle.x(), my = middle.y(), mz = middle.z();
  const float cx = capsule.a.x(), cy = capsule.a.y(), cz = capsule.a.z();
  const float per_axis2 = 1.0f / Larger(axis.squaredNorm(), 1e-14f);
  const float r2 = capsule.radius_m * capsule.radius_m;
  for (unsigned i = 0; i < kLanes; ++i) {
    const float dx = rays.dir_x[i], dy = rays.dir_y[i], dz = rays.dir_z[i];
    const float dd = dx * dx + dy * dy + dz * dz, per_dd = 1.0f / dd;
    const float shift =
        (dx * (mx - rays.org_x[i]) + dy * (my - rays.org_y[i]) + dz * (mz - rays.org_z[i])) *
        per_dd;
    // From end a to the moved origin.
    const float ox = rays.org_x[i] + shift * dx - cx;
    const float oy = rays.org_y[i] + shift * dy - cy;
    const float oz = rays.org_z[i] + shift * dz - cz;
    const float along_d = (ax * dx + ay * dy + az * dz) * per_axis2;
    const float along_o = (ax * ox + ay * oy + az * oz) * per_axis2;
    const float px = dx - along_d * ax, py = dy - along_d * ay, pz = dz - along_d * az;
    const float qx = ox - along_o * ax, qy = oy - along_o * ay, qz = oz - along_o * az;
    // The floor keeps a ray along the axis finite; its ends decide then.
    const float a = Larger(px * px + py * py + pz * pz, 1e-12f * dd);
    const float b = px * qx + py * qy + pz * qz;
    const float c = qx * qx + qy * qy + qz * qz - r2;
    const float h = b * b - a * c;
    const float t_side = (-b - std::sqrt(Larger(h, 0.0f))) / a;
    const float along = along_o + t_side * along_d;
    // Else the sphere at the end on that side; rays that miss the cylinder miss it as well.
    const float end = along <= 0.0f ? 0.0f : 1.0f;
    const float ex = ox - end * ax, ey = oy - end * ay, ez = oz - end * az;
    const float b_end = dx * ex + dy * ey + dz * ez;
    const float h_end = b_end * b_end - dd * (ex * ex + ey * ey + ez * ez - r2);
    const float t_end = (-b_end - std::sqrt(Larger(h_end, 0.0f))) * per_dd;
    const bool side = (along > 0.0f) & (along < 1.0f);
    const float t = side ? t_side : t_end;
    const float from = side ? along : end;
    const float t_ray = shift + t;
    out.t[i] = t_ray;
    out.x[i] = ox + t * dx - from * ax;
    out.y[i] = oy + t * dy - from * ay;
    out.z[i] = oz + t * dz - from * az;
    const float smaller = side ? h : Smaller(h, h_end);  // Not negative where the ray meets it.
    out.hit[i] = (smaller >= 0.0f) & (t_ray > rays.near[i]) & (t_ray < rays.far[i]) ? 1 : 0;
  }
}

/// Calls `take(ray, lane, meeting)` for each ray of a packet of `count` that meets the capsule.
template <class Take>
void ForMeetings(const RayCapsule& capsule, const RTCRayN* rays, const int* valid, unsigned count,
                 Take take) {
  Lanes lanes{};
  Meeting meeting;
  for (unsigned first = 0; first < count; first += kLanes) {
    const unsigned n = std::min(kLanes, count - first);
    Load(rays, count, first, n, lanes);
    Meet(capsule, lanes, meeting);
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
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
  ForMeetings(CapsuleOf(args->geometryUserPtr, args->primID), rays, args->valid, n,
              [&](unsigned ray, unsigned lane, const Meeting& meeting) {
                RTCRayN_tfar(rays, n, ray) = meeting.t[lane];
                RTCHitN_Ng_x(hits, n, ray) = meeting.x[lane];
                RTCHitN_Ng_y(hits, n, ray) = meeting.y[lane];
                RTCHitN_Ng_z(hits, n, ray) = meeting.z[lane];
                RTCHitN_primID(hits, n, ray) = args->primID;
                RTCHitN_geomID(hits, n, ray) = args->geomID;
              });
}

void Occluded(const RTCOccludedFunctionNArguments* args) {
  const unsigned n = args->N;
  ForMeetings(CapsuleOf(args->geometryUserPtr, args->primID), args->ray, args->valid, n,
              [&](unsigned ray, unsigned, const Meeting&) {
                RTCRayN_tfar(args->ray, n, ray) = -std::numeric_limits<float>::infinity();
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
