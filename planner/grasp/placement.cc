#include "planner/grasp/placement.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr double kSample_m = 0.008;     ///< Along tubes, for distances on the tray.
constexpr double kRowGap_m = 0.01;      ///< Between two rows of slots.
constexpr double kFarEnough_m = 0.045;  ///< Fingers pass between tubes this far apart.

}  // namespace

Vector3 PrincipalDirection(const Polyline& line) {
  TT_CHECK(line.size() >= 2);
  const Polyline points = ResampleCount(line, 64);
  Vector3 mean = Vector3::Zero();
  for (const Vector3& p : points) mean += p / static_cast<double>(points.size());
  Matrix3 covariance = Matrix3::Zero();
  for (const Vector3& p : points) covariance += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(covariance);
  const Vector3 chord = points.back() - points.front();
  Vector3 direction = solver.eigenvectors().col(2);
  // For a U the two largest spreads are alike and the axes may swap: the chord is steadier there.
  const bool ambiguous = solver.eigenvalues()[1] > 0.6 * solver.eigenvalues()[2];
  if (ambiguous && chord.norm() > 0.1 * Length(line)) direction = chord.normalized();
  return direction.dot(chord) < 0.0 ? Vector3(-direction) : direction;
}

std::vector<Vector3> Slots(const CellLayout& layout, double extent_y_m) {
  const int columns =
      1 + static_cast<int>(std::floor(layout.tray_zone_m / layout.slot_pitch_m + 1e-9));
  const bool two_rows = 2.0 * (extent_y_m + kRowGap_m) < layout.tray_size_m;
  std::vector<Vector3> out;
  for (int column = 0; column < columns; ++column) {
    const double x = (column - 0.5 * (columns - 1)) * layout.slot_pitch_m;
    for (const double row : two_rows ? std::vector<double>{-1.0, 1.0} : std::vector<double>{0.0}) {
      out.emplace_back(x, row * 0.25 * layout.tray_size_m, 0.0);
    }
  }
  return out;
}

Matrix3 VerticalTool(double yaw_rad) { return RotZ(yaw_rad) * RotX(kPi); }

double ToolYaw(const Matrix3& R_BE) { return std::atan2(R_BE(1, 0), R_BE(0, 0)); }

namespace {

/// The tube at one slot with one yaw, as high as what lies there already asks for.
PlacementPose PoseAt(const CellLayout& layout, const Polyline& line_E, double radius_m,
                     double min_height_E_m, const std::vector<Polyline>& placed_T,
                     const Vector3& slot_T, double yaw_rad) {
  PlacementPose out;
  out.slot_centre_T = slot_T;
  const Matrix3 R_TE = VerticalTool(yaw_rad);
  const Polyline line_T0 = Transformed(MakeTransform(R_TE, Vector3::Zero()), line_E);
  const Vector3 centre = CurveCentre(line_T0);
  double lowest = line_T0.front().z();
  for (const Vector3& p : line_T0) lowest = std::min(lowest, p.z());
  Vector3 p_TE = slot_T - centre;
  const double half = 0.5 * layout.tray_zone_m;
  p_TE.x() = std::clamp(p_TE.x(), -half, half);
  p_TE.y() = std::clamp(p_TE.y(), -half, half);
  p_TE.z() = radius_m - lowest;
  out.line_T = Transformed(MakeTransform(R_TE, p_TE), Resample(line_E, kSample_m));
  for (const Vector3& p : out.line_T) {
    for (const Polyline& other : placed_T) {
      for (const Vector3& q : other) {
        const double apart = (p - q).head<2>().norm();
        if (apart >= 2.0 * radius_m) continue;
        const double on_top = q.z() + std::sqrt(4.0 * radius_m * radius_m - apart * apart);
        out.raised_m = std::max(out.raised_m, on_top - p.z());
      }
    }
  }
  for (Vector3& p : out.line_T) p.z() += out.raised_m;
  p_TE.z() = std::max(p_TE.z(), min_height_E_m) + out.raised_m;
  out.X_BE = layout.X_BT * MakeTransform(R_TE, p_TE);
  return out;
}

/// Smallest horizontal distance to what lies already, at most kFarEnough_m.
double Room(const Polyline& line_T, const std::vector<Polyline>& placed_T) {
  double room = kFarEnough_m;
  for (const Polyline& other : placed_T) {
    for (const Vector3& p : line_T) {
      for (const Vector3& q : other) room = std::min(room, (p - q).head<2>().norm());
    }
  }
  return room;
}

/// How far the tube would reach over the tray's edge if it toppled: what stands up falls aside by
/// its height.
double ToppleOver(const CellLayout& layout, const Polyline& line_T, double radius_m) {
  double over_m = 0.0;
  for (const Vector3& p : line_T) {
    const double reach_m = p.head<2>().cwiseAbs().maxCoeff() + p.z() - radius_m;
    over_m = std::max(over_m, reach_m - 0.5 * layout.tray_size_m);
  }
  return over_m;
}

}  // namespace

std::optional<PlacementPose> PlanPlacement(
    const CellLayout& layout, const Polyline& line_E, double radius_m, double min_height_E_m,
    const std::vector<Polyline>& placed_T, double yaw_near_rad,
    const std::function<bool(const RigidTransform& X_BE)>& reachable) {
  // Yaw that turns the tube's direction along the tray's y.
  const Vector3 direction_E = PrincipalDirection(line_E);
  const Vector3 direction_0 = VerticalTool(0.0) * direction_E;
  double yaw = kPi / 2 - std::atan2(direction_0.y(), direction_0.x());
  yaw += kPi * std::round((yaw_near_rad - yaw) / kPi);
  const double other_yaw = yaw + (yaw > yaw_near_rad ? -kPi : kPi);

  double low = 1e9, high = -1e9;
  for (const Vector3& p : Transformed(MakeTransform(VerticalTool(yaw), Vector3::Zero()), line_E)) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  const std::vector<Vector3> slots = Slots(layout, high - low + 2.0 * radius_m);
  std::optional<PlacementPose> best;
  double best_score = -1e9;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    for (const double candidate : {yaw, other_yaw}) {
      PlacementPose pose =
          PoseAt(layout, line_E, radius_m, min_height_E_m, placed_T, slots[i], candidate);
      pose.slot = static_cast<int>(i);
      const double score =
          Room(pose.line_T, placed_T) - pose.raised_m - ToppleOver(layout, pose.line_T, radius_m);
      if (score > best_score + 1e-9 && reachable(pose.X_BE)) {
        best_score = score;
        best = std::move(pose);
      }
    }
  }
  return best;
}

}  // namespace tubetwin
