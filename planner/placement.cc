#include "planner/placement.h"

#include <algorithm>
#include <cmath>

#include "hw_bridge/base/error.h"

namespace tubetwin {

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

int SlotCount(const CellLayout& layout) {
  return 1 + static_cast<int>(std::floor(layout.tray_zone_m / layout.slot_pitch_m + 1e-9));
}

Matrix3 VerticalTool(double yaw_rad) { return RotZ(yaw_rad) * RotX(kPi); }

double ToolYaw(const Matrix3& R_BE) { return std::atan2(R_BE(1, 0), R_BE(0, 0)); }

PlacementPose PlanPlacement(const CellLayout& layout, const Polyline& line_E, double radius_m,
                            int index, double yaw_near_rad) {
  const int slots = SlotCount(layout);
  const double x_T = (index % slots - 0.5 * (slots - 1)) * layout.slot_pitch_m;
  PlacementPose out;
  out.slot_centre_T = Vector3(x_T, 0.0, 0.0);

  // Turn the tool so that the tube's direction lies along +-y of the tray, by the smaller turn.
  const Vector3 direction_E = PrincipalDirection(line_E);
  const Vector3 direction_0 = VerticalTool(0.0) * direction_E;
  const double tube_angle = std::atan2(direction_0.y(), direction_0.x());
  double yaw = kPi / 2 - tube_angle;
  yaw += kPi * std::round((yaw_near_rad - yaw) / kPi);
  const Matrix3 R_TE = VerticalTool(yaw);

  const Polyline line_T0 = Transformed(MakeTransform(R_TE, Vector3::Zero()), line_E);
  const Vector3 centre = CurveCentre(line_T0);
  double lowest = line_T0.front().z();
  for (const Vector3& p : line_T0) lowest = std::min(lowest, p.z());
  Vector3 p_TE = out.slot_centre_T - centre;
  const double half = 0.5 * layout.tray_zone_m;
  p_TE.x() = std::clamp(p_TE.x(), -half, half);
  p_TE.y() = std::clamp(p_TE.y(), -half, half);
  p_TE.z() = radius_m - lowest;
  out.X_BE = layout.X_BT * MakeTransform(R_TE, p_TE);
  return out;
}

}  // namespace tubetwin
