#include "twin/render/scan/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <embree3/rtcore.h>

#include "models/base/error.h"
#include "twin/render/scan/ray_capsules.h"

namespace tubetwin {
namespace {

constexpr int kSide = HitImage::kPacketSide;
constexpr int kPacket = kSide * kSide;  // As many as Embree takes at once.

// A shadow ray starts this far off the surface: over Embree's float error (below 1 um at these
// distances), far below what a scanner resolves.
constexpr float kShadowOffset_m = 10e-6f;

// Camera and projector look out of the housing's front face: rays start this far before it.
constexpr float kWindow_m = 0.002f;
constexpr float kFarthest_m = 10.0f;
constexpr float kUnshadowed = 0.001f;  // Least cosine of the light when nothing shades.

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct GeometryDeleter {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using DevicePtr = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using ScenePtr = std::unique_ptr<RTCSceneTy, SceneDeleter>;
using GeometryPtr = std::unique_ptr<RTCGeometryTy, GeometryDeleter>;

void RequireNoError(RTCDevice device, const char* doing) {
  const RTCError code = rtcGetDeviceError(device);
  if (code != RTC_ERROR_NONE) {
    throw Error(ErrorKind::kInternal,
                std::string("Embree: ") + doing + " failed with error " + std::to_string(code));
  }
}

template <class T>
T* NewBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t stride,
             std::size_t count) {
  // Embree pads what it allocates itself, so SSE loads past the last element are safe.
  void* data = rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count);
  if (data == nullptr) throw Error(ErrorKind::kInternal, "Embree: a buffer cannot be allocated");
  return static_cast<T*>(data);
}

std::vector<RayCapsule> CapsulesInS(const ScanGeometry& geometry, const RigidTransform& X_SB) {
  std::vector<RayCapsule> out;
  out.reserve(geometry.capsules.size());
  for (const ScanGeometry::Capsule& capsule : geometry.capsules) {
    out.push_back({(X_SB * capsule.a).cast<float>(), (X_SB * capsule.b).cast<float>(),
                   static_cast<float>(capsule.radius_m)});
  }
  return out;
}

void AddCapsules(RTCDevice device, RTCScene scene, const std::vector<RayCapsule>& capsules) {
  if (capsules.empty()) return;
  const GeometryPtr geometry(NewCapsuleGeometry(device, capsules));
  RequireNoError(device, "making capsules");
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene, geometry.get(), 0);
}

