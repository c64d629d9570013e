#include "perception/axis_points.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace tubetwin {
namespace {

/// Floor points end here: noise at twice the data sheet plus hand-eye error stays below.
constexpr float kFloor_m = 0.003f;
/// Points this close to a wall belong to it; of a tube that leans there only the strip that turns
/// to the wall is lost.
constexpr float kWall_m = 0.0025f;
/// Nothing that lies in a bin is higher; the gripper's fingers are.
constexpr float kCeiling_m = 0.25f;
/// Cosine of the steepest incidence that still gives a normal.
constexpr float kGrazing = 0.3f;
/// Fewest neighbours of a normal, and the largest roughness of their plane as a share of the
/// radius (a window of 3.5 mm on a tube bulges by 0.01 r).
constexpr int kFewest = 8;
constexpr float kRoughness = 0.035f;

}  // namespace

Foreground::Foreground(const Bin& bin, double margin_m)
    : half_x_(static_cast<float>(bin.half_x_m())),
      half_y_(static_cast<float>(bin.half_y_m())),
      wall_(static_cast<float>(bin.wall_m())),
      margin_(static_cast<float>(margin_m)) {}

bool Foreground::Contains(const Eigen::Vector3f& p_N) const {
  if (p_N.z() < kFloor_m || p_N.z() > std::max(kCeiling_m, wall_ + 0.1f)) return false;
  const float out_x = std::abs(p_N.x()) - half_x_;
  const float out_y = std::abs(p_N.y()) - half_y_;
  const float out = std::max(out_x, out_y);
  if (out > margin_) return false;
  // Distance to the solid frame of the four walls: 0 within half_x .. half_x + thickness.
  const float thick = static_cast<float>(Bin::kWallThickness_m);
  if (out < -kWall_m || out > thick + kWall_m) return true;
  const float sideways = out < 0 ? -out : std::max(0.0f, out - thick);
  const float above = std::max(0.0f, p_N.z() - wall_);
  return sideways * sideways + above * above > kWall_m * kWall_m;
}

namespace {

/// Sums over the window of one block, relative to the block's own point.
struct Window {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  int count = 0;
};

/// The window's normal in S, turned to the sensor; false when the surface is no smooth one.
bool FitNormal(const Window& w, const Eigen::Vector3f& p_S, float radius_m, Eigen::Vector3f& n_S) {
  if (w.count < kFewest) return false;
  const Eigen::Vector3f mean = w.sum / static_cast<float>(w.count);
  const Eigen::Matrix3f covariance =
      w.squares / static_cast<float>(w.count) - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(covariance);
  const float rough = kRoughness * radius_m;
  if (solver.eigenvalues()(0) > rough * rough) return false;
  // A line of points has no normal.
  if (solver.eigenvalues()(1) < 0.1f * solver.eigenvalues()(2)) return false;
  n_S = solver.eigenvectors().col(0);
  if (n_S.dot(p_S) > 0) n_S = -n_S;
  return true;
}

/// Blocks on either side of the centre, so that the window is about 3.5 mm wide.
int HalfWindow(const ViewImage& view) {
  return std::clamp(static_cast<int>(std::lround(0.0015 / view.pitch_m)), 1, 4);
}

Window GatherWindow(const ViewImage& view, const std::vector<char>& mask, int column, int row,
                    int half, float reach_m) {
  Window w;
  const Eigen::Vector3f& centre = view.p_S[view.Index(column, row)];
  const float reach2 = reach_m * reach_m;
  for (int j = std::max(0, row - half); j <= std::min(view.height - 1, row + half); ++j) {
    for (int i = std::max(0, column - half); i <= std::min(view.width - 1, column + half); ++i) {
      const std::size_t index = view.Index(i, j);
      if (mask[index] == 0) continue;
      const Eigen::Vector3f d = view.p_S[index] - centre;
      if (d.squaredNorm() > reach2) continue;
      w.sum += d;
      w.squares.noalias() += d * d.transpose();
      ++w.count;
    }
  }
  return w;
}

}  // namespace

SurfaceOfView FindSurface(const ViewImage& view, const Foreground& foreground, double radius_m) {
  SurfaceOfView out;
  const Eigen::Isometry3f X_NS = view.X_NS.cast<float>();
  std::vector<char> mask(view.p_S.size(), 0);
  for (std::size_t i = 0; i < view.p_S.size(); ++i) {
    mask[i] = IsValid(view.p_S[i]) && foreground.Contains(X_NS * view.p_S[i]);
  }
  const int half = HalfWindow(view);
  // Along a surface seen at 60 degrees a window reaches twice as far as its width.
  const float reach_m = static_cast<float>(2.5 * (half + 0.5) * view.pitch_m);
  const auto r = static_cast<float>(radius_m);
  for (int row = 0; row < view.height; ++row) {
    for (int column = 0; column < view.width; ++column) {
      const std::size_t index = view.Index(column, row);
      if (mask[index] == 0) continue;
      const Eigen::Vector3f& p_S = view.p_S[index];
      const Window w = GatherWindow(view, mask, column, row, half, reach_m);
      Eigen::Vector3f n_S;
      const bool smooth = FitNormal(w, p_S, r, n_S);
      const float incidence = smooth ? -n_S.dot(p_S.normalized()) : 0.0f;
      if (incidence < kGrazing) {
        out.rejected_N.push_back(X_NS * p_S);
        continue;
      }
      const Eigen::Vector3f p_N = X_NS * p_S;
      const Eigen::Vector3f n_N = X_NS.linear() * n_S;
      out.points.push_back({p_N, n_N, p_N - r * n_N, incidence});
    }
  }
  return out;
}

}  // namespace tubetwin
