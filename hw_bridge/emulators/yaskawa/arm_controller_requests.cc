// What a controller answers to the requests of its motion port.

#include <algorithm>
#include <cmath>
#include <utility>

#include "hw_bridge/emulators/yaskawa/arm_controller.h"
#include "hw_bridge/emulators/yaskawa/dh_parameters.h"

namespace tubetwin {
namespace {

namespace sm = simple_message;

constexpr double kPatience_s = 5.0;  ///< For servo and job to answer.
constexpr std::int32_t kStartPulses = 30;
constexpr double kLongest_s = 14400.0;
constexpr double kRounding = 1e-5;  ///< Of a float32 at the limit.
constexpr int kPulseAxes = 8;       ///< That the controller compares at a start.
constexpr std::int32_t kPointId = 14, kPointsId = 2016;
constexpr std::int32_t kNeeded = sm::kTime | sm::kPosition | sm::kVelocity;

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
  if (const auto* points = std::get_if<sm::JointPointEx>(&request.body)) {
    return HandlePoints(*points);
  }
  if (const auto* control = std::get_if<sm::MotionControl>(&request.body)) {
    return HandleControl(*control);
  }
  if (std::holds_alternative<sm::GetDhParameters>(request.body)) {
    return {sm::Reply(DhParametersOf(model_)), false};
  }
  if (const auto* tool = std::get_if<sm::SelectTool>(&request.body)) {
    sm::MotionReply reply{tool->group, tool->sequence, 2018, sm::Result::kSuccess, 0, {}};
    if (tool->group != 0 || tool->tool < 0 || tool->tool > 63) {
      reply.result = sm::Result::kInvalid;
      reply.subcode = Code(tool->group != 0 ? sm::Invalid::kGroup : sm::Invalid::kTool);
    }
    return Answered(reply);
  }
  // For the sake of clients from before the I/O port: bits and groups, not registers.
  if (auto answer = io().Answer(request.body)) return {std::move(*answer), false};
  // What a controller sends is known by its size, and ends the connection.
  return {std::nullopt, true};
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

ArmController::Verdict ArmController::TakePoint(const sm::JointPoint& point) {
  const bool strict = settings_.server == ArmServer::kStrict;
  const auto invalid = [](sm::Invalid why) { return Verdict{sm::Result::kInvalid, Code(why)}; };
  if (point.sequence < 0) return invalid(sm::Invalid::kSequence);
  // MotoROS converts what is no number to whatever its processor makes of it.
  if (!AllFinite(point)) return invalid(sm::Invalid::kData);
  if (strict && point.time_s < 0.0f) return invalid(sm::Invalid::kTime);
  // Times are cut to whole milliseconds, in single precision.
  const IncrementQueue::Point next{static_cast<std::int64_t>(point.time_s * 1000.0f),
                                   sm::ToJoints(point.q_rad), sm::ToJoints(point.qd_rad_s)};
  if (point.sequence == 0) {
    if (strict && !queue_.empty()) return invalid(sm::Invalid::kSequence);
    if (const auto why = WhyNotBegin(point)) return {sm::Result::kInvalid, *why};
    // Within the 30 pulses: the motion itself begins where the arm was commanded to be.
    queue_.Begin({next.time_ms, arm_.Servo().q_commanded, next.qd});
  } else {
    if (strict && !queue_.begun()) return invalid(sm::Invalid::kSequence);
    if (queue_.in_process()) {
      ++busy_answers_;
      return {sm::Result::kBusy, 0};
    }
    if (TooFast(point.qd_rad_s, kNumJoints)) return invalid(sm::Invalid::kSpeed);
    if (strict && next.time_ms <= queue_.last_time_ms()) return invalid(sm::Invalid::kTime);
    queue_.Add(next);
  }
  ++points_taken_;
  return {};
}

ArmController::Verdict ArmController::JudgePoint(const sm::JointPoint& point) {
  if (refusals_ > 0) {
    --refusals_;
    return {refusal_, refusal_subcode_};
  }
  const auto invalid = [](sm::Invalid why) { return Verdict{sm::Result::kInvalid, Code(why)}; };
  if (const auto why = WhyNot()) return {sm::Result::kNotReady, Code(*why)};
  if (point.group != 0) return invalid(sm::Invalid::kGroup);
  if ((point.valid_fields & kNeeded) != kNeeded) return invalid(sm::Invalid::kInsufficient);
  if (point.time_s >= kLongest_s) return invalid(sm::Invalid::kTime);
  return TakePoint(point);
}

sm::MotionReply ArmController::HandlePoint(const sm::JointPoint& point) {
  const Verdict verdict = JudgePoint(point);
  return {point.group, point.sequence, kPointId, verdict.result, verdict.subcode, {}};
}

ArmController::Reaction ArmController::HandlePoints(const sm::JointPointEx& points) {
  sm::MotionReply reply{0, points.sequence, kPointsId, sm::Result::kSuccess, 0, {}};
  const int count = std::min(points.groups, sm::kGroups);
  // Without a group there is no answer of its own.
  if (count <= 0) return Unknown(reply);
  const auto answered = [&](const sm::GroupPoint& part, const Verdict& verdict) {
    reply.group = part.group;
    reply.result = verdict.result;
    reply.subcode = verdict.subcode;
    return Answered(reply);
  };
  if (const auto why = WhyNot()) {
    return answered(points.points[count - 1], {sm::Result::kNotReady, Code(*why)});
  }
  for (int i = 0; i < count; ++i) {
    const sm::GroupPoint& part = points.points[i];
    if (part.group != 0) return answered(part, {sm::Result::kInvalid, Code(sm::Invalid::kGroup)});
    if (queue_.in_process()) return answered(part, {sm::Result::kBusy, 0});
    if ((part.valid_fields & kNeeded) != kNeeded) {
      return answered(part, {sm::Result::kInvalid, Code(sm::Invalid::kInsufficient)});
    }
  }
  for (int i = 0; i < count; ++i) {
    const sm::GroupPoint& part = points.points[i];
    const Verdict verdict = TakePoint({part.group, points.sequence, part.valid_fields, part.time_s,
                                       part.q_rad, part.qd_rad_s, part.qdd_rad_s2});
    if (verdict.result != sm::Result::kSuccess) return answered(part, verdict);
  }
  return answered(points.points[count - 1], {});
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
