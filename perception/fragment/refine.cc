#include "perception/fragment/refine.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"

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
constexpr double kMaxPerNode = 30.0;

/// Where a point belongs on the curve.
struct Foot {
  int node = 0;      ///< First node of the segment.
  double u = 0.0;    ///< 0..1 along it.
  bool end = false;  ///< Beyond the first or last node.
};

/// The curve's pieces as the searches need them.
class Pieces {
 public:
  explicit Pieces(const Polyline& line) : line_(line), steps_(line.size() - 1) {
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const Vector3 d = line[k + 1] - line[k];
      steps_[k] = {d, 1.0 / std::max(d.squaredNorm(), 1e-18)};
    }
  }

  int count() const { return static_cast<int>(steps_.size()); }

  /// Nearest of the pieces `from` to `to`, the latter excluded.
  Foot Find(const Vector3& p, int from, int to) const {
    Foot best;
    double nearest = 1e30;
    for (int k = from; k < to; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const Vector3 w = p - line_[i];
      const double free = w.dot(steps_[i].d) * steps_[i].inverse;
      const double u = std::clamp(free, 0.0, 1.0);
      const double distance = (w - u * steps_[i].d).squaredNorm();
      if (distance >= nearest) continue;
      nearest = distance;
      best = {k, u, (k == 0 && free < 0.0) || (k + 1 == count() && free > 1.0)};
    }
    return best;
  }

  /// The first search: the nearest of every fourth node, then the pieces around it.
  Foot FindAnywhere(const Vector3& p) const {
    constexpr std::size_t kStride = 4;
    std::size_t best = 0;
    double nearest = 1e30;
    for (std::size_t k = 0; k < line_.size(); k += kStride) {
      const double distance = (line_[k] - p).squaredNorm();
      if (distance >= nearest) continue;
      nearest = distance;
      best = k;
    }
    const int k = static_cast<int>(best), reach = static_cast<int>(kStride) + 1;
    return Find(p, std::max(0, k - reach), std::min(count(), k + reach));
  }

  /// From a foot that was right before the curve moved a little.
  Foot FindFrom(const Vector3& p, Foot foot) const {
    for (int tries = 0; tries < 4; ++tries) {
      const Foot next = Find(p, std::max(0, foot.node - 1), std::min(count(), foot.node + 2));
      if (next.node == foot.node) return next;
      foot = next;
    }
    return foot;
  }

 private:
  struct Step {
    Vector3 d;
    double inverse;  ///< 1 / |d|^2.
  };
  const Polyline& line_;
  std::vector<Step> steps_;
};

void UpdateFeet(const Polyline& line, const std::vector<SurfacePoint>& points,
                std::vector<Foot>& feet) {
  const Pieces pieces(line);
  const bool first = feet.empty();
  feet.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 p = points[i].p_N.cast<double>();
    feet[i] = first ? pieces.FindAnywhere(p) : pieces.FindFrom(p, feet[i]);
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

  /// One measurement: the curve's point at `foot` shall move so that H step = g. `w`: what it adds
  /// to the weight of its nodes.
  void Add(const Foot& foot, const Matrix3& H, const Vector3& g, double w) {
    const auto k = static_cast<std::size_t>(foot.node);
    const double a = 1.0 - foot.u, b = foot.u;
    own[k] += a * a * H;
    own[k + 1] += b * b * H;
    next[k] += a * b * H;
    right[k] += a * g;
    right[k + 1] += b * g;
    weight[k] += w * a;
    weight[k + 1] += w * b;
  }

  /// Limits what one node's points weigh together.
  void Cap() {
    std::vector<double> factor(own.size());
    for (std::size_t k = 0; k < own.size(); ++k) {
      factor[k] = weight[k] > kMaxPerNode ? kMaxPerNode / weight[k] : 1.0;
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
    const Foot& foot = feet[i];
    const auto k = static_cast<std::size_t>(foot.node);
    const Vector3 c = line[k] + foot.u * (line[k + 1] - line[k]);
    const Vector3 out = point.p_N.cast<double>() - c;
    const double distance = out.norm();
    const double residual = distance - r;
    if (std::abs(residual) > kOutlier_m || distance < 1e-6) continue;
    const double q = kScale_m * kScale_m / (kScale_m * kScale_m + residual * residual);
    const double w = point.weight * q * q;
    Matrix3 H = (w / (distance * distance)) * out * out.transpose();
    Vector3 g = (w * residual / distance) * out;
    double weight = w;
    const Vector3 pull = point.a_N.cast<double>() - c;
    if (pull.squaredNorm() < kOutlier_m * kOutlier_m) {
      H.diagonal().array() += kAxisWeight * w;
      g += kAxisWeight * w * pull;
      weight += w;
    }
    eq.Add(foot, H, g, weight);
  }
  eq.Cap();
  return eq;
}

/// A symmetric positive definite system whose entries lie at most kBand beside the diagonal.
/// Factorised in place (Cholesky); a general sparse solver spends ten times as long on finding the
/// band.
class BandedSystem {
 public:
  static constexpr int kBand = 8;  ///< Second differences of nodes with three coordinates.
  explicit BandedSystem(int n) : n_(n), lower_(static_cast<std::size_t>(n) * (kBand + 1), 0.0) {}

  /// Entry with row - kBand <= column <= row.
  double& At(int row, int column) {
    return lower_[static_cast<std::size_t>(row) * (kBand + 1) +
                  static_cast<std::size_t>(column - row + kBand)];
  }

  /// Adds a block and, by symmetry, its transpose; for blocks on the diagonal the lower half.
  void AddBlock(int row, int column, const Matrix3& block) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (3 * column + j <= 3 * row + i) At(3 * row + i, 3 * column + j) += block(i, j);
      }
    }
  }

  void Solve(Eigen::VectorXd& x) {
    for (int i = 0; i < n_; ++i) {
      const int first = std::max(0, i - kBand);
      for (int j = first; j <= i; ++j) {
        double sum = At(i, j);
        for (int k = std::max(first, j - kBand); k < j; ++k) sum -= At(i, k) * At(j, k);
        TT_CHECK(j < i || sum > 0.0);
        At(i, j) = j < i ? sum / At(j, j) : std::sqrt(sum);
      }
      for (int k = first; k < i; ++k) x[i] -= At(i, k) * x[k];
      x[i] /= At(i, i);
    }
    for (int i = n_ - 1; i >= 0; --i) {
      for (int k = i + 1; k <= std::min(n_ - 1, i + kBand); ++k) x[i] -= At(k, i) * x[k];
      x[i] /= At(i, i);
    }
  }

 private:
  int n_;
  std::vector<double> lower_;
};

