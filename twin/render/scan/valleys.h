#pragma once

#include <vector>

#include "models/base/frames.h"
#include "twin/render/scan/ray_scene.h"

namespace tubetwin {

/// Tells whether a seen point lies in a valley: another surface within reach faces it, each over
/// the other's horizon, so that the projector's light gets there a second way. Looks at what the
/// camera sees around the point only. Immutable after construction; the arguments must outlive it.
class ValleyFinder {
 public:
  static constexpr double kReach_m = 0.004;

  ValleyFinder(const ScanGeometry& geometry, const RigidTransform& X_BS, const Pinhole& pinhole,
               const HitImage& hits);
  /// Whether the pixel, which hit something, shows a point in a valley.
  bool At(int row, int column) const;

 private:
  Eigen::Vector3f Point(int row, int column) const;
  Eigen::Vector3f Normal(int shape, const Eigen::Vector3f& p_SP) const;

  struct Capsule {
    Eigen::Vector3f a, axis;
    float per_axis2;
  };
  struct Box {
    Eigen::Isometry3f X_BoxS;
    Eigen::Vector3f half_m;
  };
  const Pinhole& pinhole_;
  const HitImage& hits_;
  std::vector<Capsule> capsules_;
  std::vector<Box> boxes_;
};

}  // namespace tubetwin
