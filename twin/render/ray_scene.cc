#include "twin/render/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <embree3/rtcore.h>

#include "hw_bridge/base/error.h"

namespace tubetwin {
namespace {

// Rays are cast in packets of 4 x 2 pixels: neighbours stay together.
constexpr int kPacket = 8;
constexpr int kPacketColumns = 4;
constexpr int kPacketRows = 2;

// A shadow ray starts this far off the surface: over Embree's float error (below 1 um at these
// distances), far below what a scanner resolves.
constexpr float kShadowOffset_m = 10e-6f;

constexpr double kProjectorHalfWidth_deg = 47.5 / 2;
constexpr double kProjectorHalfHeight_deg = 36.0 / 2;

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

void AddCapsules(RTCDevice device, RTCScene scene, const ScanGeometry& geometry,
                 const RigidTransform& X_SB) {
  const std::size_t n = geometry.capsules.size();
  if (n == 0) return;
  const GeometryPtr curves(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE));
  RequireNoError(device, "making curves");
  float* vertex = NewBuffer<float>(curves.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                   4 * sizeof(float), 2 * n);
  unsigned* index = NewBuffer<unsigned>(curves.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT,
                                        sizeof(unsigned), n);
  for (std::size_t i = 0; i < n; ++i) {
    const ScanGeometry::Capsule& capsule = geometry.capsules[i];
    for (const Vector3& p_B : {capsule.a, capsule.b}) {
      const Eigen::Vector3f p_S = (X_SB * p_B).cast<float>();
      std::copy_n(p_S.data(), 3, vertex);
      vertex[3] = static_cast<float>(capsule.radius_m);
      vertex += 4;
    }
    index[i] = static_cast<unsigned>(2 * i);
  }
  rtcCommitGeometry(curves.get());
  rtcAttachGeometryByID(scene, curves.get(), 0);
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

struct RayScene::Impl {
  DevicePtr device;
  ScenePtr scene;
  int capsules = 0;
  Eigen::Vector3f p_SP = Eigen::Vector3f::Zero();  ///< Projector.
  Eigen::Matrix3f R_PS = Eigen::Matrix3f::Identity();
  float tan_half_width = 0, tan_half_height = 0;

