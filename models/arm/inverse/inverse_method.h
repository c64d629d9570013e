#pragma once

#include <vector>

#include "models/arm/arm.h"

namespace tubetwin {

/// One way to compute inverse kinematics. A new one is a file here and a line in
/// inverse_methods.cc. Thread safe: none keeps anything between calls.
struct InverseMethod {
  const char* name;  ///< As an arm file writes it.
  /// Throws Error(kConfig) naming the axes when the arm's geometry is not of the kind that this
  /// method solves.
  void (*check)(const ArmModel& arm);
  /// Candidates for every solution of the flange pose, each near enough for four Newton steps to
  /// reach it; false and repeated ones do no harm. InverseAll checks, wraps and sorts them.
  std::vector<JointVector> (*solve)(const ArmModel& arm, const RigidTransform& X_BF);
  /// Milliseconds a call: where one solution near a known one is enough, that is followed instead.
  bool costly = false;
};

/// All of them.
const std::vector<InverseMethod>& InverseMethods();

/// The one that the arm names. Throws Error(kConfig) naming the nearest when there is none.
const InverseMethod& MethodOf(const ArmModel& arm);

InverseMethod OffsetWristInverse();     ///< Axes 4, 5, 6 in a row with an offset: HC10.
InverseMethod SphericalWristInverse();  ///< Axes 4, 5, 6 meet; axes 2 and 3 are parallel.
InverseMethod ThreeParallelInverse();   ///< Axes 2, 3, 4 are parallel, 5 and 6 meet: UR.
InverseMethod NumericInverse();         ///< Any geometry.

}  // namespace tubetwin
