#include "hw_bridge/cell/watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tubetwin {
namespace {

const double kStartTolerance_rad = Radians(0.2);
/// Codes below speak of commands that came too early, not of a broken gripper.
constexpr int kFirstGripperFault = 0x08;
/// Part of the path about the reported progress that is searched for the joints' place: a
/// controller may lag behind what it was sent.
constexpr double kPathBehind_s = 1.0, kPathAhead_s = 0.2, kPathStep_s = 0.02;
constexpr double kSpeedStep_s = 0.005;
constexpr double kNoOpening_m = 0.004;
/// Fingers that hold a tube do not give way so far.
constexpr double kOpened_m = 0.005;
/// Readings are rounded to steps that need not end on the range.
constexpr double kRangeSlack = 1.001;
constexpr const char* kWristAxes[] = {"force x",  "force y",  "force z",
                                      "torque x", "torque y", "torque z"};

std::string Number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

WaitOutcome Trouble(WaitOutcome::Status status, const std::string& reason, double progress_s = 0) {
  return {status, reason, progress_s};
}

/// Of an arm that says that it is nowhere: it is as good as silent.
WaitOutcome NoPlace(const ArmState& state) {
  return Trouble(WaitOutcome::Status::kLinkLost, "arm: its joints' positions are no numbers",
                 state.progress_s);
}

double Age_s(const Cell& cell, TimeNs time) { return Seconds(cell.clock.Now() - time); }

/// Largest joint distance of `q` from where the path is at `time_s`.
double Off(const JointVector& q, const JointTrajectory& path, double time_s) {
  return (q - Sample(path, time_s).q).cwiseAbs().maxCoeff();
}

/// Smallest distance of `q` from the path near `progress_s`.
double OffPath_rad(const JointVector& q, const JointTrajectory& path, double progress_s,
                   double enough_rad) {
  double min_off_rad = Off(q, path, progress_s);
  const double from_s = std::max(0.0, progress_s - kPathBehind_s);
  for (double t = progress_s + kPathAhead_s; t >= from_s && min_off_rad > enough_rad;
       t -= kPathStep_s) {
    min_off_rad = std::min(min_off_rad, Off(q, path, t));
  }
  return min_off_rad;
}

/// What the fingers say against a tube that they carry, or nothing.
std::optional<WaitOutcome> CarriedTrouble(const Cell& cell, const GripperState& fingers) {
  if (!cell.carried_opening_m) return std::nullopt;
  if (fingers.object == GripperObject::kAtPosition && fingers.requested_m < kNoOpening_m) {
    return Trouble(WaitOutcome::Status::kObjectLost, "gripper: closed to " +
                                                         Number("%.1f", 1e3 * fingers.opening_m) +
                                                         " mm while a tube was carried");
  }
  if (fingers.opening_m > *cell.carried_opening_m + kOpened_m) {
    return Trouble(WaitOutcome::Status::kGripperFault,
                   "gripper: opened from " + Number("%.1f", 1e3 * *cell.carried_opening_m) +
                       " to " + Number("%.1f", 1e3 * fingers.opening_m) +
                       " mm while a tube was carried, and not by this program");
  }
  return std::nullopt;
}

}  // namespace

std::optional<WaitOutcome> StopAtOnce(const Cell& cell, double progress_s) {
  if (!cell.stop_at_once || !cell.stop_at_once()) return std::nullopt;
  return Trouble(WaitOutcome::Status::kInterrupted,
                 "asked to stop at once; the arm stands on its path, the fingers stay as they are",
                 progress_s);
}

std::optional<WaitOutcome> RefuseStart(const Cell& cell, const CheckedTrajectory& trajectory) {
  if (auto stop = StopAtOnce(cell, 0.0)) return stop;
  const ArmState state = cell.arm.State();
  if (!state.q.allFinite()) return NoPlace(state);
  if (state.mode == ArmMode::kDisconnected) {
    return Trouble(WaitOutcome::Status::kLinkLost, "arm is disconnected: " + state.fault);
  }
  if (Age_s(cell, state.time) > cell.safety.arm_silence_s) {
    return Trouble(WaitOutcome::Status::kLinkLost,
                   "arm: newest state is " + Number("%.3f", Age_s(cell, state.time)) + " s old");
  }
  if (state.mode != ArmMode::kReady) return std::nullopt;  // The arm says it better.
  int worst = 0;
  const double off =
      (state.q - trajectory.trajectory().points.front().q).cwiseAbs().maxCoeff(&worst);
  if (off > kStartTolerance_rad) {
    return Trouble(WaitOutcome::Status::kRejected,
                   "joint " + std::to_string(worst + 1) + " is " + Number("%.3f", Degrees(off)) +
                       " degrees from the trajectory's first point, 0.2 allowed");
  }
  return std::nullopt;
}