/// Solves for the moves of all nodes with the penalty on second differences of the moved curve.
void Step(Polyline& line, const Equations& eq) {
  const int n = static_cast<int>(line.size());
  BandedSystem system(3 * n);
  Eigen::VectorXd move(3 * n);
  for (int k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    system.AddBlock(k, k, eq.own[i] + 1e-3 * Matrix3::Identity());
    if (k + 1 < n) system.AddBlock(k + 1, k, eq.next[i]);  // Symmetric itself.
    move.segment<3>(3 * k) = eq.right[i];
  }
  const double bend = kScale_m * kScale_m / (kBend_m * kBend_m);
  const double coefficient[3] = {1.0, -2.0, 1.0};
  for (int k = 1; k + 1 < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vector3 difference = line[i - 1] - 2.0 * line[i] + line[i + 1];
    for (int a = 0; a < 3; ++a) {
      move.segment<3>(3 * (k - 1 + a)) -= bend * coefficient[a] * difference;
      for (int b = 0; b <= a; ++b) {
        system.AddBlock(k - 1 + a, k - 1 + b,
                        bend * coefficient[a] * coefficient[b] * Matrix3::Identity());
      }
    }
  }
  system.Solve(move);
  for (int k = 0; k < n; ++k) {
    Vector3 step = move.segment<3>(3 * k);
    if (step.norm() > 2.0 * kOutlier_m) step *= 2.0 * kOutlier_m / step.norm();
    line[static_cast<std::size_t>(k)] += step;
  }
}

/// Regression of points on normals, both across the axis, per slice around a node: its slope is the
/// tube's radius, wherever the axis is.
class RadiusSums {
 public:
  explicit RadiusSums(std::size_t nodes) : slices_(nodes) {}

  /// `out`: from the axis to the point.
  void Add(std::size_t node, const Vector3& out, const Vector3& n, const Vector3& t) {
    Slice& s = slices_[node];
    const Vector3 q = out - out.dot(t) * t, m = n - n.dot(t) * t;
    s.count += 1.0;
    s.q += q;
    s.m += m;
    s.qm += q.dot(m);
    s.mm += m.squaredNorm();
  }

  void Finish(TubeFit& fit) const {
    double qm = 0.0, mm = 0.0;
    for (const Slice& s : slices_) {
      if (s.count < 3.0) continue;
      qm += s.qm - s.q.dot(s.m) / s.count;
      mm += s.mm - s.m.squaredNorm() / s.count;
    }
    fit.radius_m = mm > 0.0 ? qm / mm : 0.0;
    fit.radius_weight = mm;
  }

 private:
  struct Slice {
    double count = 0.0, qm = 0.0, mm = 0.0;
    Vector3 q = Vector3::Zero(), m = Vector3::Zero();
  };
  std::vector<Slice> slices_;
};

TubeFit Judge(const Polyline& line, const std::vector<SurfacePoint>& points,
              const std::vector<Foot>& feet, double r) {
  TubeFit fit;
  fit.node_weight.assign(line.size(), 0.0);
  double squares = 0.0, spread = 0.0;
  std::size_t near = 0, good = 0, inside = 0;
  std::vector<Vector3> mean(line.size(), Vector3::Zero());
  std::vector<std::pair<int, Vector3>> around;
  RadiusSums radius(line.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint& point = points[i];
    const Vector3 p = point.p_N.cast<double>();
    const Foot& foot = feet[i];
    const auto k = static_cast<std::size_t>(foot.node);
    const Vector3 step = line[k + 1] - line[k];
    const Vector3 out = p - line[k] - foot.u * step;
    const double residual = out.norm() - r;
    const std::size_t node = k + (foot.u > 0.5 ? 1 : 0);
    const Vector3 t = step.normalized();
    if (std::abs(residual) < kOutlier_m && !foot.end) {
      radius.Add(node, out, point.n_N.cast<double>(), t);
    }
    ++near;
    if (std::abs(residual) < 0.002) {
      squares += residual * residual;
      ++inside;
    }
    if (std::abs(residual) > 0.001) continue;
    ++good;
    fit.node_weight[node] += 1.0;
    if (foot.end) continue;
    Vector3 n = point.n_N.cast<double>();
    n -= n.dot(t) * t;
    if (n.norm() < 1e-6) continue;
    mean[node] += n.normalized();
    around.emplace_back(static_cast<int>(node), n.normalized());
  }
  for (const auto& [node, n] : around) {
    spread += n.cross(mean[static_cast<std::size_t>(node)].normalized()).squaredNorm();
  }
  radius.Finish(fit);
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
