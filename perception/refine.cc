#include "perception/refine.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include "hw_bridge/base/error.h"

namespace tubetwin {
namespace {

constexpr int kIterations = 4;
/// Points further from the tube's surface than this are not its own.
constexpr double kOutlier_m = 0.0025;
/// Residuals beyond this count less and less (Geman-McClure).
constexpr double kScale_m = 0.0005;
/// A point's own axis estimate is three to five times less exact than its distance.
constexpr double kAxisWeight = 0.05;
/// Bending: a second difference of the nodes of 1 mm weighs as much as a residual of kScale_m.
constexpr double kBend_m = 0.001;
/// Many points of one node share their errors: together they count as this many at most.
constexpr double kMostPerNode = 30.0;

/// Where a point belongs on the curve.
struct Foot {
  int node = 0;      ///< First node of the segment.
  double u = 0.0;    ///< 0..1 along it.
  bool end = false;  ///< Beyond the first or last node.
};

/// Among the segments `from` to `to`, the latter excluded.
Foot FindFoot(const Polyline& line, const Vector3& p, std::size_t from, std::size_t to) {
  Foot best;
  double nearest = 1e30;
  for (std::size_t k = from; k < to; ++k) {
    const Vector3 d = line[k + 1] - line[k];
    const double free = (p - line[k]).dot(d) / std::max(d.squaredNorm(), 1e-18);
    const double u = std::clamp(free, 0.0, 1.0);
    const double distance = (line[k] + u * d - p).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    best.node = static_cast<int>(k);
    best.u = u;
    best.end = (k == 0 && free < 0.0) || (k + 2 == line.size() && free > 1.0);
  }
  return best;
}

/// Feet of all points anew; each moves by a few segments at most from one iteration to the next.
void UpdateFeet(const Polyline& line, const std::vector<SurfacePoint>& points,
                std::vector<Foot>& feet) {
  constexpr std::size_t kReach = 3;
  const bool first = feet.empty();
  feet.resize(points.size());
  const std::size_t segments = line.size() - 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto k = static_cast<std::size_t>(feet[i].node);
    const std::size_t from = first || k < kReach ? 0 : k - kReach;
    const std::size_t to = first ? segments : std::min(segments, k + kReach + 1);
    feet[i] = FindFoot(line, points[i].p_N.cast<double>(), from, to);
  }
}

using Triplets = std::vector<Eigen::Triplet<double>>;

void AddBlock(Triplets& triplets, int row, int column, const Matrix3& block) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) triplets.emplace_back(3 * row + i, 3 * column + j, block(i, j));
  }
}

/// Normal equations per node and per pair of neighbours.
struct Equations {
  std::vector<Matrix3> own, next;
  std::vector<Vector3> right;
  std::vector<double> weight;
  explicit Equations(std::size_t n)
      : own(n, Matrix3::Zero()),
        next(n, Matrix3::Zero()),
        right(n, Vector3::Zero()),
        weight(n, 0.0) {}

  /// One measurement: the curve's point at `foot` shall move by `step` along the directions in H.
  void Add(const Foot& foot, const Matrix3& H, const Vector3& step, double w) {
    const auto k = static_cast<std::size_t>(foot.node);
    const double a = 1.0 - foot.u, b = foot.u;
    own[k] += w * a * a * H;
    own[k + 1] += w * b * b * H;
    next[k] += w * a * b * H;
    right[k] += w * a * (H * step);
    right[k + 1] += w * b * (H * step);
    weight[k] += w * a;
    weight[k + 1] += w * b;
  }

  /// Limits what one node's points weigh together.
  void Cap() {
    std::vector<double> factor(own.size());
    for (std::size_t k = 0; k < own.size(); ++k) {
      factor[k] = weight[k] > kMostPerNode ? kMostPerNode / weight[k] : 1.0;
    }
    for (std::size_t k = 0; k < own.size(); ++k) {
      own[k] *= factor[k];
      right[k] *= factor[k];
      if (k + 1 < own.size()) next[k] *= std::sqrt(factor[k] * factor[k + 1]);
    }
  }
};

Equations Linearize(const Polyline& line, const std::vector<SurfacePoint>& points,
                    const std::vector<Foot>& feet, double r) {
  Equations eq(line.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint& point = points[i];
    const Vector3 p = point.p_N.cast<double>();
    const Foot& foot = feet[i];
    const auto k = static_cast<std::size_t>(foot.node);
    const Vector3 c = line[k] + foot.u * (line[k + 1] - line[k]);
    const Vector3 out = p - c;
    const double distance = out.norm();
    const double residual = distance - r;
    if (std::abs(residual) > kOutlier_m || distance < 1e-6) continue;
    const double q = kScale_m * kScale_m / (kScale_m * kScale_m + residual * residual);
    const double w = point.weight * q * q;
    const Vector3 direction = out / distance;
    eq.Add(foot, direction * direction.transpose(), residual * direction, w);
    const Vector3 pull = point.a_N.cast<double>() - c;
    if (pull.norm() < kOutlier_m) eq.Add(foot, kAxisWeight * Matrix3::Identity(), pull, w);
  }
  eq.Cap();
  return eq;
}

