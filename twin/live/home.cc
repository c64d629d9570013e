#include "twin/live/home.h"

#include "hw_bridge/cell/left_over.h"
#include "models/base/error.h"
#include "planner/motion/path_builder.h"
#include "planner/motion/path_executor.h"
#include "twin/cell/cell_world.h"

namespace tubetwin {
namespace {

[[noreturn]] void RefuseHome(const std::string& why, const std::string& remedy) {
  throw Error(ErrorKind::kDevice, "home: " + why + "; " + remedy + "; nothing was moved");
}

/// Nobody carries home what nobody knows of.
void RequireEmptyFingers(const Cell& cell, double part_mass_kg) {
  const GripperState fingers = cell.gripper.State();
  if (!fingers.activated) {
    RefuseHome("gripper: is not activated, so that nobody knows what is between its fingers",
               "see `doctor --activate-gripper`");
  }
  std::string held = LeftInFingers(fingers);
  if (held.empty()) {
    held =
        LeftOnWrist(cell.wrist.Read(), cell.arm.State().q, cell.model, cell.safety, part_mass_kg);
  }
  if (!held.empty()) {
    RefuseHome(held, "take it out, or let `run` at a terminal put it back into the bin");
  }
}

}  // namespace

JointVector DriveHome(Cell& cell, double part_mass_kg) {
  RequireEmptyFingers(cell, part_mass_kg);
  PathExecutor executor(cell);
  executor.Resync();
  const RigidTransform X_BE = executor.planner().PoseOfE(HomePosition(cell.model, cell.bin));
  const PathConfig limits;
  PathBuilder path(limits);
  path.Transfer("to over the bin", X_BE);
  const StepOutcome outcome = executor.CheckAndRun(path.path());
  if (outcome.refused()) {
    RefuseHome(outcome.reason,
               "guide the arm to a free place with its pendant, or `jog` it away joint by joint");
  }
  if (!outcome.ok()) {
    const bool asked = outcome.device == WaitOutcome::Status::kInterrupted;
    throw Error(asked ? ErrorKind::kInterrupted : ErrorKind::kDevice, "home: " + outcome.reason);
  }
  return executor.Start().q;
}

}  // namespace tubetwin
