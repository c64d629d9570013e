#include "hw_bridge/drivers/yaskawa/motion_link.h"

#include <utility>

namespace tubetwin {
namespace {

namespace sm = simple_message;

constexpr std::int32_t kPointId = 14;
constexpr std::int32_t kLastSequence = 1 << 30;

const char* NameOf(sm::Command command) {
  switch (command) {
    case sm::Command::kCheckMotionReady:
      return "CHECK_MOTION_READY";
    case sm::Command::kCheckQueueCount:
      return "CHECK_QUEUE_CNT";
    case sm::Command::kStopMotion:
      return "STOP_MOTION";
    case sm::Command::kStartServos:
      return "START_SERVOS";
    case sm::Command::kStopServos:
      return "STOP_SERVOS";
    case sm::Command::kResetAlarm:
      return "RESET_ALARM";
    case sm::Command::kStartTrajectoryMode:
      return "START_TRAJ_MODE";
    case sm::Command::kStopTrajectoryMode:
      return "STOP_TRAJ_MODE";
    case sm::Command::kDisconnect:
      return "DISCONNECT";
  }
  return "command";
}

/// The answer to `request` when `body` is that.
std::optional<sm::MotionReply> Matching(const sm::Body& request, const sm::Body& body) {
  if (std::holds_alternative<sm::Ping>(request)) {
    return std::holds_alternative<sm::Ping>(body) ? std::optional(sm::MotionReply{}) : std::nullopt;
  }
  const auto* reply = std::get_if<sm::MotionReply>(&body);
  if (reply == nullptr) return std::nullopt;
  std::int32_t command = kPointId, sequence = 0;
  if (const auto* point = std::get_if<sm::JointPoint>(&request)) {
    sequence = point->sequence;
  } else if (const auto* control = std::get_if<sm::MotionControl>(&request)) {
    command = static_cast<std::int32_t>(control->command);
    sequence = control->sequence;
  }
  if (reply->command != command || reply->sequence != sequence) return std::nullopt;
  return *reply;
}

}  // namespace

std::string NameOf(const sm::Body& request) {
  if (const auto* point = std::get_if<sm::JointPoint>(&request)) {
    return "point " + std::to_string(point->sequence);
  }
  if (const auto* control = std::get_if<sm::MotionControl>(&request)) {
    return NameOf(control->command);
  }
  return "PING";
}

MotionLink::MotionLink(NetLoop& loop, const std::string& host, int port)
    : client_(loop, "arm (motion)", host, port) {}

void MotionLink::Connect(Time deadline) { client_.Connect(deadline); }

void MotionLink::Send(sm::Body request, Time due) {
  if (!client_.open()) return;
  if (auto* control = std::get_if<sm::MotionControl>(&request)) {
    sequence_ = sequence_ == kLastSequence ? 1 : sequence_ + 1;
    control->sequence = sequence_;
  }
  client_.Send(sm::Encode(sm::Request(request)));
  unanswered_.push_back({std::move(request), due});
}

std::vector<MotionLink::Answer> MotionLink::Take() {
  std::vector<Answer> answers;
  reader_.Append(client_.TakeReceived());
  while (const auto next = reader_.Next()) {
    if (const auto* error = std::get_if<DecodeError>(&*next)) {
      client_.Close("what came is no message: " + error->reason);
      break;
    }
    if (unanswered_.empty()) continue;
    const auto reply = Matching(unanswered_.front().request, std::get<sm::Message>(*next).body);
    if (!reply) continue;
    answers.push_back({std::move(unanswered_.front().request), *reply});
    unanswered_.pop_front();
  }
  if (!unanswered_.empty() && client_.open() &&
      std::chrono::steady_clock::now() > unanswered_.front().due) {
    client_.Close("no answer to " + NameOf(unanswered_.front().request));
  }
  return answers;
}

}  // namespace tubetwin
