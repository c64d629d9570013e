#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/arm/arm.h"

namespace tubetwin {

/// What the closed forms share: lines of axes, and the few equations that they come down to.
/// Thread safe.

/// Metres, or sines of angles: what counts as meeting or parallel. The digits of a published
/// description are worse than rounding; Newton steps make up for the rest.
inline constexpr double kSameGeometry = 1e-5;

/// "[0, 0.162, 0]".
std::string VectorText(const Vector3& v);

/// Throws Error(kConfig): the arm's inverse kinematics does not solve it, because of `problem`.
[[noreturn]] void RefuseGeometry(const ArmModel& arm, const std::string& problem);

/// Where the origin of link i (1 to 6) lies in B when all joints are at zero; 0 is B's own.
std::array<Vector3, kNumJoints + 1> OriginsAtZero(const ArmModel& arm);

/// Throws Error(kConfig) unless axes i and j (counted from 1) are parallel.
void RequireParallel(const ArmModel& arm, int i, int j);
/// The same unless they are not.
void RequireNotParallel(const ArmModel& arm, int i, int j);

/// The point nearest to all of the axes (counted from 1) at zero, in B. Throws Error(kConfig) when
/// one of them passes it at more than kSameGeometry, or when they are parallel.
Vector3 RequireMeeting(const ArmModel& arm, const std::vector<int>& axes);

/// The angles x with a cos x + b sin x = c: two, or one where they fall together, or none. Where a
/// and b vanish, any angle is as good as another: zero.
std::vector<double> SolveCosSin(double a, double b, double c);

/// The turn about a unit axis that brings `from` to `to`, as seen along it; zero where one of the
/// two lies along the axis.
double AngleAbout(const Vector3& axis, const Vector3& from, const Vector3& to);

/// Two links that turn about parallel axes u: l1 from the first axis to the second, l2 from there
/// to a point, both at zero.
struct TwoLinks {
  Vector3 u, l1, l2;

  struct Angles {
    double first, second;  ///< Both about u.
  };
  /// The angles that bring the point to v from the first axis; what lies along u is left out.
  std::vector<Angles> Reach(const Vector3& v) const;
};

}  // namespace tubetwin
