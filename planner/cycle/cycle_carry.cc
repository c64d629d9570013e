#include <algorithm>
#include <deque>

#include "planner/cycle/cycle_context.h"
#include "planner/grasp/placement.h"

namespace tubetwin {
namespace {

constexpr double kRetreat_m = 0.15;
constexpr double kReleaseExtra_m = 0.030;  ///< Opening beyond the tube when letting go.
constexpr double kRestAfterTilt_s = 1.0;
constexpr double kWeakTorque_Nm = 0.02;  ///< Below, the torque axis is arbitrary.
constexpr double kYawStep_deg = 20.0;    ///< Turns of the tool at the tilt station that are tried.
constexpr int kMostYawSteps = 8;         ///< In either sense.
constexpr double kPlaceGap_m = 0.003;    ///< E stops this far above touching the tray.
constexpr double kAbovePlace_m = 0.20;   ///< Last weighing: above all that lies on the tray.
constexpr double kGuardedPlace_m = 0.035;  ///< From here on what lies on the tray may be met.
constexpr double kWindow_s = 0.1;          ///< Averaging out what the sensor's noise and servos do.
constexpr int kSteadyWindows = 3;
constexpr double kSteadyShare = 0.15;  ///< Of the weighing's tolerance.
constexpr double kTruthDelay_s = 2.0;  ///< A hose that lay on others rocks before it rests.

void Open(CycleContext& c) {
  GripperCommand open;
  open.opening_m = std::min(GripperSpec().stroke_m, 2 * c.setup.part.radius_m + kReleaseExtra_m);
  open.speed_m_s = c.setup.cycle.grip_speed_m_s;
  open.force_N = c.setup.cycle.grip_force_N;
  c.cell.carrying = false;
  c.MoveFingers(open);
  c.executor.SetOpening(open.opening_m);
  c.cell.arm.SetPayload(0.0, Vector3::Zero());
  c.LetGo();
}

void Retreat(CycleContext& c) {
  RigidTransform up = c.executor.X_BE();
  up.translation().z() += kRetreat_m;
  c.executor.Line(up, c.setup.cycle.approach_speed_m_s, c.setup.cycle.transfer_acceleration_m_s2);
}

/// Level -> tilted -> level about an axis through E, then how many hang.
HeldOutcome TiltAndWeigh(CycleContext& c, const Vector3& axis_B, double angle_deg) {
  {
    const CycleContext::Timed timed(c, &AttemptReport::SimTime::move);
    const double speed = Radians(c.setup.resolution.speed_deg_s);
    const Vector3 rotation_B = Radians(angle_deg) * axis_B;
    c.executor.Tilt(rotation_B, speed);
    Wait(c.cell, kRestAfterTilt_s);
    c.executor.Tilt(-rotation_B, speed);
  }
  return c.Weigh(c.setup.cycle.settle_s).outcome;
}

HeldOutcome TiltSequence(CycleContext& c, const Vector3& axis_B,
                         const std::vector<double>& angles_deg) {
  HeldOutcome held = HeldOutcome::kSeveral;
  for (const double angle_deg : angles_deg) {
    c.observer.OnStep("several held: tilting by " + std::to_string(static_cast<int>(angle_deg)) +
                      " degrees");
    held = TiltAndWeigh(c, axis_B, angle_deg);
    if (held != HeldOutcome::kSeveral) break;
  }
  return held;
}

/// Down until something is felt, a short rest, up again: extras that lie on the pile let go.
HeldOutcome LowerAndRelift(CycleContext& c) {
  const RigidTransform top = c.executor.X_BE();
  {
    const CycleContext::Timed timed(c, &AttemptReport::SimTime::move);
    RigidTransform down = top;
    down.translation().z() = c.cell.bin.X_BN.translation().z() + 0.10;
    c.executor.Line(down, c.setup.planner.lift_speed_m_s, c.setup.cycle.transfer_acceleration_m_s2);
    Wait(c.cell, 0.3);
    c.executor.Line(top, c.setup.planner.lift_speed_m_s, c.setup.cycle.transfer_acceleration_m_s2);
  }
  return c.Weigh(c.setup.cycle.settle_s).outcome;
}

/// Where the tilts are made: at the station of the layout, turned about the vertical as little as
/// keeps the scanner off the forearm in all of them.
RigidTransform TiltStation(const CycleContext& c, const Vector3& axis_E,
                           const std::vector<double>& angles_deg) {
  const Matrix3 R_BE = c.executor.X_BE().linear();
  const RigidTransform straight = MakeTransform(R_BE, c.cell.layout.p_BTilt);
  for (int k = 0; k < 2 * kMostYawSteps; ++k) {
    const double yaw_deg = kYawStep_deg * ((k + 1) / 2) * (k % 2 == 0 ? 1 : -1);
    const RigidTransform turned =
        MakeTransform(RotZ(Radians(yaw_deg)) * R_BE, straight.translation());
    std::vector<Vector3> rotations_B;
    for (const double angle_deg : angles_deg) {
      rotations_B.push_back(Radians(angle_deg) * (turned.linear() * axis_E));
    }
    if (c.executor.TiltsFrom(turned, rotations_B)) return turned;
  }
  return straight;
}

/// Transfer to over the slot with an eye on the gripper, and the last weighing. Whether the tube is
/// still there.
HeldOutcome Carry(CycleContext& c, const RigidTransform& X_BE, int slot) {
  const CycleConfig& speeds = c.setup.cycle;
  c.cell.carrying = true;
  try {
    const CycleContext::Timed timed(c, &AttemptReport::SimTime::move);
    c.observer.OnStep("carrying to slot " + std::to_string(slot + 1));
    c.executor.Transfer(X_BE, speeds.transfer_speed_m_s, speeds.transfer_acceleration_m_s2);
  } catch (const MoveFailure& failure) {
    if (failure.status != WaitOutcome::Status::kObjectLost) throw;
    c.cell.carrying = false;
    c.executor.Resync();
    c.report.reason = failure.what();
    if (c.Weigh(0.3).outcome == HeldOutcome::kNone) return HeldOutcome::kNone;
    // Opening on the word of one of the two could drop a tube.
    throw MoveFailure(MoveFailure::Kind::kFault,
                      std::string(failure.what()) + ", but the wrist still weighs one");
  }
  const HeldOutcome held = c.Weigh(0.3).outcome;
  if (held == HeldOutcome::kNone) c.report.reason = "nothing hangs in the fingers over the tray";
  return held;
}

}  // namespace

void WaitForSteadyLoad(CycleContext& c, double most_s) {
  const double band_N =
      kSteadyShare * c.setup.cycle.tolerance_share * c.setup.part.mass_kg * kGravity;
  const int windows = std::max(kSteadyWindows, static_cast<int>(c.held.period_s / kWindow_s) + 2);
  const TimeNs end = c.cell.clock.Now() + FromSeconds(most_s);
  std::deque<double> means_N;
  while (c.cell.clock.Now() + FromSeconds(kWindow_s) <= end) {
    means_N.push_back(c.MeanWrench(kWindow_s).force_N.z());
    if (static_cast<int>(means_N.size()) > windows) means_N.pop_front();
    const auto [least, most] = std::minmax_element(means_N.begin(), means_N.end());
    if (static_cast<int>(means_N.size()) == windows && *most - *least < band_N) return;
  }
  c.cell.clock.AdvanceTo(end);
}

HeldOutcome Resolve(CycleContext& c, const Vector3& load_torque_K) {
  // The load torque's horizontal axis: turning about it in the positive sense lets the heavy side
  // go down.
  const Matrix3 R_BE = c.executor.X_BE().linear();
  Vector3 axis_B = R_BE * load_torque_K;
  axis_B.z() = 0.0;
  axis_B = axis_B.norm() > kWeakTorque_Nm ? axis_B.normalized() : Vector3(Vector3::UnitX());
  const double angle = c.setup.resolution.angle_deg;
  std::vector<double> angles_deg;
  const ResolutionStrategy strategy = ResolutionStrategyFromName(c.setup.resolution.strategy);
  switch (strategy) {
    case ResolutionStrategy::kNone:
      return HeldOutcome::kSeveral;
    case ResolutionStrategy::kPlus45:
      angles_deg = {angle};
      break;
    case ResolutionStrategy::kPlus45Minus45:
      angles_deg = {angle, -angle};
      break;
    case ResolutionStrategy::kPerpendicular:
      axis_B = Vector3(-axis_B.y(), axis_B.x(), 0.0);
      angles_deg = {angle, -angle};
      break;
    case ResolutionStrategy::kPutback:
      break;
  }
  const Vector3 axis_E = R_BE.transpose() * axis_B;
  const RigidTransform station = TiltStation(c, axis_E, angles_deg);
  {
    const CycleContext::Timed timed(c, &AttemptReport::SimTime::move);
    c.executor.Line(station, c.setup.planner.lift_speed_m_s,
                    c.setup.cycle.transfer_acceleration_m_s2);
  }
  if (strategy == ResolutionStrategy::kPutback) {
    c.observer.OnStep("several held: lowering and lifting again");
    return LowerAndRelift(c);
  }
  return TiltSequence(c, station.linear() * axis_E, angles_deg);
}

void PutBack(CycleContext& c) {
  const CycleContext::Timed timed(c, &AttemptReport::SimTime::move);
  c.observer.OnStep("putting back");
  RigidTransform down = c.executor.X_BE();
  const double floor_B = c.cell.bin.X_BN.translation().z();
  down.translation().z() = floor_B + c.cell.bin.wall_m() + 0.10;
  if (down.translation().z() < c.executor.X_BE().translation().z()) {
    c.executor.Line(down, c.setup.planner.lift_speed_m_s, c.setup.cycle.transfer_acceleration_m_s2);
  }
  down.translation().z() = floor_B + 0.05;
  if (down.translation().z() < c.executor.X_BE().translation().z()) {
    // Hanging tubes touch first: what is felt as the load going down ends the descent.
    c.executor.GuardedLine(down, 0.05, c.setup.cycle.guard_force_N);
  }
  Open(c);
  Wait(c.cell, 0.5);
  Retreat(c);
}

AttemptOutcome Place(CycleContext& c, const Polyline& line_E) {
  const CycleConfig& speeds = c.setup.cycle;
  const std::optional<PlacementPose> found =
      PlanPlacement(c.cell.layout, Sagged(line_E, c.setup.part), c.setup.part.radius_m, c.placed_T,
                    ToolYaw(c.executor.X_BE().linear()), [&](RigidTransform X_BE) {
                      if (!c.executor.Reaches(X_BE)) return false;
                      X_BE.translation().z() += kAbovePlace_m;
                      return c.executor.Reaches(X_BE);
                    });
  if (!found) throw MoveFailure(MoveFailure::Kind::kRejected, "no slot of the tray is in reach");
  const PlacementPose& pose = *found;
  RigidTransform X_BE = pose.X_BE;
  X_BE.translation().z() += kAbovePlace_m;
  if (Carry(c, X_BE, pose.slot) == HeldOutcome::kNone) return AttemptOutcome::kDropped;
  const CycleContext::Timed timed(c, &AttemptReport::SimTime::move);
  c.observer.OnStep("laying down");
  X_BE.translation().z() = pose.X_BE.translation().z() + kGuardedPlace_m;
  c.executor.Line(X_BE, speeds.approach_speed_m_s, speeds.transfer_acceleration_m_s2);
  // Another tube may lie where this one comes to rest: what is felt ends the descent.
  X_BE.translation().z() = pose.X_BE.translation().z() - pose.raised_m + kPlaceGap_m;
  c.executor.GuardedLine(X_BE, 2.0 * speeds.guarded_speed_m_s, 0.5 * speeds.guard_force_N);
  Open(c);
  const TimeNs released = c.cell.clock.Now();
  Retreat(c);
  const double since_s = Seconds(c.cell.clock.Now() - released);
  if (since_s < kTruthDelay_s) Wait(c.cell, kTruthDelay_s - since_s);
  c.placed_T.push_back(pose.line_T);
  c.report.slot_centre_T = pose.slot_centre_T;
  return AttemptOutcome::kPlaced;
}

}  // namespace tubetwin
