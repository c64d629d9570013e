#include "models/arm/inverse/geometry.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

/// What rounding may leave beyond the last point that can be reached, metres or sines.
constexpr double kRounding = 1e-9;

const Vector3& Axis(const ArmModel& arm, int i) { return arm.joints[i - 1].axis; }

double SineBetween(const ArmModel& arm, int i, int j) {
  return Axis(arm, i).cross(Axis(arm, j)).norm();
}

std::string AxesText(const std::vector<int>& axes) {
  std::string text = "axes ";
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (i > 0) text += i + 1 == axes.size() ? " and " : ", ";
    text += std::to_string(axes[i]);
  }
  return text;
}

Vector3 Across(const Vector3& u, const Vector3& v) { return v - u * u.dot(v); }

}  // namespace

std::string VectorText(const Vector3& v) {
  return "[" + Number(v.x()) + ", " + Number(v.y()) + ", " + Number(v.z()) + "]";
}

void RefuseGeometry(const ArmModel& arm, const std::string& problem) {
  throw Error(ErrorKind::kConfig, "arm '" + arm.name + "': inverse = \"" + arm.inverse +
                                      "\" does not solve this geometry: " + problem +
                                      "\n\"numeric\" solves any");
}

std::array<Vector3, kNumJoints + 1> OriginsAtZero(const ArmModel& arm) {
  std::array<Vector3, kNumJoints + 1> origins;
  origins[0] = Vector3::Zero();
  for (int i = 0; i < kNumJoints; ++i) {
    origins[i + 1] = origins[i] + arm.joints[i].origin_in_parent_m;
  }
  return origins;
}

void RequireParallel(const ArmModel& arm, int i, int j) {
  if (SineBetween(arm, i, j) < kSameGeometry) return;
  RefuseGeometry(arm, AxesText({i, j}) + " have to be parallel, but point along " +
                          VectorText(Axis(arm, i)) + " and " + VectorText(Axis(arm, j)));
}

void RequireNotParallel(const ArmModel& arm, int i, int j) {
  if (SineBetween(arm, i, j) > kSameGeometry) return;
  RefuseGeometry(arm, AxesText({i, j}) + " must not be parallel");
}

Vector3 RequireMeeting(const ArmModel& arm, const std::vector<int>& axes) {
  const auto origins = OriginsAtZero(arm);
  // Least squares: the sum of projections across each axis, applied to the point.
  Matrix3 A = Matrix3::Zero();
  Vector3 b = Vector3::Zero();
  for (const int i : axes) {
    const Matrix3 across = Matrix3::Identity() - Axis(arm, i) * Axis(arm, i).transpose();
    A += across;
    b += across * origins[i];
  }
  for (std::size_t k = 1; k < axes.size(); ++k) RequireNotParallel(arm, axes[k - 1], axes[k]);
  Vector3 point = A.inverse() * b;
  for (const int i : axes) {
    const double miss_m = Across(Axis(arm, i), point - origins[i]).norm();
    if (miss_m < kSameGeometry) continue;
    RefuseGeometry(arm, AxesText(axes) + " have to meet in one point, but axis " +
                            std::to_string(i) + " passes " +
                            Number(std::round(miss_m * 1e6) / 1e3) + " mm from it");
  }
  return point;
}

std::vector<double> SolveCosSin(double a, double b, double c) {
  const double r = std::hypot(a, b);
  if (std::abs(c) > r + kRounding) return {};
  if (r < kRounding) return {0.0};
  const double middle = std::atan2(b, a);
  const double half = std::acos(std::clamp(c / r, -1.0, 1.0));
  if (half == 0.0 || half == kPi) return {middle + half};
  return {middle + half, middle - half};
}

double AngleAbout(const Vector3& axis, const Vector3& from, const Vector3& to) {
  const Vector3 a = Across(axis, from), b = Across(axis, to);
  if (a.norm() < kRounding || b.norm() < kRounding) return 0.0;
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

std::vector<TwoLinks::Angles> TwoLinks::Reach(const Vector3& v) const {
  const Vector3 a = Across(u, l1), b = Across(u, l2), goal = Across(u, v);
  const double c = 0.5 * (goal.squaredNorm() - a.squaredNorm() - b.squaredNorm());
  std::vector<Angles> out;
  for (const double second : SolveCosSin(a.dot(b), a.dot(u.cross(b)), c)) {
    const Vector3 sum = a + Eigen::AngleAxisd(second, u) * b;
    out.push_back({AngleAbout(u, sum, goal), second});
  }
  return out;
}

}  // namespace tubetwin
