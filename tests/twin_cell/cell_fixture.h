#pragma once

#include <string>
#include <vector>

#include "planner/motion/motion_planner.h"
#include "scenes/pile.h"
#include "twin/cell/twin_cell.h"
#include "twin/cell/twin_cell_impl.h"

namespace tubetwin {

/// Lets the room's tests look behind the devices.
class TwinCellProbe {
 public:
  static TwinCell::Impl& Impl(TwinCell& cell) { return *cell.impl_; }
};

namespace test {

/// A pile of one straight tube of the part in the default bin, along x of N, its middle at
/// `p_NMiddle` (z: of the axis).
Pile OneTube(const std::string& part, const Vector3& p_NMiddle);

/// A tube of pvc_a on the floor, 0.1 m beside the bin's middle.
Pile FarTube();

/// Nominal physics; the wrist without noise, drift and cross-talk when `exact_wrist`.
TwinCellOptions NominalOptions(const Pile& pile, bool exact_wrist = false);

/// A twin cell with what the tests do to it. Motions are planned by planner/motion_plan.
class Bench {
 public:
  explicit Bench(const Pile& pile, const TwinCellOptions& options);
  explicit Bench(const Pile& pile) : Bench(pile, NominalOptions(pile)) {}

  Cell& cell() { return twin_.cell(); }
  TwinCell& twin() { return twin_; }
  TwinCell::Impl& impl() { return TwinCellProbe::Impl(twin_); }
  const MotionPlanner& planner() const { return planner_; }
  RigidTransform X_BE() { return planner_.PoseOfE(impl().arm.TruePosition()); }

  /// Tool down, fingers closing across x of N (along B's x when the bin stands as by default).
  RigidTransform Down(const Vector3& p_BE) const;
  CheckedTrajectory Line(const RigidTransform& X_BE, MotionOptions options = {});
  void MoveLine(const RigidTransform& X_BE, const MotionOptions& options = {});
  void Tilt(const Vector3& rotation_B);
  /// Lines to over the tube's axis at p_N, down to it, closes.
  GripperState GraspAt(const Vector3& p_N, double force_N = 60.0);

 private:
  void Run(const MotionResult& planned);

  TwinCell twin_;
  MotionPlanner planner_;
};

}  // namespace test
}  // namespace tubetwin
