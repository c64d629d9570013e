#include "hw_bridge/cell/cell.h"

#include <cmath>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "hw_bridge/cell/watch.h"
#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr double kScanTimeout_s = 30.0;
constexpr double kGripperTimeout_s = 5.0;
constexpr double kStopTimeout_s = 2.0;      ///< For a stopped arm to come to rest.
constexpr double kRecoverTimeout_s = 12.0;  ///< Servos on, job started.
constexpr int kMeanSamples = 5;             ///< 5 ms at the control period.
constexpr int kContactSamples = 3;          ///< In a row over the limit.
/// Below this speed of E the direction of motion is taken over from the sample before.
constexpr double kMinSpeed_m_s = 1e-4;

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

WaitOutcome::Status StatusOf(ArmMode mode) {
  switch (mode) {
    case ArmMode::kDisconnected:
      return WaitOutcome::Status::kLinkLost;
    case ArmMode::kProtectiveStop:
      return WaitOutcome::Status::kProtectiveStop;
    case ArmMode::kEmergencyStop:
      return WaitOutcome::Status::kEmergencyStop;
    default:
      return WaitOutcome::Status::kFault;
  }
}

/// The state at the end of a motion as an outcome; `stopped` is what a stop short of the end means.
WaitOutcome OutcomeOf(const ArmState& state, WaitOutcome::Status stopped) {
  WaitOutcome outcome;
  outcome.progress_s = state.progress_s;
  if (state.mode == ArmMode::kReady && state.done) return outcome;
  const std::string told = state.fault.empty() ? "" : ": " + state.fault;
  if (state.mode == ArmMode::kReady) {
    outcome.status = stopped;
    outcome.reason = "stopped at " + std::to_string(state.progress_s) + " s of " +
                     std::to_string(state.planned_s) + " s" + told;
    return outcome;
  }
  outcome.status = StatusOf(state.mode);
  outcome.reason = std::string("arm is in ") + ToString(state.mode) + told;
  return outcome;
}

bool Moves(const ArmState& state) {
  return state.mode == ArmMode::kMoving || state.mode == ArmMode::kHolding;
}

/// Lets one control period pass. After a stall of the host, messages of the devices wait to be read
/// by the drivers' threads. These get time to do so, or a device would be called silent that was
/// not.
void PassPeriod(Cell& cell) {
  constexpr TimeNs kStall = std::chrono::milliseconds(20), kCatchUp = std::chrono::milliseconds(30);
  const TimeNs due = cell.clock.Now() + kControlPeriod;
  cell.clock.AdvanceTo(due);
  const TimeNs now = cell.clock.Now();
  if (now - due > kStall) cell.clock.AdvanceTo(now + kCatchUp);
}

/// Ends a motion for `trouble` and lets the arm come to rest, if it still says where it is.
WaitOutcome EndMotion(Cell& cell, WaitOutcome trouble) {
  const bool lost = trouble.status == WaitOutcome::Status::kLinkLost;
  const bool late = trouble.status == WaitOutcome::Status::kTimedOut;
  cell.arm.Stop(lost || late ? StopKind::kFast : StopKind::kOnPath);
  const TimeNs end = cell.clock.Now() + FromSeconds(kStopTimeout_s);
  while (!lost && Moves(cell.arm.State()) && cell.clock.Now() < end) {
    PassPeriod(cell);
  }
  return trouble;
}

std::optional<WaitOutcome> Late(const Cell& cell, const ArmState& state, TimeNs waited,
                                TimeNs held) {
  const bool late = Seconds(waited) > 1.5 * state.planned_s + 2.0;
  if (!late && Seconds(held) <= cell.safety.hold_s) return std::nullopt;
  return WaitOutcome{WaitOutcome::Status::kTimedOut,
                     "still " + std::string(ToString(state.mode)) + " after " +
                         std::to_string(Seconds(waited + held)) + " s, planned " +
                         std::to_string(state.planned_s) + " s",
                     state.progress_s};
}

/// Waits until the arm no longer moves, calling `each_sample` (may be empty) after every control
/// period in which it still does; what that returns ends the motion, as does what is watched.
WaitOutcome WaitWhileMoving(
    Cell& cell, const JointTrajectory* path,
    const std::function<std::optional<WaitOutcome>(const ArmState&)>& each_sample) {
  TimeNs waited{0}, held{0};
  for (;;) {
    const ArmState state = cell.arm.State();
    if (!Moves(state)) {
      if (state.mode == ArmMode::kDisconnected) cell.arm.Stop(StopKind::kFast);
      return OutcomeOf(state, WaitOutcome::Status::kStopped);
    }
    std::optional<WaitOutcome> trouble = Late(cell, state, waited, held);
    if (!trouble) trouble = MotionTrouble(cell, state, path);
    if (!trouble) trouble = StopAtOnce(cell, state.progress_s);
    if (!trouble && each_sample) trouble = each_sample(state);
    if (trouble) return EndMotion(cell, *trouble);
    const TimeNs before = cell.clock.Now();
    PassPeriod(cell);
    // A controller that holds the arm back on purpose is not late.
    (state.mode == ArmMode::kHolding ? held : waited) += cell.clock.Now() - before;
  }
}

