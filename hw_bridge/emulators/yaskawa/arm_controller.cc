#include "hw_bridge/emulators/yaskawa/arm_controller.h"

#include <cmath>
#include <type_traits>
#include <utility>

namespace tubetwin {
namespace {

namespace sm = simple_message;

constexpr double kPatience_s = 5.0;  ///< For servo and job to answer.
constexpr double kInMotionPulses = 30.0;

}  // namespace

ArmController::ArmController(ServoArm& arm, const ArmModel& model, const Settings& settings)
    : arm_(arm), model_(model), settings_(settings), servo_on_(settings.servo_on) {
  io_.SetOutput(kOutInitDone, true);
  io_.SetOutput(kOutServer, true);
  UpdateOutputs();
}

std::optional<sm::NotReady> ArmController::WhyNot() const {
  if (alarm_ != 0) return sm::NotReady::kAlarm;
  if (emergency_stop_) return sm::NotReady::kEmergencyStop;
  if (!play_) return sm::NotReady::kNotPlay;
  if (!remote_) return sm::NotReady::kNotRemote;
  if (!servo_on_) return sm::NotReady::kServoOff;
  if (hold_) return sm::NotReady::kHold;
  if (contact_stop_) return sm::NotReady::kContactStop;
  if (job_ == Job::kStopped || job_name_ != "INIT_ROS") return sm::NotReady::kNotStarted;
  if (job_ != Job::kWaiting) return sm::NotReady::kWaiting;
  return std::nullopt;
}

void ArmController::Tick(TimeNs now) {
  now_ = now;
  if (servo_on_at_ && now >= *servo_on_at_) {
    servo_on_at_.reset();
    servo_on_ = true;
    if (std::exchange(start_job_after_servo_, false)) StartWaiting();
  }
  if (waiting_at_ && now >= *waiting_at_) {
    waiting_at_.reset();
    job_ = Job::kWaiting;
  }
  // Drives that gave up are what a contact looks like from here.
  if (!contact_stop_ && !arm_.Servo().fault.empty()) ProtectiveStop();
  queue_.Cut();
  if (!WhyNot()) {
    if (const auto reference = queue_.Next()) arm_.Follow(*reference);
  }
  UpdateOutputs();
}

void ArmController::UpdateOutputs() {
  io_.SetOutput(kOutWaiting, job_ == Job::kWaiting);
  io_.SetOutput(kOutFailure, alarm_ != 0);
}

bool ArmController::moving() const {
  const ServoState servo = arm_.Servo();
  const double off = (servo.q - servo.q_commanded).cwiseAbs().maxCoeff();
  return !queue_.empty() || servo.moving || off > kInMotionPulses * PulseAngle();
}

std::array<std::int32_t, kNumJoints> ArmController::Pulses() const {
  std::array<std::int32_t, kNumJoints> pulses{};
  const JointVector q = arm_.Servo().q;
  for (int i = 0; i < kNumJoints; ++i) {
    pulses[i] = static_cast<std::int32_t>(std::lround(q[i] / PulseAngle()));
  }
  return pulses;
}

sm::JointFeedback ArmController::Feedback() const {
  const ServoState servo = arm_.Servo();
  sm::JointFeedback feedback;
  feedback.q_rad = sm::ToSlots(servo.q);
  feedback.qd_rad_s = sm::ToSlots(servo.qd);
  return feedback;
}

sm::RobotStatus ArmController::Status() const {
  sm::RobotStatus status;
  status.drives_powered = servo_on_ ? 1 : 0;
  status.e_stopped = emergency_stop_ ? 1 : 0;
  status.error_code = alarm_;
  status.in_error = alarm_ != 0 ? 1 : 0;
  status.in_motion = moving() ? 1 : 0;
  status.mode = play_ ? sm::RobotStatus::kPlay : sm::RobotStatus::kTeach;
  status.motion_possible = WhyNot() ? 0 : 1;
  return status;
}

// Requests of the motion port.

ArmController::Reaction ArmController::Answered(sm::MotionReply reply) const {
  return {sm::Reply(std::move(reply)), false};
}

ArmController::Reaction ArmController::Handle(const sm::Message& request) {
  if (std::holds_alternative<sm::Ping>(request.body)) return {sm::Reply(sm::Ping{}), false};
  if (const auto* point = std::get_if<sm::JointPoint>(&request.body)) {
    return Answered(HandlePoint(*point));
  }
  if (const auto* control = std::get_if<sm::MotionControl>(&request.body)) {
    return HandleControl(*control);
  }
  if (const auto* tool = std::get_if<sm::SelectTool>(&request.body)) {
    sm::MotionReply reply{tool->group, tool->sequence, 2018, sm::Result::kSuccess, 0, {}};
    if (tool->group != 0 || tool->tool < 0 || tool->tool > 63) {
      reply.result = sm::Result::kInvalid;
      reply.subcode =
          static_cast<std::int32_t>(tool->group != 0 ? sm::Invalid::kGroup : sm::Invalid::kTool);
    }
    return Answered(reply);
  }
  // A message of another port.
  return Answered(
      {-1, -1, 0, sm::Result::kInvalid, static_cast<std::int32_t>(sm::Invalid::kMessageType), {}});
}

std::optional<std::int32_t> ArmController::WhyInvalid(const sm::JointPoint& point) const {
  const auto because = [](sm::Invalid code) { return static_cast<std::int32_t>(code); };
  constexpr std::int32_t kNeeded = sm::kTime | sm::kPosition | sm::kVelocity;
  constexpr double kLongest_s = 14400.0;
  constexpr double kRounding = 1e-5;  ///< Of a float32 at the limit.
  if (point.group != 0) return because(sm::Invalid::kGroup);
  if (point.sequence < 0) return because(sm::Invalid::kSequence);
  if ((point.valid_fields & kNeeded) != kNeeded) return because(sm::Invalid::kInsufficient);
  if (!(point.time_s >= 0.0f && point.time_s < kLongest_s)) return because(sm::Invalid::kTime);
  const JointVector q = sm::ToJoints(point.q_rad), qd = sm::ToJoints(point.qd_rad_s);
  if (!q.allFinite()) return because(sm::Invalid::kPosition);
  for (int i = 0; i < kNumJoints; ++i) {
    if (!(std::abs(qd[i]) <= model_.joints[i].max_speed_rad_s * (1 + kRounding))) {
      return because(sm::Invalid::kSpeed);
    }
  }
  if (point.sequence > 0) {
    return queue_.begun() ? std::nullopt : std::optional(because(sm::Invalid::kSequence));
  }
  if (!queue_.empty()) return because(sm::Invalid::kSequence);
  const double off = (q - arm_.Servo().q_commanded).cwiseAbs().maxCoeff();
  if (off > kInMotionPulses * PulseAngle()) return because(sm::Invalid::kStartPosition);
  return std::nullopt;
}

sm::MotionReply ArmController::HandlePoint(const sm::JointPoint& point) {
  sm::MotionReply reply{point.group, point.sequence, 14, sm::Result::kSuccess, 0, {}};
  if (refusals_ > 0) {
    --refusals_;
    reply.result = refusal_;
    reply.subcode = refusal_subcode_;
    return reply;
  }
  if (const auto why = WhyNot()) {
    reply.result = sm::Result::kNotReady;
    reply.subcode = static_cast<std::int32_t>(*why);
    return reply;
  }
  if (const auto why = WhyInvalid(point)) {
    reply.result = sm::Result::kInvalid;
    reply.subcode = *why;
    return reply;
  }
  if (queue_.in_process()) {
    reply.result = sm::Result::kBusy;
    ++busy_answers_;
    return reply;
  }
  // Times are cut to whole milliseconds, in single precision.
  const IncrementQueue::Point next{static_cast<std::int64_t>(point.time_s * 1000.0f),
                                   sm::ToJoints(point.q_rad), sm::ToJoints(point.qd_rad_s)};
  if (point.sequence == 0) {
    queue_.Clear();
    // Within the 30 pulses: the motion itself begins where the arm was commanded to be.
    queue_.Begin({next.time_ms, arm_.Servo().q_commanded, next.qd});
  } else if (next.time_ms <= queue_.last_time_ms()) {
    reply.result = sm::Result::kInvalid;
    reply.subcode = static_cast<std::int32_t>(sm::Invalid::kTime);
    return reply;
  } else {
    queue_.Add(next);
  }
  ++points_taken_;
  return reply;
}

ArmController::Reaction ArmController::HandleControl(const sm::MotionControl& control) {
  sm::MotionReply reply{control.group,
                        control.sequence,
                        static_cast<std::int32_t>(control.command),
                        sm::Result::kSuccess,
                        0,
                        {}};
  const auto failed = [&](std::int32_t subcode) {
    reply.result = sm::Result::kFailure;
    reply.subcode = subcode;
    return Answered(reply);
  };
  switch (control.command) {
    case sm::Command::kCheckMotionReady:
      if (const auto why = WhyNot()) return failed(static_cast<std::int32_t>(*why));
      return Answered(reply);
    case sm::Command::kCheckQueueCount:
      reply.subcode = queue_.size();
      return Answered(reply);
    case sm::Command::kStopMotion:
      StopMotion();
      return Answered(reply);
    case sm::Command::kStartServos:
      if (servo_on_) return Answered(reply);
      if (emergency_stop_ || alarm_ != 0) {
        return failed(static_cast<std::int32_t>(*WhyNot()));
      }
      PowerDrives();
      late_ = Late{reply, now_ + FromSeconds(kPatience_s), true};
      return {};
    case sm::Command::kStopServos:
      SwitchServo(false);
      return Answered(reply);
    case sm::Command::kResetAlarm:
      ResetAlarm();
      return alarm_ == 0 ? Answered(reply) : failed(static_cast<std::int32_t>(*WhyNot()));
    case sm::Command::kStartTrajectoryMode:
      return StartTrajectoryMode(reply);
    case sm::Command::kStopTrajectoryMode:
      if (!queue_.empty()) return failed(0);
      StopJob();
      return Answered(reply);
    case sm::Command::kDisconnect:
      if (!queue_.empty()) return failed(0);
      return {std::nullopt, true};
  }
  reply.result = sm::Result::kInvalid;
  reply.subcode = static_cast<std::int32_t>(sm::Invalid::kCommand);
  return Answered(reply);
}

ArmController::Reaction ArmController::StartTrajectoryMode(sm::MotionReply reply) {
  if (!WhyNot()) return Answered(reply);
  StopMotion();
  ResetAlarm();
  contact_stop_ = false;
  if (!arm_.Servo().fault.empty()) arm_.ClearServoFault();
  if (alarm_ != 0 || emergency_stop_ || !play_ || !remote_ || hold_) {
    reply.result = sm::Result::kNotReady;
    reply.subcode = static_cast<std::int32_t>(*WhyNot());
    return Answered(reply);
  }
  job_name_ = "INIT_ROS";
  if (servo_on_) {
    StartWaiting();
  } else {
    start_job_after_servo_ = true;
    PowerDrives();
  }
  late_ = Late{reply, now_ + FromSeconds(kPatience_s), false};
  return {};
}

std::optional<sm::Message> ArmController::TakeLate() {
  if (!late_) return std::nullopt;
  const auto why = WhyNot();
  const bool done = late_->servo_only ? servo_on_ : !why;
  // What can no longer come is not waited for.
  const bool coming = servo_on_at_ || waiting_at_;
  if (!done && coming && now_ < late_->until) return std::nullopt;
  sm::MotionReply reply = late_->reply;
  if (!done) {
    reply.result = sm::Result::kNotReady;
    reply.subcode = static_cast<std::int32_t>(why.value_or(sm::NotReady::kUnspecified));
  }
  late_.reset();
  return sm::Reply(reply);
}

void ArmController::DropMotion() {
  queue_.Clear();
  late_.reset();
}

}  // namespace tubetwin
