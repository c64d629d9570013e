#include "planner/scene_query/box_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "models/base/error.h"

namespace tubetwin {
namespace {

double SquaredDistance(const Vector3& p, const Vector3& half) {
  return (p.cwiseAbs() - half).cwiseMax(0.0).squaredNorm();
}

}  // namespace

double SegmentBoxDistance(const Vector3& p_AP, const Vector3& p_AQ, const OrientedBox& box) {
  const RigidTransform X_BA = box.X_AB.inverse();
  const Vector3 p = X_BA * p_AP, d = X_BA * p_AQ - p;
  // Parameters at which the point crosses a face plane, sorted by insertion.
  std::array<double, 8> cut{0.0, 1.0};
  int count = 2;
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) continue;
    for (const double face : {-box.half_m[axis], box.half_m[axis]}) {
      const double t = (face - p[axis]) / d[axis];
      if (!(t > 0.0 && t < 1.0)) continue;
      int k = count++;
      for (; cut[k - 1] > t; --k) cut[k] = cut[k - 1];
      cut[k] = t;
    }
  }

  double best = std::min(SquaredDistance(p, box.half_m), SquaredDistance(p + d, box.half_m));
  for (int k = 0; k + 1 < count; ++k) {
    // Which axes are outside, and on which side, does not change within the piece.
    const Vector3 middle = p + 0.5 * (cut[k] + cut[k + 1]) * d;
    bool inside = true;
    double slope = 0.0, curvature = 0.0;  // of the squared distance: slope + t * curvature = 0
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(middle[axis]) <= box.half_m[axis]) continue;
      inside = false;
      const double face = middle[axis] > 0 ? box.half_m[axis] : -box.half_m[axis];
      slope += (p[axis] - face) * d[axis];
      curvature += d[axis] * d[axis];
    }
    if (inside) return 0.0;
    const double t = curvature > 0.0 ? std::clamp(-slope / curvature, cut[k], cut[k + 1]) : cut[k];
    best = std::min(best, SquaredDistance(p + t * d, box.half_m));
  }
  return std::sqrt(best);
}

double LineBoxDistance(const Polyline& line_A, const OrientedBox& box, double enough_m) {
  TT_CHECK(!line_A.empty());
  const double box_radius = box.half_m.norm();
  double best = enough_m;
  for (std::size_t i = 0; i < line_A.size(); ++i) {
    const Vector3& p = line_A[i];
    const Vector3& q = line_A[std::min(i + 1, line_A.size() - 1)];
    // Ball around the piece against ball around the box.
    const double apart = (0.5 * (p + q) - box.X_AB.translation()).norm();
    if (apart - 0.5 * (q - p).norm() - box_radius >= best) continue;
    best = std::min(best, SegmentBoxDistance(p, q, box));
  }
  return best;
}

bool Contains(const OrientedBox& box, const Vector3& p_AP) {
  const Vector3 p_BP = box.X_AB.inverse() * p_AP;
  return (p_BP.cwiseAbs() - box.half_m).maxCoeff() <= 0.0;
}

}  // namespace tubetwin
