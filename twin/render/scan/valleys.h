#pragma once

#include <vector>

#include "models/base/frames.h"
#include "twin/render/scan/ray_scene.h"

namespace tubetwin {

/// Says whether a seen point lies in a valley between two surfaces that face each other, where
/// light of the projector also arrives by reflection. Uses only what the camera sees around the
/// point. Immutable after construction; the arguments must outlive it.
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
