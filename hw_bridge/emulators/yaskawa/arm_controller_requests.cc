// What a controller answers to the requests of its motion port.

#include <cmath>
#include <cstdlib>
#include <utility>

#include "hw_bridge/emulators/yaskawa/arm_controller.h"

namespace tubetwin {
namespace {

namespace sm = simple_message;

constexpr double kPatience_s = 5.0;  ///< For servo and job to answer.
constexpr std::int32_t kStartPulses = 30;
constexpr double kLongest_s = 14400.0;
constexpr double kRounding = 1e-5;  ///< Of a float32 at the limit.
constexpr int kPulseAxes = 8;       ///< That the controller compares at a start.

std::int32_t Code(sm::Invalid why) { return static_cast<std::int32_t>(why); }
std::int32_t Code(sm::NotReady why) { return static_cast<std::int32_t>(why); }

bool AllFinite(const sm::JointPoint& point) {
  return sm::ToJoints(point.q_rad).allFinite() && sm::ToJoints(point.qd_rad_s).allFinite() &&
         std::isfinite(point.time_s);
}

}  // namespace

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
      reply.subcode = Code(tool->group != 0 ? sm::Invalid::kGroup : sm::Invalid::kTool);
    }
    return Answered(reply);
  }
  // A message of another port.
  return Answered({-1, -1, 0, sm::Result::kInvalid, Code(sm::Invalid::kMessageType), {}});
}

bool ArmController::TooFast(const sm::Slots& qd_rad_s, int slots) const {
  for (int i = 0; i < slots; ++i) {
    const double max_rad_s = i < kNumJoints ? model_.joints[i].max_speed_rad_s : 0.0;
    // MotoROS compares the whole part.
    const double speed_rad_s = settings_.server == ArmServer::kMotoRos1
                                   ? std::trunc(std::abs(qd_rad_s[i]))
                                   : std::abs(qd_rad_s[i]) / (1 + kRounding);
    if (!(speed_rad_s <= max_rad_s)) return true;
  }
  return false;
}

std::optional<std::int32_t> ArmController::WhyNotBegin(const sm::JointPoint& point) const {
  const double to_pulses = 1.0 / PulseAngle();
  const JointVector commanded = arm_.Servo().q_commanded;
  for (int i = 0; i < kNumJoints; ++i) {
    const double off =
        std::trunc(point.q_rad[i] * to_pulses) - std::trunc(commanded[i] * to_pulses);
    if (std::abs(off) > kStartPulses) return Code(sm::Invalid::kStartPosition);
    // Axis by axis, as the controller does.
    if (TooFast(point.qd_rad_s, i + 1)) return Code(sm::Invalid::kSpeed);
  }
  if (TooFast(point.qd_rad_s, kPulseAxes)) return Code(sm::Invalid::kSpeed);
  return std::nullopt;
}

std::optional<std::int32_t> ArmController::WhyInvalid(const sm::JointPoint& point) const {
  constexpr std::int32_t kNeeded = sm::kTime | sm::kPosition | sm::kVelocity;
  const bool strict = settings_.server == ArmServer::kStrict;
  if (point.group != 0) return Code(sm::Invalid::kGroup);
  if ((point.valid_fields & kNeeded) != kNeeded) return Code(sm::Invalid::kInsufficient);
  if (point.time_s >= kLongest_s) return Code(sm::Invalid::kTime);
  if (point.sequence < 0) return Code(sm::Invalid::kSequence);
  // MotoROS converts what is no number to whatever its processor makes of it.
  if (!AllFinite(point)) return Code(sm::Invalid::kData);
  if (strict && point.time_s < 0.0f) return Code(sm::Invalid::kTime);
  if (strict && point.sequence == 0 && !queue_.empty()) return Code(sm::Invalid::kSequence);
  if (strict && point.sequence > 0 && !queue_.begun()) return Code(sm::Invalid::kSequence);
  return std::nullopt;
}

