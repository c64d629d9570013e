#include <algorithm>
#include <cmath>

#include "planner/cycle/round_steps.h"
#include "planner/grasp/placement.h"

namespace tubetwin {
namespace {

constexpr double kPlaceGap_m = 0.003;      ///< E stops this far above touching the tray.
constexpr double kAbovePlace_m = 0.20;     ///< Last weighing: above all that lies on the tray.
constexpr double kGuardedPlace_m = 0.035;  ///< From here on what lies on the tray may be met.
constexpr double kWeighAbove_s = 0.3;
constexpr double kOffSlot_m = 0.02;  ///< The arm may be so far from where it was planned to be.

constexpr int kMaxSlotsTried = 6;

enum PlaceStage { kCarryStage, kLowerStage, kReleaseStage, kRetreatStage };

RigidTransform Over(RigidTransform X_BE, double height_m) {
  X_BE.translation().z() += height_m;
  return X_BE;
}

/// Carrying to over the slot, down onto the tray, letting go and up.
PickPath MakePlacePath(const CycleContext& c, const PlacementPose& pose) {
  const CycleConfig& config = c.setup.cycle;
  PathBuilder path = c.Path();
  path.Transfer("carrying", Over(pose.X_BE, kAbovePlace_m));
  path.NextStage();
  path.Line("laying down", To(Over(pose.X_BE, kGuardedPlace_m)));
  // Another tube may lie where this one comes to rest: what is felt ends the descent.
  path.GuardedLine("onto the tray", To(Over(pose.X_BE, kPlaceGap_m - pose.raised_m)),
                   2.0 * config.guarded_speed_m_s, 0.5 * config.guard_force_N);
  path.NextStage();
  path.Open("letting go", c.ReleaseOpening());
  path.NextStage();
  // Nothing swings any more.
  path.Add("up", NearGrasp(config.approach_speed_m_s, config.transfer_acceleration_m_s2),
           Follow{{By(Vector3(0, 0, kRetreat_m))}});
  return path.path();
}

struct Placement {
  PlacementPose pose;
  CheckedPath path;
};

/// The best slot with a path that the arm can run, or why there is none.
std::variant<Placement, StepOutcome> PlanPlace(const CycleContext& c, const Polyline& line_E) {
  const MotionPlanner& planner = c.executor.planner();
  const GripperSpec& gripper = c.cell.model.gripper;
  const double radius_m = c.setup.part.radius_m;
  const double min_height_E_m =
      MinPadHeight(gripper) - PadRetreat(gripper, 2.0 * radius_m) - kPlaceGap_m;
  const double q6_rad = c.executor.Start().q[5];
  std::vector<RigidTransform> refused;
  std::string reason = "no slot of the tray is in reach";
  while (static_cast<int>(refused.size()) < kMaxSlotsTried) {
    const auto reachable = [&](const RigidTransform& X_BE) {
      const bool tried = std::any_of(refused.begin(), refused.end(),
                                     [&](const auto& other) { return X_BE.isApprox(other, 1e-9); });
      return !tried && planner.Reach(X_BE, q6_rad) &&
             planner.Reach(Over(X_BE, kAbovePlace_m), q6_rad);
    };
    const std::optional<PlacementPose> pose =
        PlanPlacement(c.cell.model.layout, Sagged(line_E, c.setup.part), radius_m, min_height_E_m,
                      c.placed_T, ToolYaw(c.executor.X_BE().linear()), reachable);
    if (!pose) break;
    PathCheck check = c.executor.Check(MakePlacePath(c, *pose));
    const MotionRejection* refusal = RefusalOf(check);
    if (refusal == nullptr) return Placement{*pose, std::get<CheckedPath>(std::move(check))};
    reason = refusal->reason;
    refused.push_back(pose->X_BE);
  }
  return StepOutcome::Refused(reason);
}

/// To over the slot with an eye on the gripper, and the last weighing. Whether the tube is still
/// there.
HeldStep Carry(CycleContext& c, const Placement& placement) {
  const CycleContext::During carrying(c, &AttemptReport::Phases::carry);
  c.observer.OnStep("carrying to slot " + std::to_string(placement.pose.slot + 1));
  c.cell.carried_opening_m = c.cell.gripper.State().opening_m;
  const StepOutcome carried = c.Run(placement.path, kCarryStage);
  if (carried.device == WaitOutcome::Status::kObjectLost) {
    c.cell.carried_opening_m.reset();
    c.executor.Resync();
    c.report.reason = carried.reason;
    const Weighing weighing = WeighHeld(c, kWeighAbove_s);
    return {weighing.step, weighing.detection.outcome};
  }
  if (!carried.ok()) return {carried, HeldOutcome::kOne};
  const Detection* const before = c.report.detection ? &*c.report.detection : nullptr;
  const Weighing weighing = WeighHeld(c, kWeighAbove_s, before);
  if (!weighing.step.ok()) return {weighing.step, HeldOutcome::kOne};
  if (weighing.detection.outcome == HeldOutcome::kNone) {
    c.report.reason = "nothing hangs in the fingers over the tray";
  }
  return {{}, weighing.detection.outcome};
}

/// Whether the fingers may let go here: the arm says that it stands low over the slot, and the
/// gripper that it still holds the tube. Trouble when either says something else.
StepOutcome MayLetGo(const CycleContext& c, const PlacementPose& pose) {
  const RigidTransform X_BE = c.executor.planner().PoseOfE(c.cell.arm.State().q);
  const Vector3 off_B = X_BE.translation() - pose.X_BE.translation();
  const auto trouble = [](const std::string& reason) {
    return StepOutcome::Trouble({WaitOutcome::Status::kDeviated, reason, 0.0}, "letting go");
  };
  // Not so for what is no number.
  if (!(off_B.head<2>().norm() < kOffSlot_m && off_B.z() < kGuardedPlace_m + kOffSlot_m)) {
    return trouble("the arm stands " + std::to_string(std::lround(1e3 * off_B.norm())) +
                   " mm from where the tube is to be laid");
  }
  const GripperState fingers = c.cell.gripper.State();
  if (fingers.object == GripperObject::kAtPosition) return trouble("the gripper holds nothing");
  return {};
}

}  // namespace

PlaceStep Place(CycleContext& c, const Polyline& line_E) {
  const auto planned = PlanPlace(c, line_E);
  if (const auto* refused = std::get_if<StepOutcome>(&planned)) return {*refused};
  const Placement& placement = std::get<Placement>(planned);
  const HeldStep carried = Carry(c, placement);
  if (!carried.step.ok()) return {carried.step};
  if (carried.held == HeldOutcome::kNone) {
    c.cell.carried_opening_m.reset();
    return {{}, AttemptOutcome::kDropped};
  }
  const CycleContext::During placing(c, &AttemptReport::Phases::place);
  c.observer.OnStep("laying down");
  if (StepOutcome lowered = c.Run(placement.path, kLowerStage); !lowered.ok()) return {lowered};
  c.cell.carried_opening_m.reset();
  if (StepOutcome may = MayLetGo(c, placement.pose); !may.ok()) return {may};
  StepOutcome released = c.Run(placement.path, kReleaseStage);
  if (!released.ok()) return {released};
  c.Released();
  c.placed_T.push_back(placement.pose.line_T);
  c.report.slot_centre_T = placement.pose.slot_centre_T;
  const CycleContext::During going_back(c, &AttemptReport::Phases::back);
  StepOutcome up = c.Run(placement.path, kRetreatStage);
  // Every way to the next place begins by going up: a refusal costs nothing.
  if (!up.ok() && !up.refused()) return {up};
  return {{}, AttemptOutcome::kPlaced};
}

}  // namespace tubetwin