/// Starts what may be started; the reason why not otherwise.
std::optional<WaitOutcome> StartTrajectory(Cell& cell, const CheckedTrajectory& trajectory) {
  if (auto refused = RefuseStart(cell, trajectory)) return refused;
  const CommandResult started = cell.arm.Start(trajectory);
  if (started.accepted()) return std::nullopt;
  const ArmMode mode = cell.arm.State().mode;
  const bool ready = mode == ArmMode::kReady || mode == ArmMode::kMoving;
  return WaitOutcome{ready ? WaitOutcome::Status::kRejected : StatusOf(mode), started.reason, 0.0};
}

/// Unit direction of E's motion in K at `time_s` of the trajectory; `previous` where it is at rest.
Vector3 MotionDirection_K(const Cell& cell, const JointTrajectory& trajectory, double time_s,
                          const Vector3& previous) {
  const TrajectoryPoint point = Sample(trajectory, time_s);
  const JacobianMatrix J = Jacobian(cell.model.arm, point.q, cell.model.layout.X_FE);
  const Vector3 v_B = (J * point.qd).head<3>();
  if (v_B.norm() < kMinSpeed_m_s) return previous;
  const Matrix3 R_BK =
      FlangePose(cell.model.arm, point.q).linear() * cell.model.layout.X_FK.linear();
  return R_BK.transpose() * v_B.normalized();
}

/// What stands between a command and the state in which the fingers came to rest after it, from
/// `before_m` on: a gripper that met something on a way that it was not told to go.
std::optional<WaitOutcome> WrongWay(const GripperCommand& command, double before_m,
                                    const GripperState& state) {
  constexpr double kSamePlace_m = 0.002;
  const double way_m = command.opening_m - before_m;
  const bool wrong = way_m > kSamePlace_m
                         ? state.object == GripperObject::kContactClosing
                         : way_m < -kSamePlace_m && state.object == GripperObject::kContactOpening;
  if (!wrong) return std::nullopt;
  return WaitOutcome{WaitOutcome::Status::kGripperFault,
                     std::string("gripper: was told to ") + (way_m > 0.0 ? "open" : "close") +
                         " and says that it met something while it " +
                         (way_m > 0.0 ? "closed" : "opened"),
                     0.0};
}

}  // namespace

const char* ToString(WaitOutcome::Status status) {
  switch (status) {
    case WaitOutcome::Status::kDone:
      return "done";
    case WaitOutcome::Status::kContact:
      return "contact";
    case WaitOutcome::Status::kStopped:
      return "stopped";
    case WaitOutcome::Status::kTimedOut:
      return "timed out";
    case WaitOutcome::Status::kRejected:
      return "rejected";
    case WaitOutcome::Status::kDeviated:
      return "deviated";
    case WaitOutcome::Status::kProtectiveStop:
      return "protective stop";
    case WaitOutcome::Status::kEmergencyStop:
      return "emergency stop";
    case WaitOutcome::Status::kFault:
      return "fault";
    case WaitOutcome::Status::kLinkLost:
      return "link lost";
    case WaitOutcome::Status::kSensorFault:
      return "sensor fault";
    case WaitOutcome::Status::kGripperFault:
      return "gripper fault";
    case WaitOutcome::Status::kObjectLost:
      return "object lost";
    case WaitOutcome::Status::kInterrupted:
      return "interrupted";
  }
  return "unknown";
}

WaitOutcome WaitForArm(Cell& cell) { return WaitWhileMoving(cell, nullptr, {}); }

WaitOutcome RunTrajectory(Cell& cell, const CheckedTrajectory& planned) {
  const CheckedTrajectory trajectory = WithinSpeed(cell, planned);
  if (auto refused = StartTrajectory(cell, trajectory)) return *refused;
  return WaitWhileMoving(cell, &trajectory.trajectory(), {});
}

