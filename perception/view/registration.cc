#include "perception/view/registration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include <Eigen/Cholesky>

#include "perception/view/bin_planes.h"

namespace tubetwin {
namespace {

/// Points this far from floor or wall can still be theirs.
constexpr double kGate_m = 0.004;
/// Points this close to another wall, the floor or the rim may show its edge.
constexpr double kInset_m = 0.012;
/// Cosine between a point's normal and the plane's; normals over 3 mm are exact to some degrees.
constexpr double kAligned = 0.95;
/// Residuals beyond this count less and less (Geman-McClure): from the first iteration, when the
/// correction is still to come, to the last.
constexpr double kScales_m[] = {0.004, 0.002, 0.001, 0.0005, 0.0005};
/// Noise of one point. Points of one plane in one view share their errors: together they count as
/// kMaxPerPlane at most, and fewer than kFewestPerPlane are not trusted.
constexpr double kSigma_m = 0.00015;
constexpr double kMaxPerPlane = 100.0;
constexpr std::size_t kFewestPerPlane = 40;
/// One sigma of what all views share and of what each has besides.
constexpr double kCommonShift_m = 0.001, kOwnShift_m = 0.0001;
const double kCommonTurn_rad = Radians(0.15), kOwnTurn_rad = Radians(0.02);
/// Larger corrections are no calibration's error: something else is wrong.
constexpr double kMaxShift_m = 0.004;
const double kMaxTurn_rad = Radians(0.6);
/// Pixels of a view that are looked at first, and how many points of a plane are plenty.
constexpr double kSamples = 6000.0;
constexpr std::size_t kEnough = 800;

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Points of a view per plane, frame S.
using Samples = std::array<std::vector<Vector3>, kBinPlanes>;

/// Finds points of the planes in one view.
class Sampler {
 public:
  Sampler(const ViewRaster& view, const Bin& bin)
      : view_(view), bin_(bin), planes_(PlanesOf(bin)), apart_(2 * view.block) {}

  Samples Sample() const {
    const double pixels = static_cast<double>(view_.width) * view_.height;
    const int step = std::max(1, static_cast<int>(std::sqrt(pixels / kSamples)));
    std::array<std::vector<std::pair<int, int>>, kBinPlanes> places;
    for (int row = step / 2; row < view_.height; row += step) {
      for (int column = step / 2; column < view_.width; column += step) {
        const std::size_t k = PlaneAt(column, row);
        if (k < kBinPlanes) places[k].emplace_back(column, row);
      }
    }
    Samples out;
    for (std::size_t k = 0; k < kBinPlanes; ++k) {
      const std::size_t n = places[k].size();
      // Of a wall, which is foreshortened and drops many returns, a finer lattice around each.
      const int finer = n < kEnough / 8 ? 5 : n < kEnough / 2 ? 3 : 1;
      for (std::size_t i = 0; i < n; i += std::max<std::size_t>(1, n / kEnough)) {
        for (int j = 0; j < finer * finer; ++j) {
          Add(k, places[k][i].first + (j % finer - finer / 2) * step / finer,
              places[k][i].second + (j / finer - finer / 2) * step / finer, out[k]);
        }
      }
      if (out[k].size() < kFewestPerPlane) out[k].clear();
    }
    return out;
  }

 private:
  /// Number of the plane that a pixel's place belongs to, kBinPlanes for none.
  std::size_t PlaneAt(int column, int row) const {
    const Eigen::Vector3f& p = view_.At(column, row);
    if (!(p.z() >= kNearest_m)) return kBinPlanes;
    const Vector3 p_N = view_.X_NS * p.cast<double>();
    std::size_t k = 0;
    while (k < kBinPlanes && (std::abs(planes_[k].n_N.dot(p_N) - planes_[k].offset_m) > kGate_m ||
                              !WithinPlane(bin_, k, p_N, kInset_m))) {
      ++k;
    }
    return k;
  }

  /// Keeps a pixel's point when place and normal are those of plane `k`.
  void Add(std::size_t k, int column, int row, std::vector<Vector3>& out) const {
    if (column < 0 || row < 0 || column >= view_.width || row >= view_.height) return;
    if (PlaneAt(column, row) != k) return;
    const auto n_S = NormalAt(view_, column, row, apart_);
    if (!n_S || (view_.X_NS.linear() * *n_S).dot(planes_[k].n_N) < kAligned) return;
    out.push_back(view_.At(column, row).cast<double>());
  }

