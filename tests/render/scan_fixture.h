#pragma once

#include "models/base/cloud/cloud.h"
#include "tests/support/paper_scan.h"
#include "twin/render/scan/scan_geometry.h"

namespace tubetwin::test {

inline constexpr double kRadius_m = 0.0125;
inline constexpr std::uint32_t kTube = kLabelFirstTube;

// All scenes are laid out in S: X_BS is the identity.

/// Plate across the view, its surface at z, turned about y (towards the projector) when tilted.
inline ScanGeometry::Box Plate(double z_m, double tilt_deg = 0.0, float albedo = 0.6f,
                               float gloss = 0.0f) {
  return {MakeTransform(RotY(-Radians(tilt_deg)), Vector3(0, 0, z_m)) * Translation(0, 0, 0.01),
          Vector3(1, 1, 0.01), kLabelCell, albedo, gloss};
}

/// Cosines of a point of a surface with that normal.
struct Incidence {
  double camera, projector, mirror;
  Incidence(const Vector3& p, const Vector3& normal) {
    const Vector3 to_camera = -p.normalized();
    const Vector3 to_projector =
        (ProjectorPose(PaperCell().scanner).translation() - p).normalized();
    camera = normal.dot(to_camera);
    projector = normal.dot(to_projector);
    mirror = normal.dot((to_camera + to_projector).normalized());
  }
};
inline Vector3 PlateNormal(double tilt_deg) { return RotY(-Radians(tilt_deg)) * Vector3(0, 0, -1); }

inline ScanGeometry::Capsule TubeAlongY(double x_m, double z_m) {
  return {{x_m, -0.5, z_m}, {x_m, 0.5, z_m}, kRadius_m, kTube, 0.8f};
}

inline ScanGeometry Scene(std::vector<ScanGeometry::Box> boxes,
                          std::vector<ScanGeometry::Capsule> capsules = {}) {
  return {std::move(capsules), std::move(boxes)};
}

inline OrganizedCloud Cast(const ScanGeometry& geometry, const ScanSettings& settings,
                           int threads = 1, std::uint64_t seed = 1) {
  return CastScan(geometry, RigidTransform::Identity(), settings, RandomStream(seed, 2, "scan"),
                  {threads});
}

inline ScanSettings Exact() {
  ScanSettings settings = PaperScan();
  settings.effects = ScannerEffects::Exact();
  settings.labels = true;
  return settings;
}

/// One effect besides shadows.
inline ScanSettings Only(bool ScannerEffects::*effect) {
  ScanSettings settings = Exact();
  settings.effects.*effect = true;
  return settings;
}

inline int CountValid(const OrganizedCloud& cloud) {
  int n = 0;
  for (const Eigen::Vector3f& p : cloud.p_SP) n += IsValid(p);
  return n;
}

}  // namespace tubetwin::test
