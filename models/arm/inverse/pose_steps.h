#pragma once

#include <optional>

#include "models/arm/arm.h"

namespace tubetwin {

/// Steps that every inverse kinematics shares. Thread safe.

inline constexpr double kPoseTolerance = 1e-9;  ///< Metres and radians, of every solution.
/// Joint steps above this are no longer the refinement of a known solution.
inline constexpr double kNewtonReach_rad = 0.35;

/// The angle turned into (-pi, pi].
double WrapToPi(double angle);

/// Largest difference of two joint vectors, full turns aside.
double LargestDifference(const JointVector& a, const JointVector& b);

/// The larger of the distance in metres and of the rotation matrices' difference.
double PoseError(const RigidTransform& X_BF, const RigidTransform& X_BGoal);

/// Newton steps from q towards the flange pose, to a tenth of kPoseTolerance; nothing when they do
/// not converge at once.
std::optional<JointVector> PolishJoints(const ArmModel& arm, const RigidTransform& X_BF,
                                        JointVector q, int iterations);

}  // namespace tubetwin
