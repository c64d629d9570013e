#include "hw_bridge/cell/cell.h"

#include <cmath>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "hw_bridge/base/error.h"

namespace tubetwin {
namespace {

constexpr double kScanTimeout_s = 30.0;
constexpr double kGripperTimeout_s = 5.0;
constexpr int kMeanSamples = 5;     ///< 5 ms at the control period.
constexpr int kContactSamples = 3;  ///< In a row over the limit.
/// Below this speed of E the direction of motion is taken over from the sample before.
constexpr double kLeastSpeed_m_s = 1e-4;

/// Mean of the newest kMeanSamples forces.
class ForceMean {
 public:
  void Add(const Vector3& force_N) {
    window_.push_back(force_N);
    sum_N_ += force_N;
    if (window_.size() > kMeanSamples) {
      sum_N_ -= window_.front();
      window_.pop_front();
    }
  }
  Vector3 mean_N() const { return sum_N_ / static_cast<double>(window_.size()); }

 private:
  std::deque<Vector3> window_;
  Vector3 sum_N_ = Vector3::Zero();
};

/// The state at the end of a motion as an outcome; `stopped` is what a stop short of the end means.
WaitOutcome OutcomeOf(const ArmState& state, WaitOutcome::Status stopped) {
  WaitOutcome outcome;
  outcome.progress_s = state.progress_s;
  if (state.mode == ArmMode::kReady && state.done) return outcome;
  if (state.mode == ArmMode::kReady) {
    outcome.status = stopped;
    outcome.reason = "stopped at " + std::to_string(state.progress_s) + " s of " +
                     std::to_string(state.planned_s) + " s";
    return outcome;
  }
  outcome.status = WaitOutcome::Status::kFault;
  outcome.reason = std::string("arm is in ") + ToString(state.mode) +
                   (state.fault.empty() ? "" : ": " + state.fault);
  return outcome;
}

/// Waits until the arm no longer moves, calling `each_sample` (may be empty) after every control
/// period in which it still does.
WaitOutcome WaitWhileMoving(Cell& cell, const std::function<void(const ArmState&)>& each_sample) {
  TimeNs waited{0};
  for (;;) {
    const ArmState state = cell.arm.State();
    const bool holding = state.mode == ArmMode::kHolding;
    if (state.mode != ArmMode::kMoving && !holding) {
      return OutcomeOf(state, WaitOutcome::Status::kStopped);
    }
    if (Seconds(waited) > 1.5 * state.planned_s + 2.0) {
      return {WaitOutcome::Status::kTimedOut,
              "still " + std::string(ToString(state.mode)) + " after " +
                  std::to_string(Seconds(waited)) + " s, planned " +
                  std::to_string(state.planned_s) + " s",
              state.progress_s};
    }
    if (each_sample) each_sample(state);
    cell.clock.AdvanceTo(cell.clock.Now() + kControlPeriod);
    // A controller that holds the arm back on purpose is not late.
    if (!holding) waited += kControlPeriod;
  }
}

/// Unit direction of E's motion in K at `time_s` of the trajectory; `previous` where it is at rest.
Vector3 MotionDirection_K(const Cell& cell, const JointTrajectory& trajectory, double time_s,
                          const Vector3& previous) {
  const TrajectoryPoint point = Sample(trajectory, time_s);
  const JacobianMatrix J = Jacobian(cell.arm_model, point.q, cell.layout.X_FE);
  const Vector3 v_B = (J * point.qd).head<3>();
  if (v_B.norm() < kLeastSpeed_m_s) return previous;
  const Matrix3 R_BK = FlangePose(cell.arm_model, point.q).linear() * cell.layout.X_FK.linear();
  return R_BK.transpose() * v_B.normalized();
}

}  // namespace

WaitOutcome WaitForArm(Cell& cell) { return WaitWhileMoving(cell, {}); }

WaitOutcome RunTrajectory(Cell& cell, const CheckedTrajectory& trajectory) {
  const CommandResult started = cell.arm.Start(trajectory);
  if (!started.accepted()) return {WaitOutcome::Status::kFault, started.reason, 0.0};
  return WaitForArm(cell);
}

WaitOutcome RunGuarded(Cell& cell, const CheckedTrajectory& trajectory, double force_limit_N) {
  TT_CHECK(force_limit_N > 0.0);
  const Vector3 bias_N = AverageWrench(cell, kMeanSamples * Seconds(kControlPeriod)).force_N;
  const CommandResult started = cell.arm.Start(trajectory);
  if (!started.accepted()) return {WaitOutcome::Status::kFault, started.reason, 0.0};
  ForceMean mean;
  Vector3 direction_K = Vector3::Zero();
  int over = 0;
  std::optional<double> contact_N;
  WaitOutcome outcome = WaitWhileMoving(cell, [&](const ArmState& state) {
    mean.Add(cell.wrist.Read().wrench_K.force_N - bias_N);
    direction_K = MotionDirection_K(cell, trajectory.trajectory(), state.progress_s, direction_K);
    const double along_N = mean.mean_N().dot(direction_K);
    over = std::abs(along_N) > force_limit_N ? over + 1 : 0;
    if (over >= kContactSamples && !contact_N) {
      contact_N = along_N;
      cell.arm.Stop(StopKind::kOnPath);
    }
  });
  const bool ended = outcome.status == WaitOutcome::Status::kDone ||
                     outcome.status == WaitOutcome::Status::kStopped;
  if (contact_N && ended) {
    outcome.status = WaitOutcome::Status::kContact;
    outcome.reason = "force along the motion " + std::to_string(*contact_N) + " N, limit " +
                     std::to_string(force_limit_N) + " N";
  }
  return outcome;
}

GripperState MoveGripper(Cell& cell, const GripperCommand& command) {
  cell.gripper.Command(command);
  const TimeNs end = cell.clock.Now() + FromSeconds(kGripperTimeout_s);
  GripperState state = cell.gripper.State();
  while (state.object == GripperObject::kMoving && cell.clock.Now() < end) {
    cell.clock.AdvanceTo(cell.clock.Now() + kControlPeriod);
    state = cell.gripper.State();
  }
  return state;
}

Wrench AverageWrench(Cell& cell, double duration_s) {
  TT_CHECK(duration_s >= Seconds(kControlPeriod));
  const TimeNs end = cell.clock.Now() + FromSeconds(duration_s);
  Wrench sum;
  int count = 0;
  while (cell.clock.Now() < end) {
    cell.clock.AdvanceTo(cell.clock.Now() + kControlPeriod);
    sum = sum + cell.wrist.Read().wrench_K;
    ++count;
  }
  return sum * (1.0 / count);
}

void Wait(Cell& cell, double duration_s) {
  cell.clock.AdvanceTo(cell.clock.Now() + FromSeconds(duration_s));
}

OrganizedCloud Scan(Cell& cell) {
  const CommandResult triggered = cell.scanner.Trigger();
  if (!triggered.accepted()) {
    throw Error(ErrorKind::kDevice, "scanner: scan refused: " + triggered.reason);
  }
  const TimeNs end = cell.clock.Now() + FromSeconds(kScanTimeout_s);
  while (cell.scanner.Status() == ScanStatus::kBusy) {
    if (cell.clock.Now() >= end) {
      throw Error(ErrorKind::kDevice, "scanner: no cloud after 30 s");
    }
    cell.clock.AdvanceTo(cell.clock.Now() + kControlPeriod);
  }
  if (cell.scanner.Status() != ScanStatus::kReady) {
    throw Error(ErrorKind::kDevice, "scanner: scan failed: " + cell.scanner.FailureReason());
  }
  return cell.scanner.Take();
}

}  // namespace tubetwin