  const ViewRaster& view_;
  const Bin& bin_;
  const BinPlanes planes_;
  const int apart_;
};

RigidTransform Motion(const Vector6& x) {
  const Vector3 turn = x.tail<3>();
  const double angle = turn.norm();
  const Matrix3 R = angle < 1e-12 ? Matrix3(Matrix3::Identity())
                                  : Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  return MakeTransform(R, x.head<3>());
}

/// Normal equations of one view's six numbers, at the corrections so far.
struct Equations {
  Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
  Vector6 g = Vector6::Zero();
};

Equations Linearize(const Samples& samples, const RigidTransform& X_NS, const Vector6& x,
                    const BinPlanes& planes, double scale_m) {
  Equations out;
  const RigidTransform X_NS_now = X_NS * Motion(x);
  for (std::size_t k = 0; k < kBinPlanes; ++k) {
    const auto& points = samples[k];
    if (points.empty()) continue;
    const double share = std::min(1.0, kMaxPerPlane / static_cast<double>(points.size()));
    const Vector3 n_S = X_NS_now.linear().transpose() * planes[k].n_N;
    for (const Vector3& p_S : points) {
      const double residual = planes[k].n_N.dot(X_NS_now * p_S) - planes[k].offset_m;
      const double q = scale_m * scale_m / (scale_m * scale_m + residual * residual);
      const double w = share * q * q / (kSigma_m * kSigma_m);
      Vector6 J;
      J << n_S, p_S.cross(n_S);
      out.H.noalias() += w * J * J.transpose();
      out.g -= w * residual * J;
    }
  }
  return out;
}

double SquaredResiduals(const Samples& samples, const RigidTransform& X_NS,
                        const BinPlanes& planes) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kBinPlanes; ++k) {
    for (const Vector3& p_S : samples[k]) {
      const double residual = planes[k].n_N.dot(X_NS * p_S) - planes[k].offset_m;
      sum += residual * residual;
    }
  }
  return sum;
}

Vector6 InverseVariances(double shift_m, double turn_rad) {
  Vector6 out;
  out << Vector3::Constant(1.0 / (shift_m * shift_m)),
      Vector3::Constant(1.0 / (turn_rad * turn_rad));
  return out;
}

/// Six numbers per view: what all share plus its own.
std::vector<Vector6> Solve(const std::vector<Samples>& samples,
                           const std::vector<ViewRaster>& views, const BinPlanes& planes) {
  const auto n = static_cast<Eigen::Index>(views.size());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(6 * (n + 1));  // The common six come last.
  Eigen::VectorXd prior(x.size());
  for (Eigen::Index v = 0; v < n; ++v) {
    prior.segment<6>(6 * v) = InverseVariances(kOwnShift_m, kOwnTurn_rad);
  }
  prior.tail<6>() = InverseVariances(kCommonShift_m, kCommonTurn_rad);
  for (const double scale_m : kScales_m) {
    Eigen::MatrixXd H = prior.asDiagonal();
    Eigen::VectorXd g = -prior.cwiseProduct(x);
    for (Eigen::Index v = 0; v < n; ++v) {
      const auto k = static_cast<std::size_t>(v);
      const Equations eq =
          Linearize(samples[k], views[k].X_NS, x.segment<6>(6 * v) + x.tail<6>(), planes, scale_m);
      H.block<6, 6>(6 * v, 6 * v) += eq.H;
      H.block<6, 6>(6 * v, 6 * n) += eq.H;
      H.block<6, 6>(6 * n, 6 * v) += eq.H;
      H.bottomRightCorner<6, 6>() += eq.H;
      g.segment<6>(6 * v) += eq.g;
      g.tail<6>() += eq.g;
    }
    x += H.ldlt().solve(g);
  }
  std::vector<Vector6> out;
  for (Eigen::Index v = 0; v < n; ++v) out.push_back(x.segment<6>(6 * v) + x.tail<6>());
  return out;
}

}  // namespace

Registration RegisterViews(const std::vector<ViewRaster>& views, const Bin& bin,
                           Parallelism parallelism) {
  Registration out;
  out.X_SbelievedS.assign(views.size(), RigidTransform::Identity());
  const auto planes = PlanesOf(bin);
  std::vector<Samples> samples(views.size());
  ParallelFor(static_cast<int>(views.size()), parallelism, [&](int i, int) {
    const auto k = static_cast<std::size_t>(i);
    samples[k] = Sampler(views[k], bin).Sample();
  });
  std::size_t points = 0, floor = 0;
  for (const Samples& s : samples) {
    floor += s[0].size();
    for (const auto& list : s) points += list.size();
  }
  // Walls without any floor at their foot are not where the pose says.
  if (floor == 0) return out;
  const std::vector<Vector6> x = Solve(samples, views, planes);
  double before = 0.0, after = 0.0;
  bool plausible = true;
  for (std::size_t v = 0; v < views.size(); ++v) {
    before += SquaredResiduals(samples[v], views[v].X_NS, planes);
    after += SquaredResiduals(samples[v], views[v].X_NS * Motion(x[v]), planes);
    plausible &= x[v].head<3>().norm() < kMaxShift_m && x[v].tail<3>().norm() < kMaxTurn_rad;
  }
  out.before_m = out.after_m = std::sqrt(before / static_cast<double>(points));
  if (!plausible || after > before) return out;
  out.after_m = std::sqrt(after / static_cast<double>(points));
  out.points = static_cast<int>(points);
  for (std::size_t v = 0; v < views.size(); ++v) out.X_SbelievedS[v] = Motion(x[v]);
  return out;
}

std::string RegistrationWarning(const Registration& registration) {
  constexpr double kExpected_m = 0.0015;
  if (registration.points == 0 || registration.before_m < kExpected_m) return {};
  char text[200];
  std::snprintf(
      text, sizeof text,
      "floor and walls are seen %.1f mm (rms) from where the poses put them, %.1f mm after "
      "correction: check the hand-eye calibration and the bin's size",
      1e3 * registration.before_m, 1e3 * registration.after_m);
  return text;
}

}  // namespace tubetwin
