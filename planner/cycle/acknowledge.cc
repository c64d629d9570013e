#include "planner/cycle/cycle_context.h"

namespace tubetwin {
namespace {

constexpr double kRetreatSpeed_m_s = 0.1, kRetreatAcceleration_m_s2 = 0.5;
constexpr double kNothingOpening_m = 0.004;  ///< Closed fingers: nothing between them.

/// Faults that a person at the cell can look into. After a lost link nobody knows where the arm is.
bool MayBeAcknowledged(WaitOutcome::Status status) {
  return status == WaitOutcome::Status::kProtectiveStop ||
         status == WaitOutcome::Status::kEmergencyStop || status == WaitOutcome::Status::kFault;
}

void RetreatAndPutBack(CycleContext& c) {
  c.executor.Resync();
  const double carry_B = c.cell.bin.X_BN.translation().z() + c.cell.layout.carry_height_m;
  RigidTransform up = c.executor.X_BE();
  if (up.translation().z() < carry_B) {
    up.translation().z() = carry_B;
    c.executor.Line(up, kRetreatSpeed_m_s, kRetreatAcceleration_m_s2);
  }
  const GripperState fingers = c.cell.gripper.State();
  c.executor.SetOpening(fingers.opening_m);
  const bool closed = fingers.object == GripperObject::kContactClosing;
  if (!closed || fingers.opening_m < kNothingOpening_m) return;
  RigidTransform over = c.executor.X_BE();
  over.translation().head<2>() = c.cell.bin.X_BN.translation().head<2>();
  c.executor.Transfer(over, kRetreatSpeed_m_s, kRetreatAcceleration_m_s2);
  PutBack(c);
}

}  // namespace

Acknowledgement GoOnAfterStop(CycleContext& c, const MoveFailure& failure) {
  c.cell.carrying = false;
  if (!c.setup.acknowledge || !MayBeAcknowledged(failure.status)) return Acknowledgement::kEnd;
  if (c.setup.acknowledge(failure.what()) != Acknowledgement::kGoOn) return Acknowledgement::kEnd;
  c.observer.OnStep("going on after a stop");
  if (RecoverArm(c.cell).status != WaitOutcome::Status::kDone) return Acknowledgement::kEnd;
  try {
    RetreatAndPutBack(c);
  } catch (const MoveFailure&) {
    return Acknowledgement::kEnd;
  }
  return Acknowledgement::kGoOn;
}

}  // namespace tubetwin