CheckedTrajectory WithinSpeed(const Cell& cell, const CheckedTrajectory& trajectory) {
  double limit_m_s = cell.safety.max_speed_m_s;
  const double start_m_s = cell.proven ? 0.0 : cell.safety.start_speed_m_s;
  if (start_m_s > 0.0) limit_m_s = limit_m_s > 0.0 ? std::min(limit_m_s, start_m_s) : start_m_s;
  if (limit_m_s <= 0.0) return trajectory;
  double fastest_m_s = 0.0;
  for (double t = 0.0; t < trajectory.duration_s(); t += kSpeedStep_s) {
    const TrajectoryPoint point = Sample(trajectory.trajectory(), t);
    const JacobianMatrix J = Jacobian(cell.model.arm, point.q, cell.model.layout.X_FE);
    fastest_m_s = std::max(fastest_m_s, (J * point.qd).head<3>().norm());
  }
  return trajectory.Stretched(std::max(1.0, fastest_m_s / limit_m_s));
}

std::optional<WaitOutcome> GripperTrouble(const Cell& cell, const GripperState& state) {
  const auto trouble = [](const std::string& reason) {
    return Trouble(WaitOutcome::Status::kGripperFault, "gripper: " + reason);
  };
  if (Age_s(cell, state.time) > cell.safety.gripper_silence_s) {
    return trouble("newest state is " + Number("%.3f", Age_s(cell, state.time)) + " s old");
  }
  if (state.fault >= kFirstGripperFault) return trouble("fault " + std::to_string(state.fault));
  if (!state.activated) return trouble("not activated");
  if (!state.problem.empty()) return trouble(state.problem);
  if (!std::isfinite(state.opening_m)) return trouble("its opening is no number");
  return std::nullopt;
}

std::optional<WaitOutcome> WristTrouble(const Cell& cell, const WrenchSample& sample,
                                        double patience) {
  const auto trouble = [](const std::string& reason) {
    return Trouble(WaitOutcome::Status::kSensorFault, "wrist: " + reason);
  };
  const Vector3 &force_N = sample.wrench_K.force_N, &torque_Nm = sample.wrench_K.torque_Nm;
  for (int axis = 0; axis < 6; ++axis) {
    const double reading = axis < 3 ? force_N[axis] : torque_Nm[axis - 3];
    const double range = cell.model.wrist.range[static_cast<std::size_t>(axis)];
    if (std::abs(reading) <= kRangeSlack * range) continue;  // Not so for what is no number.
    const char* const unit = axis < 3 ? " N" : " N m";
    return trouble(std::string(kWristAxes[axis]) + " is " + Number("%.1f", reading) + unit +
                   ", its range ends at " + Number("%.1f", range) + unit);
  }
  // A sensor that is stuck beyond its range says more by the range.
  if (!sample.problem.empty()) return trouble(sample.problem);
  const double age_s = Age_s(cell, sample.time);
  if (age_s <= patience * cell.safety.wrist_silence_s) return std::nullopt;
  return trouble("newest wrench is " + Number("%.3f", age_s) + " s old");
}

std::optional<WaitOutcome> MotionTrouble(const Cell& cell, const ArmState& state,
                                         const JointTrajectory* path) {
  if (!state.q.allFinite()) return NoPlace(state);
  const double age_s = Age_s(cell, state.time);
  if (age_s > cell.safety.arm_silence_s) {
    return Trouble(WaitOutcome::Status::kLinkLost,
                   "arm: newest state is " + Number("%.3f", age_s) + " s old while it moves",
                   state.progress_s);
  }
  if (path != nullptr) {
    const double limit_rad = Radians(cell.safety.deviation_deg);
    const double off_rad = OffPath_rad(state.q, *path, state.progress_s, limit_rad);
    if (off_rad > limit_rad) {
      return Trouble(WaitOutcome::Status::kDeviated,
                     "a joint is " + Number("%.2f", Degrees(off_rad)) + " degrees off the path, " +
                         Number("%.2f", cell.safety.deviation_deg) + " allowed",
                     state.progress_s);
    }
  }
  const GripperState fingers = cell.gripper.State();
  auto trouble = GripperTrouble(cell, fingers);
  if (!trouble) trouble = CarriedTrouble(cell, fingers);
  if (trouble) trouble->progress_s = state.progress_s;
  return trouble;
}

}  // namespace tubetwin
