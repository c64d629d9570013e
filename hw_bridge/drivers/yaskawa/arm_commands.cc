// What the cell asks of an ArmSession: nothing here touches a socket.

#include <algorithm>

#include "hw_bridge/drivers/yaskawa/arm_session.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

namespace sm = simple_message;

const double kStartTolerance_rad = Radians(0.2);
constexpr double kStartPulses = 30.0;  ///< How far the controller lets a start be from its command.
constexpr double kJoinTolerance_rad = 1e-4;
constexpr double kAtRest_rad_s = 0.02;
/// Single precision still tells milliseconds.
constexpr double kLongest_s = 3600.0;
/// Of the path, in the controller's queue: it runs that much after a link is lost. At least 0.2 s
/// of wall time, for hosts that are busy, and less than the queue's 0.8 s.
constexpr double kAhead_s = 0.2, kMaxAhead_s = 0.6;

CommandResult Rejected(const std::string& reason) {
  return {CommandResult::Status::kRejected, reason};
}

std::string TooLong(double duration_s) {
  return "the trajectory lasts " + Number(duration_s) + " s, " + Number(kLongest_s) +
         " s can be streamed";
}

}  // namespace

std::optional<ArmTrouble> ArmSession::Hindrance() const {
  if (latch_) return latch_;
  if (!config_.armed) {
    if (auto trouble = TroubleOf(*status_)) return trouble;
    if (status_->in_motion == 1) {
      const bool moves = state_.qd.cwiseAbs().maxCoeff() > kAtRest_rad_s;
      return ArmTrouble{ArmMode::kIdle, UncommandedMotion(moves)};
    }
    return ArmTrouble{ArmMode::kIdle,
                      "not armed: with cell.arm.armed = false nothing is sent to its motion port"};
  }
  const auto idle = [](const char* text) { return ArmTrouble{ArmMode::kIdle, text}; };
  if (recover_ || question_ == Question::kTrajectoryMode)
    return idle("START_TRAJ_MODE is asked for");
  if (question_ == Question::kWhyNotReady) return idle("motion is not possible");
  if (statuses_ < believe_from_) return idle("the controller's next state is awaited");
  if (auto trouble = TroubleOf(*status_)) return trouble;
  if (Settling()) return idle("the controller's job is on its way to its WAIT");
  if (status_->motion_possible == 0) return idle("motion is not possible");
  return std::nullopt;
}

ArmState ArmSession::State() const {
  ArmState state = state_;
  if (!lost_.empty()) {
    state.mode = ArmMode::kDisconnected;
    state.fault = lost_;
  } else if (motion_) {
    state.mode = motion_->held_back() ? ArmMode::kHolding : ArmMode::kMoving;
    state.planned_s = motion_->stream().planned_s();
  } else if (pending_ || alarm_ended_motion_) {
    state.mode = ArmMode::kMoving;
  } else if (const auto hindrance = Hindrance()) {
    state.mode = hindrance->mode;
    state.fault = hindrance->text;
  } else {
    state.mode = ArmMode::kReady;
  }
  return state;
}

std::optional<std::string> ArmSession::WhyNotStart(const JointTrajectory& trajectory) const {
  if (!lost_.empty()) return "arm is disconnected: " + lost_;
  if (motion_ || pending_ || alarm_ended_motion_) return "arm is moving";
  if (!config_.armed) {
    return "arm is not armed: with cell.arm.armed = false nothing is sent to its motion port";
  }
  if (const auto hindrance = Hindrance()) {
    return "arm is " + std::string(ToString(hindrance->mode)) + ": " + hindrance->text;
  }
  if (trajectory.duration_s() > kLongest_s) return TooLong(trajectory.duration_s());
  int worst = 0;
  const double off_rad = (state_.q - trajectory.points.front().q).cwiseAbs().maxCoeff(&worst);
  if (off_rad > kStartTolerance_rad) {
    return "joint " + std::to_string(worst + 1) + " is " + std::to_string(Degrees(off_rad)) +
           " degrees from the trajectory's first point, 0.2 allowed";
  }
  const double speed_rad_s = state_.qd.cwiseAbs().maxCoeff(&worst);
  if (speed_rad_s > kAtRest_rad_s) {
    return "joint " + std::to_string(worst + 1) + " still moves at " +
           std::to_string(Degrees(speed_rad_s)) + " degrees/s";
  }
  return std::nullopt;
}

JointVector ArmSession::StartPoint() const {
  // The controller compares with its command, which a standing arm is near, but not at.
  const double near_rad = Radians(kStartPulses / config_.pulses_per_degree);
  if (commanded_ && (*commanded_ - state_.q).cwiseAbs().maxCoeff() < near_rad) return *commanded_;
  return state_.q;
}

CommandResult ArmSession::Start(const CheckedTrajectory& trajectory) {
  if (const auto why = WhyNotStart(trajectory.trajectory())) return Rejected(*why);
  const double ahead_s = std::min(kMaxAhead_s, kAhead_s * std::max(1.0, config_.rate));
  motion_.emplace(trajectory.trajectory(), StartPoint(), arm_, ahead_s);
  over_at_.reset();
  state_.progress_s = 0.0;
  state_.done = false;
  return {};
}

CommandResult ArmSession::Append(const CheckedTrajectory& continuation) {
  if (!lost_.empty()) return Rejected("arm is disconnected: " + lost_);
  if (!motion_) return Rejected("no trajectory is running");
  if (motion_->stopped()) return Rejected("a stop is under way");
  const double duration_s = motion_->stream().planned_s() + continuation.duration_s();
  if (duration_s > kLongest_s) return Rejected(TooLong(duration_s));
  const JointVector& first = continuation.trajectory().points.front().q;
  const double gap_rad = (first - motion_->stream().end()).cwiseAbs().maxCoeff();
  if (gap_rad > kJoinTolerance_rad) {
    return Rejected("the continuation begins " + std::to_string(Degrees(gap_rad)) +
                    " degrees from the end of the running trajectory");
  }
  motion_->Append(continuation.trajectory());
  over_at_.reset();
  return {};
}

void ArmSession::Stop(StopKind kind) {
  if (motion_) motion_->Stop(kind, state_.qd);
}

CommandResult ArmSession::Recover() {
  if (!lost_.empty()) return Rejected("arm is disconnected: " + lost_);
  if (!config_.armed) {
    return Rejected("arm is not armed: nothing is sent to its motion port");
  }
  if (motion_ || pending_ || alarm_ended_motion_) return Rejected("the arm is moving");
  if (Hindrance() && question_ != Question::kTrajectoryMode) recover_ = true;
  state_.done = true;
  return {};
}

}  // namespace tubetwin
