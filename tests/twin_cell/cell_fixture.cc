#include "tests/twin_cell/cell_fixture.h"

#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/support/paper_scan.h"

namespace tubetwin::test {

Pile OneTube(const std::string& part, const Vector3& p_NMiddle) {
  Pile pile;
  pile.part = LoadPart(part);
  PileTube tube;
  tube.id = 3;
  tube.radius_m = pile.part.radius_m;
  tube.mass_kg = pile.part.mass_kg;
  const int pieces = pile.part.is_hose() ? pile.part.links : 12;
  for (int i = 0; i <= pieces; ++i) {
    const double x = pile.part.length_m * (static_cast<double>(i) / pieces - 0.5);
    tube.centerline_N.push_back(p_NMiddle + Vector3(x, 0, 0));
  }
  pile.tubes = {tube};
  return pile;
}

Pile FarTube() { return OneTube("pvc_a", Vector3(0, 0.1, 0.0126)); }

TwinCellOptions NominalOptions(const Pile& pile, bool exact_wrist) {
  TwinCellOptions options;
  options.model = PaperCell();
  options.scan = PaperScan();
  options.physics = NominalPhysics(pile.part);
  if (exact_wrist) {
    options.physics.wrench_noise_counts = 0.0;
    options.physics.wrench_bias_walk_N = 0.0;
    options.physics.wrench_cross_talk = 0.0;
  }
  return options;
}

Bench::Bench(const Pile& pile, const TwinCellOptions& options)
    : twin_(pile, options), planner_(twin_.cell().model, pile.bin) {}

RigidTransform Bench::Down(const Vector3& p_BE) const {
  return MakeTransform(RotZ(kPi / 2) * RotX(kPi), p_BE);
}

CheckedTrajectory Bench::Line(const RigidTransform& X_BE, MotionOptions options) {
  const MotionResult planned = planner_.PlanLine(cell().arm.State().q, X_BE, options);
  if (const auto* rejected = std::get_if<MotionRejection>(&planned)) FAIL(rejected->reason);
  return std::get<CheckedTrajectory>(planned);
}

void Bench::Run(const MotionResult& planned) {
  if (const auto* rejected = std::get_if<MotionRejection>(&planned)) FAIL(rejected->reason);
  const WaitOutcome outcome = RunTrajectory(cell(), std::get<CheckedTrajectory>(planned));
  INFO(outcome.reason);
  REQUIRE(outcome.status == WaitOutcome::Status::kDone);
}

void Bench::MoveLine(const RigidTransform& X_BE, const MotionOptions& options) {
  Run(Line(X_BE, options));
}

void Bench::Tilt(const Vector3& rotation_B) {
  MotionOptions options;
  options.turn_speed_rad_s = Radians(45.0);
  Run(planner_.PlanTilt(cell().arm.State().q, rotation_B, options));
}

GripperState Bench::GraspAt(const Vector3& p_N, double force_N) {
  MotionOptions options;
  options.finger_clearance_m = 0.001;
  const Vector3 p_B = cell().bin.X_BN * p_N;
  MoveLine(Down(p_B + Vector3(0, 0, 0.15)), options);
  MoveLine(Down(p_B + Vector3(0, 0, GraspHeightOverAxis(p_N.z(), PaperCell().gripper))), options);
  return MoveGripper(cell(), {0.0, 0.10, force_N}).state;
}

}  // namespace tubetwin::test