void AddBoxes(RTCDevice device, RTCScene scene, const ScanGeometry& geometry,
              const RigidTransform& X_SB) {
  const std::size_t n = geometry.boxes.size();
  if (n == 0) return;
  const GeometryPtr mesh(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  RequireNoError(device, "making triangles");
  float* vertex = NewBuffer<float>(mesh.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                                   3 * sizeof(float), 8 * n);
  unsigned* index = NewBuffer<unsigned>(mesh.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                        3 * sizeof(unsigned), 12 * n);
  // Corner k has its signs in the bits of k; two triangles per face.
  static constexpr unsigned kFaces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                             {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                             {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (std::size_t i = 0; i < n; ++i) {
    const ScanGeometry::Box& box = geometry.boxes[i];
    for (unsigned k = 0; k < 8; ++k) {
      const Vector3 sign(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
      const Eigen::Vector3f p_S =
          (X_SB * (box.X_BBox * Vector3(sign.cwiseProduct(box.half_m)))).cast<float>();
      std::copy_n(p_S.data(), 3, vertex);
      vertex += 3;
    }
    for (const auto& face : kFaces) {
      for (int c = 0; c < 3; ++c) *index++ = static_cast<unsigned>(8 * i) + face[c];
    }
  }
  rtcCommitGeometry(mesh.get());
  rtcAttachGeometryByID(scene, mesh.get(), 1);
}

}  // namespace

HitImage::HitImage(const Pinhole& pinhole) {
  const auto padded = [](int n) { return (n + kSide - 1) / kSide * kSide; };
  stride = padded(pinhole.width);
  const std::size_t n = static_cast<std::size_t>(stride) * padded(pinhole.height);
  z_m = std::make_unique_for_overwrite<float[]>(n);
  cos_camera = std::make_unique_for_overwrite<float[]>(n);
  cos_projector = std::make_unique_for_overwrite<float[]>(n);
  cos_mirror = std::make_unique_for_overwrite<float[]>(n);
  shape = std::make_unique_for_overwrite<int[]>(n);
}

struct RayScene::Impl {
  DevicePtr device;
  std::vector<RayCapsule> capsules;  ///< The scene's geometry refers to them.
  ScenePtr scene;
  Eigen::Vector3f p_SP = Eigen::Vector3f::Zero();  ///< Projector.
  Eigen::Matrix3f R_PS = Eigen::Matrix3f::Identity();
  float tan_half_width = 0, tan_half_height = 0;

  void CastPacket(const Pinhole& pinhole, int row0, int column0, bool shadows,
                  HitImage& hits) const;
  struct Incidences {
    float cos_camera[kPacket], cos_projector[kPacket], cos_mirror[kPacket];
    alignas(64) int lit[kPacket];
  };
  void Light(const RTCRayHit16& seen, RTCRay16& light, Incidences& out) const;
};

RayScene::RayScene(const ScanGeometry& geometry, const RigidTransform& X_BS,
                   const ScannerSpec& spec)
    : impl_(std::make_unique<Impl>()) {
  Impl& impl = *impl_;
  impl.device.reset(rtcNewDevice("threads=1"));
  if (impl.device == nullptr) throw Error(ErrorKind::kInternal, "Embree: no device can be made");
  impl.scene.reset(rtcNewScene(impl.device.get()));
  rtcSetSceneFlags(impl.scene.get(), RTC_SCENE_FLAG_ROBUST);
  // All in S: floats are finest near the camera.
  const RigidTransform X_SB = X_BS.inverse();
  impl.capsules = CapsulesInS(geometry, X_SB);
  AddCapsules(impl.device.get(), impl.scene.get(), impl.capsules);
  AddBoxes(impl.device.get(), impl.scene.get(), geometry, X_SB);
  rtcCommitScene(impl.scene.get());
  RequireNoError(impl.device.get(), "building the scene");
  const RigidTransform X_SP = ProjectorPose(spec);
  impl.p_SP = X_SP.translation().cast<float>();
  impl.R_PS = X_SP.linear().transpose().cast<float>();
  impl.tan_half_width = static_cast<float>(std::tan(Radians(0.5 * spec.projector_width_deg)));
  impl.tan_half_height = static_cast<float>(std::tan(Radians(0.5 * spec.projector_height_deg)));
}

RayScene::~RayScene() = default;

void RayScene::CastRows(const Pinhole& pinhole, int first, int last, bool shadows,
                        HitImage& hits) const {
  TT_CHECK(first % kSide == 0);
  for (int row = first; row < last; row += kSide) {
    for (int column = 0; column < pinhole.width; column += kSide) {
      impl_->CastPacket(pinhole, row, column, shadows, hits);
    }
  }
}

void RayScene::Impl::CastPacket(const Pinhole& pinhole, int row0, int column0, bool shadows,
                                HitImage& hits) const {
  alignas(64) RTCRayHit16 packet;
  alignas(64) int valid[kPacket];
  for (int i = 0; i < kPacket; ++i) {
    valid[i] = -1;
    packet.ray.org_x[i] = packet.ray.org_y[i] = packet.ray.org_z[i] = 0.0f;
    packet.ray.dir_x[i] = pinhole.x(column0 + i % kSide);
    packet.ray.dir_y[i] = pinhole.y(row0 + i / kSide);
    packet.ray.dir_z[i] = 1.0f;  // So that the ray's parameter is the depth.
    packet.ray.tnear[i] = kWindow_m;
    packet.ray.tfar[i] = kFarthest_m;
    packet.ray.time[i] = 0.0f;
    packet.ray.mask[i] = 0xffffffffu;
    packet.ray.id[i] = static_cast<unsigned>(i);
    packet.ray.flags[i] = 0;
    packet.hit.Ng_x[i] = packet.hit.Ng_y[i] = packet.hit.Ng_z[i] = 0.0f;
    packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene.get(), &context, &packet);

  Incidences at_hit;
  alignas(64) RTCRay16 light;
  Light(packet, light, at_hit);
  if (shadows) {
    bool any = false;
    for (int i = 0; i < kPacket; ++i) any |= at_hit.lit[i] != 0;
    if (any) rtcOccluded16(at_hit.lit, scene.get(), &context, &light);
  }
  alignas(64) float z_m[kPacket];
  alignas(64) int shape[kPacket];
  const int boxes_from = static_cast<int>(capsules.size());
  for (int i = 0; i < kPacket; ++i) {
    const bool hit = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    const int primitive = static_cast<int>(packet.hit.primID[i]);
    shape[i] = !hit ? -1 : packet.hit.geomID[i] == 0 ? primitive : boxes_from + primitive / 12;
    z_m[i] = hit ? packet.ray.tfar[i] : 0.0f;
    const bool lit = at_hit.lit[i] != 0 && light.tfar[i] >= 0.0f;
    if (!hit || (shadows && !lit)) at_hit.cos_projector[i] = 0.0f;
    if (hit && !shadows) {
      at_hit.cos_projector[i] = std::max(at_hit.cos_projector[i], kUnshadowed);
    }
  }
  for (int r = 0; r < kSide; ++r) {
    const std::size_t at = hits.Index(row0 + r, column0);
    std::copy_n(z_m + kSide * r, kSide, &hits.z_m[at]);
    std::copy_n(at_hit.cos_camera + kSide * r, kSide, &hits.cos_camera[at]);
    std::copy_n(at_hit.cos_projector + kSide * r, kSide, &hits.cos_projector[at]);
    std::copy_n(at_hit.cos_mirror + kSide * r, kSide, &hits.cos_mirror[at]);
    std::copy_n(shape + kSide * r, kSide, &hits.shape[at]);
  }
}

/// Incidences of what was seen, and the rays from there to the projector: `lit` where light could
/// come. Without branches and on copies: the compiler makes vector instructions of it.
void RayScene::Impl::Light(const RTCRayHit16& seen, RTCRay16& light, Incidences& out) const {
  struct {
    float x[kPacket], y[kPacket], z[kPacket];
  } ray, normal, start, way;
  float reach[kPacket];
  std::copy_n(seen.ray.dir_x, kPacket, ray.x);
  std::copy_n(seen.ray.dir_y, kPacket, ray.y);
  std::copy_n(seen.ray.tfar, kPacket, ray.z);
  std::copy_n(seen.hit.Ng_x, kPacket, normal.x);
  std::copy_n(seen.hit.Ng_y, kPacket, normal.y);
  std::copy_n(seen.hit.Ng_z, kPacket, normal.z);
  const Eigen::Vector3f p = p_SP;
  const Eigen::Matrix3f R = -R_PS;
  const float half_width = tan_half_width, half_height = tan_half_height;
  for (int i = 0; i < kPacket; ++i) {
    const float z = ray.z[i], rx = ray.x[i], ry = ray.y[i];
    const float x = rx * z, y = ry * z;
    const float per_ray = 1.0f / std::sqrt(rx * rx + ry * ry + 1.0f);
    float nx = normal.x[i], ny = normal.y[i], nz = normal.z[i];
    const float square = nx * nx + ny * ny + nz * nz;
    // Triangles have two sides; the camera sees the one that looks at it.
    const float side = nx * rx + ny * ry + nz > 0.0f ? -1.0f : 1.0f;
    const float scale = side / std::sqrt(square > 1e-30f ? square : 1e-30f);
    nx *= scale, ny *= scale, nz *= scale;
    const float lx = p.x() - x, ly = p.y() - y, lz = p.z() - z;
    const float per_light = 1.0f / std::sqrt(lx * lx + ly * ly + lz * lz);
    const float cos_projector = (nx * lx + ny * ly + nz * lz) * per_light;
    out.cos_camera[i] = -(nx * rx + ny * ry + nz) * per_ray;
    out.cos_projector[i] = cos_projector;
    const float hx = lx * per_light - rx * per_ray, hy = ly * per_light - ry * per_ray;
    const float hz = lz * per_light - per_ray;
    out.cos_mirror[i] = (nx * hx + ny * hy + nz * hz) / std::sqrt(hx * hx + hy * hy + hz * hz);
    const float px = R(0, 0) * lx + R(0, 1) * ly + R(0, 2) * lz;
    const float py = R(1, 0) * lx + R(1, 1) * ly + R(1, 2) * lz;
    const float pz = R(2, 0) * lx + R(2, 1) * ly + R(2, 2) * lz;
    const bool in_frustum =
        (pz > 0.0f) & (std::abs(px) <= half_width * pz) & (std::abs(py) <= half_height * pz);
    out.lit[i] = in_frustum & (cos_projector > 0.0f) & (z < kFarthest_m) ? -1 : 0;
    start.x[i] = x + nx * kShadowOffset_m;
    start.y[i] = y + ny * kShadowOffset_m;
    start.z[i] = z + nz * kShadowOffset_m;
    way.x[i] = lx, way.y[i] = ly, way.z[i] = lz;
    reach[i] = 1.0f - kWindow_m * per_light;
  }
  std::copy_n(start.x, kPacket, light.org_x);
  std::copy_n(start.y, kPacket, light.org_y);
  std::copy_n(start.z, kPacket, light.org_z);
  std::copy_n(way.x, kPacket, light.dir_x);
  std::copy_n(way.y, kPacket, light.dir_y);
  std::copy_n(way.z, kPacket, light.dir_z);
  std::copy_n(reach, kPacket, light.tfar);
  for (int i = 0; i < kPacket; ++i) {
    light.tnear[i] = light.time[i] = 0.0f;
    light.mask[i] = 0xffffffffu;
    light.id[i] = static_cast<unsigned>(i);
    light.flags[i] = 0;
  }
}

}  // namespace tubetwin
