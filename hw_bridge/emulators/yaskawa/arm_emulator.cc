#include "hw_bridge/emulators/yaskawa/arm_emulator.h"

#include <algorithm>
#include <utility>

namespace tubetwin {
namespace {

namespace sm = simple_message;

constexpr int kStateClients = 4;
constexpr std::int32_t kMotionReplyId = 2002;

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
      controller_(arm, model, {config.pulses_per_degree, config.servo_on_s, 0.05, config.servo_on}),
      responder_(controller_),
      motion_(io, "arm (motion)", config.listen, config.motion_port,
              {[this](int clients) { return OneClient(clients, !controller_.queue_holds_data()); },
               [this](Client client) {
                 motion_client_ = client;
                 controller_.io().SetOutput(kOutMotionClient, true);
               },
               [this](Client client, std::string_view bytes) { ReceiveMotion(client, bytes); },
               [this](Client client) {
                 if (client != motion_client_) return;
                 controller_.DropMotion();
                 unhandled_.clear();
                 controller_.io().SetOutput(kOutMotionClient, false);
               }}),
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
      motion_.Send(motion_client_, sm::Encode(*late));
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
      motion_.Send(motion_client_, MotionError(none->id, WhyOf(*none)));
      return;
    }
    const sm::Message& message = std::get<sm::Message>(front);
    unhandled_.erase(0, SizeOf(message));
    const ArmController::Reaction reaction = controller_.Handle(message);
    if (reaction.disconnect) {
      unhandled_.clear();
      return motion_.Close(motion_client_);
    }
    if (reaction.answer) motion_.Send(motion_client_, sm::Encode(*reaction.answer));
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
