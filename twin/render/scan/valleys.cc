#include "twin/render/scan/valleys.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {
namespace {

/// A surface counts when it stands more than this over the other's horizon: neighbouring pieces of
/// one bent tube, which touch at a few degrees, are no valley.
const float kSinOverHorizon = std::sin(static_cast<float>(Radians(15)));

/// Pixels looked at, as shares of the reach: eight directions, five distances (near a contact the
/// other surface rises steeply).
constexpr float kDistances[5] = {0.0625f, 0.125f, 0.25f, 0.5f, 1.0f};
constexpr float kDirections[8][2] = {{1, 0},
                                     {0, 1},
                                     {-1, 0},
                                     {0, -1},
                                     {0.707f, 0.707f},
                                     {-0.707f, 0.707f},
                                     {-0.707f, -0.707f},
                                     {0.707f, -0.707f}};

}  // namespace

ValleyFinder::ValleyFinder(const ScanGeometry& geometry, const RigidTransform& X_BS,
                           const Pinhole& pinhole, const HitImage& hits)
    : pinhole_(pinhole), hits_(hits) {
  const RigidTransform X_SB = X_BS.inverse();
  for (const ScanGeometry::Capsule& capsule : geometry.capsules) {
    const Vector3 a = X_SB * capsule.a, axis = X_SB * capsule.b - a;
    capsules_.push_back({a.cast<float>(), axis.cast<float>(),
                         static_cast<float>(1.0 / std::max(axis.squaredNorm(), 1e-14))});
  }
  for (const ScanGeometry::Box& box : geometry.boxes) {
    const RigidTransform X_BoxS = box.X_BBox.inverse() * X_BS;
    boxes_.push_back({X_BoxS.cast<float>(), box.half_m.cast<float>()});
  }
}

Eigen::Vector3f ValleyFinder::Point(int row, int column) const {
  const float z = hits_.z_m[hits_.Index(row, column)];
  return {pinhole_.x(column) * z, pinhole_.y(row) * z, z};
}

Eigen::Vector3f ValleyFinder::Normal(int shape, const Eigen::Vector3f& p_SP) const {
  const auto capsules = static_cast<int>(capsules_.size());
  if (shape < capsules) {
    const Capsule& capsule = capsules_[shape];
    const Eigen::Vector3f from_a = p_SP - capsule.a;
    const float along = std::clamp(from_a.dot(capsule.axis) * capsule.per_axis2, 0.0f, 1.0f);
    return (from_a - along * capsule.axis).normalized();
  }
  // The face whose plane the point lies nearest to.
  const Box& box = boxes_[shape - capsules];
  const Eigen::Vector3f p_Box = box.X_BoxS * p_SP;
  int axis = 0;
  const Eigen::Vector3f depth_m = box.half_m - p_Box.cwiseAbs();
  depth_m.minCoeff(&axis);
  return box.X_BoxS.linear().row(axis).transpose() * (p_Box[axis] < 0 ? -1.0f : 1.0f);
}

bool ValleyFinder::At(int row, int column) const {
  const int own = hits_.shape[hits_.Index(row, column)];
  const Eigen::Vector3f p = Point(row, column);
  const Eigen::Vector3f n_p = Normal(own, p);
  const float reach_m = static_cast<float>(kReach_m);
  const float reach_px = reach_m * pinhole_.focal_px / p.z();
  for (const float distance : kDistances) {
    for (const auto& direction : kDirections) {
      const int c = column + static_cast<int>(std::lround(direction[0] * distance * reach_px));
      const int r = row + static_cast<int>(std::lround(direction[1] * distance * reach_px));
      if (c < 0 || r < 0 || c >= pinhole_.width || r >= pinhole_.height) continue;
      const int other = hits_.shape[hits_.Index(r, c)];
      if (other < 0 || other == own) continue;
      const Eigen::Vector3f q = Point(r, c), way = q - p;
      const float apart_m = way.norm();
      if (apart_m > reach_m) continue;
      const float over = kSinOverHorizon * apart_m;
      if (way.dot(n_p) > over && -way.dot(Normal(other, q)) > over) return true;
    }
  }
  return false;
}

}  // namespace tubetwin