  void CastPacket(const Pinhole& pinhole, int row0, int column0, int last_row,
                  std::vector<RayHit>& hits) const;
  void CastShadows(const RTCRayHit8& seen, int* valid, RayHit* out) const;
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
  AddCapsules(impl.device.get(), impl.scene.get(), geometry, X_SB);
  AddBoxes(impl.device.get(), impl.scene.get(), geometry, X_SB);
  rtcCommitScene(impl.scene.get());
  RequireNoError(impl.device.get(), "building the scene");
  impl.capsules = static_cast<int>(geometry.capsules.size());
  const RigidTransform X_SP = ProjectorPose(spec);
  impl.p_SP = X_SP.translation().cast<float>();
  impl.R_PS = X_SP.linear().transpose().cast<float>();
  impl.tan_half_width = static_cast<float>(std::tan(Radians(kProjectorHalfWidth_deg)));
  impl.tan_half_height = static_cast<float>(std::tan(Radians(kProjectorHalfHeight_deg)));
}

RayScene::~RayScene() = default;

void RayScene::CastRows(const Pinhole& pinhole, int first, int last,
                        std::vector<RayHit>& hits) const {
  TT_CHECK(hits.size() == static_cast<std::size_t>(pinhole.width) * pinhole.height);
  for (int row = first; row < last; row += kPacketRows) {
    for (int column = 0; column < pinhole.width; column += kPacketColumns) {
      impl_->CastPacket(pinhole, row, column, last, hits);
    }
  }
}

void RayScene::Impl::CastPacket(const Pinhole& pinhole, int row0, int column0, int last_row,
                                std::vector<RayHit>& hits) const {
  alignas(32) RTCRayHit8 packet;
  alignas(32) int valid[kPacket];
  for (int i = 0; i < kPacket; ++i) {
    const int row = row0 + i / kPacketColumns, column = column0 + i % kPacketColumns;
    valid[i] = row < last_row && column < pinhole.width ? -1 : 0;
    packet.ray.org_x[i] = packet.ray.org_y[i] = packet.ray.org_z[i] = 0.0f;
    packet.ray.dir_x[i] = pinhole.x(column);
    packet.ray.dir_y[i] = pinhole.y(row);
    packet.ray.dir_z[i] = 1.0f;  // So that the ray's parameter is the depth.
    packet.ray.tnear[i] = 0.0f;
    packet.ray.tfar[i] = 10.0f;
    packet.ray.time[i] = 0.0f;
    packet.ray.mask[i] = 0xffffffffu;
    packet.ray.id[i] = static_cast<unsigned>(i);
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, scene.get(), &context, &packet);

  RayHit out[kPacket];
  for (int i = 0; i < kPacket; ++i) {
    if (valid[i] == 0 || packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    const int primitive = static_cast<int>(packet.hit.primID[i]);
    out[i].shape = packet.hit.geomID[i] == 0 ? primitive : capsules + primitive / 12;
    out[i].z_m = packet.ray.tfar[i];
  }
  alignas(32) int has_hit[kPacket];
  for (int i = 0; i < kPacket; ++i) has_hit[i] = out[i].shape >= 0 ? -1 : 0;
  CastShadows(packet, has_hit, out);
  for (int i = 0; i < kPacket; ++i) {
    if (valid[i] == 0) continue;
    const int row = row0 + i / kPacketColumns, column = column0 + i % kPacketColumns;
    hits[static_cast<std::size_t>(row) * pinhole.width + column] = out[i];
  }
}

void RayScene::Impl::CastShadows(const RTCRayHit8& seen, int* valid, RayHit* out) const {
  alignas(32) RTCRay8 rays;
  bool any = false;
  for (int i = 0; i < kPacket; ++i) {
    rays.org_x[i] = rays.org_y[i] = rays.org_z[i] = 0.0f;
    rays.dir_x[i] = rays.dir_y[i] = 0.0f;
    rays.dir_z[i] = 1.0f;
    rays.tnear[i] = 0.0f;
    rays.tfar[i] = 1.0f;
    rays.time[i] = 0.0f;
    rays.mask[i] = 0xffffffffu;
    rays.id[i] = static_cast<unsigned>(i);
    rays.flags[i] = 0;
    if (valid[i] == 0) continue;
    const Eigen::Vector3f ray(seen.ray.dir_x[i], seen.ray.dir_y[i], 1.0f);
    const Eigen::Vector3f p = ray * out[i].z_m;
    Eigen::Vector3f normal(seen.hit.Ng_x[i], seen.hit.Ng_y[i], seen.hit.Ng_z[i]);
    normal.normalize();
    if (normal.dot(ray) > 0) normal = -normal;  // Triangles have two sides.
    out[i].cos_camera = -normal.dot(ray) / ray.norm();
    const Eigen::Vector3f to_projector = p_SP - p;
    const Eigen::Vector3f p_P = R_PS * -to_projector;
    const float cos_projector = normal.dot(to_projector) / to_projector.norm();
    if (cos_projector <= 0 || p_P.z() <= 0 || std::abs(p_P.x()) > tan_half_width * p_P.z() ||
        std::abs(p_P.y()) > tan_half_height * p_P.z()) {
      valid[i] = 0;
      continue;
    }
    out[i].cos_projector = cos_projector;
    const Eigen::Vector3f start = p + normal * kShadowOffset_m;
    rays.org_x[i] = start.x();
    rays.org_y[i] = start.y();
    rays.org_z[i] = start.z();
    rays.dir_x[i] = to_projector.x();
    rays.dir_y[i] = to_projector.y();
    rays.dir_z[i] = to_projector.z();
    any = true;
  }
  if (!any) return;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded8(valid, scene.get(), &context, &rays);
  for (int i = 0; i < kPacket; ++i) {
    if (valid[i] != 0 && rays.tfar[i] < 0) out[i].cos_projector = 0;
  }
}

}  // namespace tubetwin