/// Solves for the moves of all nodes with the penalty on second differences of the moved curve.
void Step(Polyline& line, const Equations& eq) {
  const int n = static_cast<int>(line.size());
  Triplets triplets;
  Eigen::VectorXd right(3 * n);
  for (int k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    AddBlock(triplets, k, k, eq.own[i] + 1e-3 * Matrix3::Identity());
    if (k + 1 < n) {
      AddBlock(triplets, k, k + 1, eq.next[i]);
      AddBlock(triplets, k + 1, k, eq.next[i].transpose());
    }
    right.segment<3>(3 * k) = eq.right[i];
  }
  const double bend = kScale_m * kScale_m / (kBend_m * kBend_m);
  const double coefficient[3] = {1.0, -2.0, 1.0};
  for (int k = 1; k + 1 < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vector3 difference = line[i - 1] - 2.0 * line[i] + line[i + 1];
    for (int a = 0; a < 3; ++a) {
      right.segment<3>(3 * (k - 1 + a)) -= bend * coefficient[a] * difference;
      for (int b = 0; b < 3; ++b) {
        AddBlock(triplets, k - 1 + a, k - 1 + b,
                 bend * coefficient[a] * coefficient[b] * Matrix3::Identity());
      }
    }
  }
  Eigen::SparseMatrix<double> H(3 * n, 3 * n);
  H.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(H);
  TT_CHECK(solver.info() == Eigen::Success);
  const Eigen::VectorXd move = solver.solve(right);
  for (int k = 0; k < n; ++k) {
    Vector3 step = move.segment<3>(3 * k);
    if (step.norm() > 2.0 * kOutlier_m) step *= 2.0 * kOutlier_m / step.norm();
    line[static_cast<std::size_t>(k)] += step;
  }
}

TubeFit Judge(const Polyline& line, const std::vector<SurfacePoint>& points,
              const std::vector<Foot>& feet, double r) {
  TubeFit fit;
  fit.node_weight.assign(line.size(), 0.0);
  double squares = 0.0, spread = 0.0;
  std::size_t near = 0, good = 0, inside = 0;
  std::vector<Vector3> mean(line.size(), Vector3::Zero());
  std::vector<std::pair<int, Vector3>> around;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint& point = points[i];
    const Vector3 p = point.p_N.cast<double>();
    const Foot& foot = feet[i];
    const auto k = static_cast<std::size_t>(foot.node);
    const double residual = (p - line[k] - foot.u * (line[k + 1] - line[k])).norm() - r;
    ++near;
    if (std::abs(residual) < 0.002) {
      squares += residual * residual;
      ++inside;
    }
    if (std::abs(residual) > 0.001) continue;
    ++good;
    const std::size_t node = k + (foot.u > 0.5 ? 1 : 0);
    fit.node_weight[node] += 1.0;
    if (foot.end) continue;
    const Vector3 t = (line[k + 1] - line[k]).normalized();
    Vector3 n = point.n_N.cast<double>();
    n -= n.dot(t) * t;
    if (n.norm() < 1e-6) continue;
    mean[node] += n.normalized();
    around.emplace_back(static_cast<int>(node), n.normalized());
  }
  for (const auto& [node, n] : around) {
    spread += n.cross(mean[static_cast<std::size_t>(node)].normalized()).squaredNorm();
  }
  fit.rms_m = inside > 0 ? std::sqrt(squares / static_cast<double>(inside)) : 0.0;
  fit.share = near > 0 ? static_cast<double>(good) / static_cast<double>(near) : 0.0;
  fit.normal_spread = around.empty() ? 0.0 : std::sqrt(spread / static_cast<double>(around.size()));
  return fit;
}

}  // namespace

TubeFit RefineCurve(Polyline& line_N, const std::vector<SurfacePoint>& points, double radius_m) {
  TT_CHECK(line_N.size() >= 2);
  std::vector<Foot> feet;
  UpdateFeet(line_N, points, feet);
  for (int i = 0; i < kIterations; ++i) {
    Step(line_N, Linearize(line_N, points, feet, radius_m));
    UpdateFeet(line_N, points, feet);
  }
  return Judge(line_N, points, feet, radius_m);
}

}  // namespace tubetwin
