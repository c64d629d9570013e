#include "perception/view/floor_plane.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace tubetwin {
namespace {

constexpr int kTriples = 400;

std::optional<FloorPlane> BestPlane(const std::vector<Vector3>& points, RandomStream& stream) {
  const auto n = static_cast<std::uint32_t>(points.size());
  std::optional<FloorPlane> best;
  std::size_t max_count = 0;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / 4000);
  for (int k = 0; k < kTriples && n >= 3; ++k) {
    const Vector3 &a = points[stream.Index(n)], &b = points[stream.Index(n)],
                  &c = points[stream.Index(n)];
    const Vector3 normal = (b - a).cross(c - a);
    if (normal.norm() < 1e-6) continue;
    const FloorPlane plane{normal.normalized(), normal.normalized().dot(a)};
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      count += std::abs(plane.Height(points[i])) < kOnPlane_m;
    }
    if (count > max_count) {
      max_count = count;
      best = plane;
    }
  }
  if (!best) return best;
  return Polished(Polished(*best, points), points);
}

}  // namespace

FloorPlane Polished(const FloorPlane& plane, const std::vector<Vector3>& p_C) {
  Vector3 mean = Vector3::Zero();
  Matrix3 squares = Matrix3::Zero();
  double n = 0;
  for (const Vector3& p : p_C) {
    if (std::abs(plane.Height(p)) > kOnPlane_m) continue;
    mean += p;
    squares += p * p.transpose();
    ++n;
  }
  if (n < 3) return plane;
  mean /= n;
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(squares / n - mean * mean.transpose());
  FloorPlane out;
  out.normal = solver.eigenvectors().col(0);
  if (out.normal.dot(plane.normal) < 0) out.normal = -out.normal;
  out.offset_m = out.normal.dot(mean);
  return out;
}

std::vector<FloorPlane> FindPlanes(const Sighting& sighting, int count, RandomStream stream) {
  std::vector<FloorPlane> out;
  std::vector<Vector3> left = sighting.p_C;
  for (int k = 0; k < count; ++k) {
    const std::optional<FloorPlane> plane = BestPlane(left, stream);
    if (!plane) break;
    const FloorPlane other{-plane->normal, -plane->offset_m};
    double height = 0.0;
    bool known = true;
    for (const auto& eye : sighting.eye_C) {
      known &= eye.has_value();
      if (eye) height += plane->Height(*eye);
    }
    if (!known || height > 0.0) out.push_back(*plane);
    if (!known || height <= 0.0) out.push_back(other);
    std::erase_if(left,
                  [&](const Vector3& p) { return std::abs(plane->Height(p)) < 2 * kOnPlane_m; });
    if (left.size() < sighting.p_C.size() / 50) break;
  }
  return out;
}

RigidTransform PlaneFrame(const FloorPlane& plane) {
  Vector3 x = Vector3::UnitX() - plane.normal.x() * plane.normal;
  if (x.norm() < 0.1) x = Vector3::UnitY() - plane.normal.y() * plane.normal;
  Matrix3 R_CP;
  R_CP.col(0) = x.normalized();
  R_CP.col(1) = plane.normal.cross(R_CP.col(0));
  R_CP.col(2) = plane.normal;
  return MakeTransform(R_CP, plane.offset_m * plane.normal);
}

}  // namespace tubetwin