sm::MotionReply ArmController::HandlePoint(const sm::JointPoint& point) {
  sm::MotionReply reply{point.group, point.sequence, 14, sm::Result::kSuccess, 0, {}};
  const auto refused = [&reply](sm::Result result, std::int32_t subcode) {
    reply.result = result;
    reply.subcode = subcode;
    return reply;
  };
  if (refusals_ > 0) {
    --refusals_;
    return refused(refusal_, refusal_subcode_);
  }
  if (const auto why = WhyNot()) return refused(sm::Result::kNotReady, Code(*why));
  if (const auto why = WhyInvalid(point)) return refused(sm::Result::kInvalid, *why);
  // Times are cut to whole milliseconds, in single precision.
  const IncrementQueue::Point next{static_cast<std::int64_t>(point.time_s * 1000.0f),
                                   sm::ToJoints(point.q_rad), sm::ToJoints(point.qd_rad_s)};
  if (point.sequence == 0) {
    if (const auto why = WhyNotBegin(point)) return refused(sm::Result::kInvalid, *why);
    // Within the 30 pulses: the motion itself begins where the arm was commanded to be.
    queue_.Begin({next.time_ms, arm_.Servo().q_commanded, next.qd});
  } else {
    if (queue_.in_process()) {
      ++busy_answers_;
      return refused(sm::Result::kBusy, 0);
    }
    if (TooFast(point.qd_rad_s, kNumJoints)) {
      return refused(sm::Result::kInvalid, Code(sm::Invalid::kSpeed));
    }
    if (settings_.server == ArmServer::kStrict && next.time_ms <= queue_.last_time_ms()) {
      return refused(sm::Result::kInvalid, Code(sm::Invalid::kTime));
    }
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
      if (const auto why = WhyNot()) return failed(Code(*why));
      return Answered(reply);
    case sm::Command::kCheckQueueCount:
      if (control.group != 0) return failed(-1);
      reply.subcode = queue_.size();
      return Answered(reply);
    case sm::Command::kStopMotion:
      StopMotion();
      return Answered(reply);
    case sm::Command::kStartServos:
      if (servo_on_) return Answered(reply);
      if (emergency_stop_ || alarm_ != 0) return failed(0);
      PowerDrives();
      late_ = Late{reply, now_ + FromSeconds(kPatience_s), true};
      return {};
    case sm::Command::kStopServos:
      SwitchServo(false);
      return Answered(reply);
    case sm::Command::kResetAlarm:
      ResetAlarm();
      return alarm_ == 0 ? Answered(reply) : failed(0);
    case sm::Command::kStartTrajectoryMode:
      return StartTrajectoryMode(reply);
    case sm::Command::kStopTrajectoryMode:
    case sm::Command::kDisconnect:
      if (queue_holds_data()) return failed(0);
      StopMotion();
      io_.SetOutput(kOutDone, true);  // The job goes on from its WAIT, and ends.
      if (control.command == sm::Command::kDisconnect) return {std::nullopt, true};
      return Answered(reply);
  }
  return Unknown(reply);
}

ArmController::Reaction ArmController::Unknown(sm::MotionReply reply) const {
  reply.result = sm::Result::kInvalid;
  reply.subcode = Code(sm::Invalid::kCommand);
  Reaction reaction = Answered(reply);
  // MotoROS has no answer of its own to a command that it does not know.
  reaction.same_again = settings_.server == ArmServer::kMotoRos1;
  return reaction;
}

ArmController::Reaction ArmController::StartTrajectoryMode(sm::MotionReply reply) {
  contact_stop_ = false;
  increment_error_ = false;
  if (!arm_.Servo().fault.empty()) arm_.ClearServoFault();
  if (!WhyNot()) return Answered(reply);
  const auto refused = [&] {
    reply.result = sm::Result::kNotReady;
    reply.subcode = Code(WhyNot().value_or(sm::NotReady::kUnspecified));
    return Answered(reply);
  };
  // What runs is not interrupted, and what a person has stopped is not started.
  if (running() || emergency_stop_ || hold_ || !remote_) return refused();
  ResetAlarm();
  if (alarm_ != 0 || !play_) return refused();
  queue_.Clear();
  job_name_ = "INIT_ROS";
  if (servo_on_) {
    RunJob();
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
  const bool coming = servo_on_at_ || next_line_at_;
  if (!done && coming && now_ < late_->until) return std::nullopt;
  sm::MotionReply reply = late_->reply;
  if (!done) {
    reply.result = late_->servo_only ? sm::Result::kFailure : sm::Result::kNotReady;
    reply.subcode = late_->servo_only ? 0 : Code(why.value_or(sm::NotReady::kUnspecified));
  }
  late_.reset();
  return sm::Reply(reply);
}

}  // namespace tubetwin
