#include "perception/calibration/solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "perception/view/view_raster.h"

namespace tubetwin::calibration_internal {
namespace {

constexpr double kSurfacePoints = 30000.0;  ///< Of a view, holes included.
constexpr double kPitch_m = 0.0015;         ///< Blocks of the raster; normals span 4 to 8 of them.
constexpr std::size_t kFewest = 40;         ///< Fewer points of a plane are not trusted.
/// Points this close to another plane or the rim may show its edge.
constexpr double kInset_m = 0.012;
/// Damping of what nothing tells, as a share of the largest information.
constexpr double kDamping = 1e-9;
/// Points inside the bin: further than this from its walls and over its floor.
constexpr double kInside_m = 0.03, kOverFloor_m = 0.01;

/// Directions that nothing tells.
constexpr double kUnknown_m = std::numeric_limits<double>::infinity();

RigidTransform MotionBy(const Eigen::Matrix<double, 6, 1>& step) {
  const Vector3 turn = step.tail<3>() / kLever_m;
  const double angle = turn.norm();
  const Matrix3 R = angle < 1e-12 ? Matrix3(Matrix3::Identity())
                                  : Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  return MakeTransform(R, step.head<3>());
}

}  // namespace

// From a start that is centimetres and degrees off to a tenth of a millimetre. Edges and what else
// is no plane loses its weight only when the planes are where they should be.
const std::vector<PlaneSolver::Pass>& PlaneSolver::Passes() {
  static const std::vector<Pass> passes = [] {
    std::vector<Pass> out = {{0.06, 0.80, 0.0},   {0.06, 0.80, 0.0},  {0.06, 0.85, 0.03},
                             {0.06, 0.85, 0.03},  {0.04, 0.90, 0.01}, {0.04, 0.90, 0.01},
                             {0.03, 0.93, 0.005}, {0.03, 0.95, 0.005}};
    out.resize(20, {0.03, 0.95, 0.002});
    return out;
  }();
  return passes;
}

std::vector<SurfacePoint> SurfacePointsOf(const OrganizedCloud& cloud) {
  const ViewRaster view = MakeViewRaster(cloud, kPitch_m);
  std::vector<SurfacePoint> out;
  const double pixels = static_cast<double>(view.width) * view.height;
  const int step = std::max(1, static_cast<int>(std::sqrt(pixels / kSurfacePoints)));
  for (int row = step / 2; row < view.height; row += step) {
    for (int column = step / 2; column < view.width; column += step) {
      const Eigen::Vector3f& p = view.At(column, row);
      if (!(p.z() >= kNearest_m)) continue;
      if (const auto n_S = NormalAt(view, column, row, 2 * view.block)) {
        out.push_back({p.cast<double>(), *n_S});
      }
    }
  }
  return out;
}

PlaneSolver::PlaneSolver(const CalibrationInput& input,
                         const std::vector<std::vector<SurfacePoint>>& points)
    : input_(input), points_(points), planes_(PlanesOf(input.bin)) {}

std::size_t PlaneSolver::PlaneOf(const Vector3& p_N, const Vector3& n_N, const Pass& pass) const {
  // The rim is half a gate's way from neither floor nor air.
  const double gate_m = std::min(pass.gate_m, 0.5 * input_.bin.wall_m());
  for (std::size_t k = 0; k < kBinPlanes; ++k) {
    if (n_N.dot(planes_[k].n_N) > pass.aligned &&
        std::abs(planes_[k].n_N.dot(p_N) - planes_[k].offset_m) < gate_m &&
        WithinPlane(input_.bin, k, p_N, kInset_m)) {
      return k;
    }
  }
  return kBinPlanes;
}

std::size_t PlaneSolver::PlaneOfTouch(const CalibrationTouch& touch,
                                      const RigidTransform& X_NB) const {
  if (touch.on_floor) return 0;
  std::size_t nearest = 1;
  const auto off = [&](std::size_t k) {
    return std::abs(planes_[k].n_N.dot(X_NB * touch.p_B) - planes_[k].offset_m);
  };
  for (std::size_t k = 2; k < kBinPlanes; ++k) {
    if (off(k) < off(nearest)) nearest = k;
  }
  return nearest;
}

std::vector<PlanePoints> PlaneSolver::Assign(const Estimate& at, const Pass& pass) const {
  std::vector<PlanePoints> out;
  for (std::size_t v = 0; v < points_.size(); ++v) {
    const RigidTransform X_NS = at.X_NB * input_.views[v].X_BF * at.X_FS;
    std::array<std::vector<Vector3>, kBinPlanes> found;
    for (const SurfacePoint& point : points_[v]) {
      const std::size_t k = PlaneOf(X_NS * point.p_S, X_NS.linear() * point.n_S, pass);
      if (k < kBinPlanes) found[k].push_back(point.p_S);
    }
    for (std::size_t k = 0; k < kBinPlanes; ++k) {
      if (found[k].size() >= kFewest) out.push_back({v, true, k, std::move(found[k])});
    }
  }
  for (std::size_t i = 0; i < input_.touches.size(); ++i) {
    const CalibrationTouch& touch = input_.touches[i];
    out.push_back({points_.size() + i, false, PlaneOfTouch(touch, at.X_NB), {touch.p_B}});
  }
  return out;
}

std::vector<PlanePoints> PlaneSolver::Assign(const Estimate& at) const {
  return Assign(at, Passes().back());
}

double PlaneSolver::ShareInside(const Estimate& at) const {
  std::size_t all = 0, inside = 0;
  for (std::size_t v = 0; v < points_.size(); ++v) {
    const RigidTransform X_NS = at.X_NB * input_.views[v].X_BF * at.X_FS;
    for (const SurfacePoint& point : points_[v]) {
      const Vector3 p_N = X_NS * point.p_S;
      inside += p_N.z() > kOverFloor_m && p_N.z() < input_.bin.wall_m() &&
                std::abs(p_N.x()) < input_.bin.half_x_m() - kInside_m &&
                std::abs(p_N.y()) < input_.bin.half_y_m() - kInside_m;
    }
    all += points_[v].size();
  }
  return all == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(all);
}

double PlaneSolver::Distance(const PlanePoints& group, const Vector3& p, const Estimate& at,
                             Numbers& change) const {
  const Vector3& n_N = planes_[group.plane].n_N;
  const RigidTransform X_NP =
      group.seen ? at.X_NB * input_.views[group.source].X_BF * at.X_FS : at.X_NB;
  const Vector3 n_P = X_NP.linear().transpose() * n_N;
  const Vector3 p_N = X_NP * p;
  change.setZero();
  if (group.seen) change.head<6>() << n_P, p.cross(n_P) / kLever_m;
  change.segment<6>(kFirstOfBin) << n_N, p_N.cross(n_N) / kLever_m;
  // Half of what the bin is longer is on this side.
  change.tail<2>() = 0.5 * n_N.head<2>().cwiseAbs();
  return n_N.dot(p_N) - planes_[group.plane].offset_m + change.tail<2>().dot(at.longer_m);
}

std::vector<double> PlaneSolver::Distances(const PlanePoints& group, const Estimate& at) const {
  std::vector<double> out;
  out.reserve(group.points.size());
  Numbers change;
  for (const Vector3& p : group.points) out.push_back(Distance(group, p, at, change));
  return out;
}

void PlaneSolver::Linearize(const std::vector<PlanePoints>& groups, const Estimate& at,
                            double scale_m, InformationMatrix& H, Numbers& g) const {
  const double size = 1.0 / (kSizeSigma_m * kSizeSigma_m);
  H.setZero();
  H.diagonal().tail<2>().setConstant(size);
  g.setZero();
  g.tail<2>() = -size * at.longer_m;
  Numbers J;
  for (const PlanePoints& group : groups) {
    const double sigma_m = group.seen ? kPlaneSigma_m : kTouchSigma_m;
    const double share = 1.0 / (sigma_m * sigma_m * static_cast<double>(group.points.size()));
    for (const Vector3& p : group.points) {
      const double residual = Distance(group, p, at, J);
      const double near =
          scale_m > 0.0 ? scale_m * scale_m / (scale_m * scale_m + residual * residual) : 1.0;
      const double weight = share * near * near;
      H.noalias() += weight * J * J.transpose();
      g.noalias() -= weight * residual * J;
    }
  }
}

InformationMatrix PlaneSolver::Information(const std::vector<PlanePoints>& groups,
                                           const Estimate& at) const {
  InformationMatrix H;
  Numbers g;
  Linearize(groups, at, 0.0, H, g);
  return H;
}

Estimate PlaneSolver::Solve(const Estimate& start, Unknown unknown) const {
  Estimate at = start;
  const std::vector<int> active = ActiveNumbers(unknown);
  for (const Pass& pass : Passes()) {
    InformationMatrix H;
    Numbers g;
    Linearize(Assign(at, pass), at, pass.scale_m, H, g);
    Eigen::MatrixXd some = H(active, active);
    some.diagonal().array() += kDamping * some.diagonal().maxCoeff();
    const Eigen::VectorXd gradient = g(active);
    const Eigen::VectorXd found = some.ldlt().solve(gradient);
    Numbers step = Numbers::Zero();
    step(active) = found;
    at.X_FS = at.X_FS * MotionBy(step.head<6>());
    at.X_NB = MotionBy(step.segment<6>(kFirstOfBin)) * at.X_NB;
    at.longer_m += step.tail<2>();
  }
  return at;
}

std::vector<int> ActiveNumbers(Unknown unknown) {
  std::vector<int> out;
  for (int i = unknown == Unknown::kScanner ? 0 : kFirstOfBin; i < kNumbers; ++i) {
    const bool leans = i == kFirstOfBin + 3 || i == kFirstOfBin + 4;
    if (unknown != Unknown::kBinLevel || !leans) out.push_back(i);
  }
  return out;
}

double WorstSigma(const InformationMatrix& information, Unknown unknown) {
  std::vector<int> sought, rest;
  for (const int i : ActiveNumbers(unknown)) {
    const bool is_sought = i < (unknown == Unknown::kScanner ? kFirstOfBin : kFirstOfSize);
    (is_sought ? sought : rest).push_back(i);
  }
  // What the others, not known either, leave of it.
  Eigen::MatrixXd others = information(rest, rest);
  others.diagonal().array() += kDamping * others.diagonal().maxCoeff();
  const Eigen::MatrixXd cross = information(sought, rest);
  const Eigen::MatrixXd left = Eigen::MatrixXd(information(sought, sought)) -
                               cross * others.ldlt().solve(Eigen::MatrixXd(cross.transpose()));
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(left).eigenvalues()[0];
  return least > 0.0 ? 1.0 / std::sqrt(least) : kUnknown_m;
}

}  // namespace tubetwin::calibration_internal
