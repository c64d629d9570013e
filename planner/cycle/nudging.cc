#include <algorithm>

#include "models/gripper_spec.h"
#include "planner/cycle/cycle_context.h"
#include "planner/pick/arm_feasibility.h"
#include "planner/pick/nudge.h"
#include "planner/scene_query/voxel_downsample.h"

namespace tubetwin {
namespace {

/// The last part of the way down is slow, so that the arm stops where it meets the tube: at this
/// speed it leans on it with little more than the limit.
constexpr double kTouchSpeed_m_s = 0.002;
constexpr double kSlow_m = 0.007;   ///< Over the lowest place: from 3 mm over the crown.
constexpr double kOver_m = 0.015;   ///< The fingers are lifted this far between strokes.
constexpr double kWindow_s = 0.05;  ///< Averaging out the sensor's noise.

/// Pressing and dragging; returns how far the fingers went along.
double Stroke(CycleContext& c, const NudgeStroke& stroke, const Wrench& unloaded_K,
              NudgeReport& report) {
  const CycleConfig& speeds = c.setup.cycle;
  const PlannerConfig& planner = c.setup.planner;
  const RigidTransform X_BE = c.cell.bin.X_BN * stroke.X_NE;
  RigidTransform over = X_BE;
  over.translation().z() += kOver_m;
  c.executor.Line(over, speeds.approach_speed_m_s, speeds.transfer_acceleration_m_s2);
  RigidTransform near = X_BE;
  near.translation().z() += kSlow_m;
  WaitOutcome press = c.executor.GuardedLine(near, speeds.guarded_speed_m_s, planner.nudge_press_N);
  if (press.status != WaitOutcome::Status::kContact) {
    press = c.executor.GuardedLine(X_BE, kTouchSpeed_m_s, planner.nudge_press_N);
  }
  report.contact = report.contact || press.status == WaitOutcome::Status::kContact;
  const Wrench load_K = c.MeanWrench(kWindow_s) - unloaded_K;
  report.press_N = std::max(report.press_N, load_K.force_N.norm());
  const RigidTransform from = c.executor.X_BE();
  RigidTransform to = from;
  to.translation() += c.cell.bin.X_BN.linear() * stroke.travel_N;
  const WaitOutcome drag =
      c.executor.GuardedLine(to, planner.nudge_speed_m_s, planner.nudge_force_N);
  report.stopped = report.stopped || drag.status == WaitOutcome::Status::kContact;
  const double gone_m = (c.executor.X_BE().translation() - from.translation()).norm();
  RigidTransform up = c.executor.X_BE();
  up.translation().z() = over.translation().z();
  c.executor.Line(up, speeds.approach_speed_m_s, speeds.transfer_acceleration_m_s2);
  return gone_m;
}

/// All strokes. A motion that is rejected ends it where it is.
void Strokes(CycleContext& c, const Nudge& nudge, NudgeReport& report) {
  const CycleConfig& speeds = c.setup.cycle;
  GripperCommand close;
  close.opening_m = 0.0;
  close.speed_m_s = speeds.grip_speed_m_s;
  close.force_N = GripperSpec().min_force_N;
  c.executor.SetOpening(c.MoveFingers(close).opening_m);
  RigidTransform above = c.cell.bin.X_BN * nudge.strokes.front().X_NE;
  above.translation().z() += speeds.approach_m;
  c.executor.Transfer(above, speeds.transfer_speed_m_s, speeds.transfer_acceleration_m_s2);
  const Wrench unloaded_K = c.MeanWrench(speeds.weigh_window_s);
  for (const NudgeStroke& stroke : nudge.strokes) {
    report.travel_m += Stroke(c, stroke, unloaded_K, report);
    if (report.stopped) return;
  }
}

void Push(CycleContext& c, const Nudge& nudge) {
  const CycleContext::Timed timed(c, &AttemptReport::SimTime::move);
  c.observer.OnStep("nudging tube " + std::to_string(nudge.tube) + " by " +
                    std::to_string(static_cast<int>(1e3 * nudge.travel_m + 0.5)) + " mm");
  NudgeReport report;
  report.tube = nudge.tube;
  report.direction_N = nudge.direction_N;
  try {
    Strokes(c, nudge, report);
  } catch (const MoveFailure& failure) {
    if (failure.kind != MoveFailure::Kind::kRejected) throw;
    report.rejected = failure.what();
  }
  RigidTransform up = c.executor.X_BE();
  up.translation().z() += c.setup.cycle.approach_m;
  c.executor.Line(up, c.setup.cycle.approach_speed_m_s, c.setup.cycle.transfer_acceleration_m_s2);
  c.report.nudges.push_back(report);
}

}  // namespace

std::optional<int> TryNudge(CycleContext& c, const TubeScene& scene,
                            const std::vector<OrganizedCloud>& views) {
  if (static_cast<int>(c.report.nudges.size()) >= c.setup.planner.nudges) return std::nullopt;
  const double began = ComputeClock_s();
  const Bin& bin = c.cell.bin;
  const NudgeResult result =
      PlanNudge(scene, ThinPoints(views, bin), bin, c.setup.planner,
                ArmFeasibility(c.executor.planner(), c.cell.layout, bin, c.setup.part.radius_m),
                ArmNudgeFeasibility(c.executor.planner(), c.cell.layout, bin));
  c.report.compute_s.planning += ComputeClock_s() - began;
  c.report.rejections.insert(c.report.rejections.end(), result.rejections.begin(),
                             result.rejections.end());
  if (!result.nudge) return std::nullopt;
  Push(c, *result.nudge);
  return result.nudge->tube;
}

}  // namespace tubetwin