WaitOutcome RunGuarded(Cell& cell, const CheckedTrajectory& planned, double force_limit_N) {
  TT_CHECK(force_limit_N > 0.0);
  const CheckedTrajectory trajectory = WithinSpeed(cell, planned);
  const WrenchOutcome bias = AverageWrench(cell, kMeanSamples * Seconds(kControlPeriod));
  if (bias.outcome.status != WaitOutcome::Status::kDone) return bias.outcome;
  if (auto refused = StartTrajectory(cell, trajectory)) return *refused;
  ForceMean mean;
  Vector3 direction_K = Vector3::Zero();
  int over = 0;
  TimeNs newest{-1};
  std::optional<double> contact_N;
  const auto each_sample = [&](const ArmState& state) -> std::optional<WaitOutcome> {
    const WrenchSample sample = cell.wrist.Read();
    if (auto trouble = WristTrouble(cell, sample)) return trouble;
    if (sample.time == newest) return std::nullopt;
    newest = sample.time;
    mean.Add(sample.wrench_K.force_N - bias.mean_K.force_N);
    direction_K = MotionDirection_K(cell, trajectory.trajectory(), state.progress_s, direction_K);
    const double along_N = mean.mean_N().dot(direction_K);
    over = std::abs(along_N) > force_limit_N ? over + 1 : 0;
    if (over >= kContactSamples && !contact_N) {
      contact_N = along_N;
      cell.arm.Stop(StopKind::kOnPath);
    }
    return std::nullopt;
  };
  WaitOutcome outcome = WaitWhileMoving(cell, &trajectory.trajectory(), each_sample);
  const bool ended = outcome.status == WaitOutcome::Status::kDone ||
                     outcome.status == WaitOutcome::Status::kStopped;
  if (contact_N && ended) {
    outcome.status = WaitOutcome::Status::kContact;
    outcome.reason = "force along the motion " + std::to_string(*contact_N) + " N, limit " +
                     std::to_string(force_limit_N) + " N";
  }
  return outcome;
}

GripperOutcome MoveGripper(Cell& cell, const GripperCommand& command) {
  TT_CHECK(std::isfinite(command.opening_m) && command.opening_m >= 0.0);
  TT_CHECK(command.speed_m_s > 0.0 && command.force_N > 0.0);
  GripperOutcome result;
  result.state = cell.gripper.State();
  if (auto trouble = GripperTrouble(cell, result.state)) {
    result.outcome = *trouble;
    return result;
  }
  const double before_m = result.state.opening_m;
  if (auto stop = StopAtOnce(cell, 0.0)) {
    result.outcome = *stop;
    return result;
  }
  cell.gripper.Command(command);
  const TimeNs end = cell.clock.Now() + FromSeconds(kGripperTimeout_s);
  result.state = cell.gripper.State();
  while (result.state.object == GripperObject::kMoving) {
    if (auto trouble = GripperTrouble(cell, result.state)) {
      result.outcome = *trouble;
      return result;
    }
    if (cell.clock.Now() >= end) {
      result.outcome = {WaitOutcome::Status::kTimedOut, "gripper: still moving after 5 s", 0.0};
      return result;
    }
    PassPeriod(cell);
    result.state = cell.gripper.State();
  }
  auto trouble = GripperTrouble(cell, result.state);
  if (!trouble) trouble = WrongWay(command, before_m, result.state);
  if (trouble) result.outcome = *trouble;
  return result;
}

WrenchOutcome AverageWrench(Cell& cell, double duration_s) {
  TT_CHECK(duration_s >= Seconds(kControlPeriod));
  const TimeNs begin = cell.clock.Now(), end = begin + FromSeconds(duration_s);
  WrenchOutcome result;
  Wrench sum;
  TimeNs newest{-1};
  int count = 0, saturated = 0;
  // At rest late wrenches cost time and nothing else; a mean of the window's begin is none of it.
  constexpr double kPatience = 10.0;
  while (cell.clock.Now() < end || newest < begin + (end - begin) / 2) {
    PassPeriod(cell);
    const WrenchSample sample = cell.wrist.Read();
    if (auto trouble = WristTrouble(cell, sample, kPatience)) {
      result.outcome = *trouble;
      return result;
    }
    if (sample.time == newest || sample.time < begin) continue;
    newest = sample.time;
    sum = sum + sample.wrench_K;
    saturated += sample.saturated ? 1 : 0;
    ++count;
  }
  result.mean_K = sum * (1.0 / count);
  if (saturated > 0) {
    result.outcome = {WaitOutcome::Status::kSensorFault,
                      "wrist: " + std::to_string(saturated) + " of " + std::to_string(count) +
                          " samples are saturated",
                      0.0};
  }
  return result;
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
    PassPeriod(cell);
  }
  if (cell.scanner.Status() != ScanStatus::kReady) {
    throw Error(ErrorKind::kDevice, "scanner: scan failed: " + cell.scanner.FailureReason());
  }
  OrganizedCloud cloud = cell.scanner.Take();
  if (!cloud.X_NS.matrix().allFinite()) {
    throw Error(ErrorKind::kDevice,
                "arm: its joints' positions are no numbers: nobody knows where was scanned from");
  }
  return cloud;
}

WaitOutcome RecoverArm(Cell& cell) {
  const CommandResult asked = cell.arm.Recover();
  if (!asked.accepted()) return {WaitOutcome::Status::kRejected, asked.reason, 0.0};
  const TimeNs end = cell.clock.Now() + FromSeconds(kRecoverTimeout_s);
  ArmState state = cell.arm.State();
  while (state.mode != ArmMode::kReady && cell.clock.Now() < end) {
    PassPeriod(cell);
    state = cell.arm.State();
  }
  if (state.mode == ArmMode::kReady) return {};
  return OutcomeOf(state, WaitOutcome::Status::kStopped);
}

}  // namespace tubetwin
