#include "hw_bridge/emulators/yaskawa/arm_emulator.h"

#include <algorithm>
#include <utility>

namespace tubetwin {
namespace {

namespace sm = simple_message;

constexpr int kStateClients = 4;
constexpr std::int32_t kMotionReplyId = 2002;

ArmController::Settings ControllerAt(const ArmEmulatorConfig& config) {
  ArmController::Settings settings;
  settings.pulses_per_degree = config.pulses_per_degree;
  settings.servo_on_s = config.servo_on_s;
  settings.servo_on = config.servo_on;
  settings.server = config.server;
  return settings;
}

TcpServer::Admission OneClient(int clients, bool may_replace) {
  if (clients == 0) return TcpServer::Admission::kAdd;
  return may_replace ? TcpServer::Admission::kReplace : TcpServer::Admission::kRefuse;
}

std::string MotionError(std::int32_t id, sm::Invalid why) {
  return sm::Encode(sm::Reply(
      sm::MotionReply{-1, -1, id, sm::Result::kInvalid, static_cast<std::int32_t>(why), {}}));
}

/// The I/O port's own way: result and subcode are the first two words of a motion reply.
std::string IoError(sm::Invalid why) {
  sm::MotionReply reply;
  reply.group = static_cast<std::int32_t>(sm::Result::kInvalid);
  reply.sequence = static_cast<std::int32_t>(why);
  return sm::Encode(sm::Reply(reply));
}

sm::Invalid WhyOf(const sm::NoMessage& none) {
  switch (none.kind) {
    case sm::NoMessage::Kind::kUnknownId:
      return sm::Invalid::kMessageType;
    case sm::NoMessage::Kind::kComm:
      return sm::Invalid::kHeader;
    default:
      return sm::Invalid::kMessageSize;
  }
}

std::size_t SizeOf(const sm::Message& message) { return sm::Encode(message).size(); }

}  // namespace

ArmEmulator::ArmEmulator(asio::io_context& io, ServoArm& arm, const ArmModel& model,
                         const ArmEmulatorConfig& config)
    : config_(config),
      controller_(arm, model, ControllerAt(config)),
      responder_(controller_),
      motion_(io, "arm (motion)", config.listen, config.motion_port,
              {[this](int clients) { return AdmitMotion(clients); },
               [this](Client client) { JoinMotion(client); },
               [this](Client client, std::string_view bytes) { ReceiveMotion(client, bytes); },
               [this](Client client) { LeaveMotion(client); }}),
      state_(
          io, "arm (state)", config.listen, config.state_port,
          {[](int clients) {
             return clients < kStateClients ? TcpServer::Admission::kAdd
                                            : TcpServer::Admission::kRefuse;
           },
           [this](Client) { controller_.io().SetOutput(kOutStateClient, true); },
           [](Client, std::string_view) {},  // Nothing is asked here.
           [this](Client) { controller_.io().SetOutput(kOutStateClient, state_.clients() > 0); }}),
      io_(io, "arm (I/O)", config.listen, config.io_port,
          {[](int clients) { return OneClient(clients, true); },
           [this](Client) { controller_.io().SetOutput(kOutIoClient, true); },
           [this](Client client, std::string_view bytes) { ReceiveIo(client, bytes); },
           [this](Client) { controller_.io().SetOutput(kOutIoClient, io_.clients() > 0); }}),
      hses_(io, "arm (HSES)", config.listen, config.hses_port,
            [this](std::string_view datagram) { return AnswerHses(datagram); }) {}

void ArmEmulator::Tick(TimeNs now) {
  controller_.Tick(now);
  if (controller_.busy()) {
    if (const auto late = controller_.TakeLate()) {
      AnswerMotion(sm::Encode(*late));
      motion_.Pause(motion_client_, false);
      HandleMotion();
    }
  }
  if (now >= next_state_) {
    state_.SendAll(sm::Encode(sm::Topic(controller_.Feedback())));
    state_.SendAll(sm::Encode(sm::Topic(controller_.Status())));
    next_state_ = now + FromSeconds(config_.state_period_s);
  }
  motion_.Tick(now);
  state_.Tick(now);
  io_.Tick(now);
  hses_.Tick(now);
}

void ArmEmulator::Refuse(std::int32_t subcode, int count) {
  const bool not_ready = subcode >= 5000;
  controller_.RefusePoints(not_ready ? sm::Result::kNotReady : sm::Result::kInvalid, subcode,
                           count);
}

TcpServer::Admission ArmEmulator::AdmitMotion(int clients) {
  // A connection that has just closed keeps its place while what it has sent still runs.
  const int taken = clients + (controller_.leaving() ? 1 : 0);
  const auto admission = OneClient(taken, !controller_.queue_holds_data());
  replacing_ = admission == TcpServer::Admission::kReplace;
  return admission;
}

void ArmEmulator::JoinMotion(Client client) {
  motion_client_ = client;
  replacing_ = false;
  last_motion_answer_.clear();
  controller_.JoinMotion();
}

void ArmEmulator::LeaveMotion(Client client) {
  if (client != motion_client_) return;
  controller_.LeaveMotion(replacing_);
  unhandled_.clear();
}

void ArmEmulator::AnswerMotion(const std::string& answer) {
  last_motion_answer_ = answer;
  motion_.Send(motion_client_, answer);
}

void ArmEmulator::ReceiveMotion(Client client, std::string_view bytes) {
  if (client != motion_client_) return;
  motion_bytes_ += bytes.size();
  unhandled_ += bytes;
  HandleMotion();
}

void ArmEmulator::HandleMotion() {
  // What one receive gave: whole messages one after another; a rest is not waited for.
  while (!unhandled_.empty() && !controller_.busy()) {
    const auto front = sm::DecodeFront(unhandled_, false);
    if (const auto* none = std::get_if<sm::NoMessage>(&front)) {
      unhandled_.clear();
      return AnswerMotion(MotionError(none->id, WhyOf(*none)));
    }
    const sm::Message& message = std::get<sm::Message>(front);
    unhandled_.erase(0, SizeOf(message));
    const ArmController::Reaction reaction = controller_.Handle(message);
    if (reaction.disconnect) {
      unhandled_.clear();
      return motion_.Close(motion_client_);
    }
    if (reaction.same_again && !last_motion_answer_.empty()) {
      AnswerMotion(std::string(last_motion_answer_));
    } else if (reaction.answer) {
      AnswerMotion(sm::Encode(*reaction.answer));
    }
  }
  motion_.Pause(motion_client_, controller_.busy());
}

void ArmEmulator::ReceiveIo(Client client, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto front = sm::DecodeFront(bytes, false);
    if (const auto* none = std::get_if<sm::NoMessage>(&front)) {
      return io_.Send(client, IoError(WhyOf(*none)));
    }
    const sm::Message& message = std::get<sm::Message>(front);
    bytes.remove_prefix(SizeOf(message));
    const auto answer = controller_.io().Answer(message.body);
    io_.Send(client, answer ? sm::Encode(sm::Reply(*answer)) : IoError(sm::Invalid::kMessageType));
  }
}

std::optional<std::string> ArmEmulator::AnswerHses(std::string_view datagram) {
  const auto request = hses::DecodeRequest(datagram);
  const auto* asked = std::get_if<hses::Request>(&request);
  // Garbage and answers get none.
  if (asked == nullptr || asked->ack != 0) return std::nullopt;
  return hses::Encode(responder_.AnswerTo(*asked));
}

}  // namespace tubetwin
