#include "hw_bridge/emulators/yaskawa/arm_emulator.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "hw_bridge/codecs/little_endian.h"

namespace tubetwin {
namespace {

namespace sm = simple_message;

ArmController::Settings ControllerAt(const ArmEmulatorConfig& config) {
  ArmController::Settings settings;
  settings.pulses_per_degree = config.pulses_per_degree;
  settings.servo_on_s = config.servo_on_s;
  settings.servo_on = config.servo_on;
  settings.server = config.server;
  return settings;
}

int FilePort(int hses_port) {
  constexpr int kLastPort = 65535;
  return hses_port == 0 || hses_port == kLastPort ? 0 : hses_port + 1;
}

TcpServer::Admission OneClient(int clients, bool may_replace) {
  if (clients == 0) return TcpServer::Admission::kAdd;
  return may_replace ? TcpServer::Admission::kReplace : TcpServer::Admission::kRefuse;
}

/// What the ports know by its size. Half of it is only ever sent by a controller.
constexpr std::int32_t kMotionIds[] = {1,    13,   14,   15,   2001, 2002, 2003,
                                       2005, 2007, 2009, 2016, 2018, 2020};
constexpr std::int32_t kIoIds[] = {2003, 2005, 2007, 2009, 2012, 2013};

template <std::size_t N>
std::variant<sm::FrontRequest, sm::NoMessage> ReadFront(std::string_view bytes,
                                                        const std::int32_t (&known)[N]) {
  if (bytes.size() >= sm::kHeadSize) {
    const std::int32_t id = LeInt32At(bytes, 4);
    if (std::count(std::begin(known), std::end(known), id) == 0) {
      return sm::NoMessage{sm::NoMessage::Kind::kUnknownId, id, ""};
    }
  }
  return sm::DecodeRequestFront(bytes);
}

sm::Invalid WhyOf(const sm::NoMessage& none) {
  return none.kind == sm::NoMessage::Kind::kUnknownId ? sm::Invalid::kMessageType
                                                      : sm::Invalid::kMessageSize;
}

/// A controller looks for sequence and command of whatever came, however little it was.
std::string MotionError(std::string_view bytes, const sm::NoMessage& none) {
  constexpr std::size_t kSequence = 20, kThird = 24, kSeen = 28;
  std::string padded(bytes.substr(0, kSeen));
  padded.resize(kSeen, '\0');
  sm::MotionReply reply{
      -1, -1, none.id, sm::Result::kInvalid, static_cast<std::int32_t>(WhyOf(none)), {}};
  if (none.kind != sm::NoMessage::Kind::kUnknownId) {
    const bool third = none.id == 2018;
    if (none.id == 14 || none.id == 2001 || none.id == 2016 || third) {
      reply.group = 0;
      reply.sequence = LeInt32At(padded, third ? kThird : kSequence);
    }
    if (none.id == 2001) reply.command = LeInt32At(padded, kThird);
  }
  return sm::Encode(sm::Reply(reply));
}

/// The I/O port's own way: result and subcode are the first two words of a motion reply.
std::string IoError(sm::Invalid why) {
  sm::MotionReply reply;
  reply.group = static_cast<std::int32_t>(sm::Result::kInvalid);
  reply.sequence = static_cast<std::int32_t>(why);
  return sm::Encode(sm::Reply(reply));
}

/// Answers are not answered.
bool IsReply(std::string_view bytes) {
  constexpr std::size_t kCommEnd = 12;
  return bytes.size() >= kCommEnd &&
         LeInt32At(bytes, 8) == static_cast<std::int32_t>(sm::Comm::kReply);
}

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
      state_(io, "arm (state)", config.listen, config.state_port,
             {[this](int) { return AdmitState(); }, [this](Client client) { JoinState(client); },
              [](Client, std::string_view) {},  // Nothing is asked here.
              [this](Client client) { LeaveState(client); }}),
      io_(io, "arm (I/O)", config.listen, config.io_port,
          {[this](int clients) { return OneClient(clients, !controller_.queue_holds_data()); },
           [this](Client) { controller_.io().SetOutput(kOutIoClient, true); },
           [this](Client client, std::string_view bytes) { ReceiveIo(client, bytes); },
           [](Client) {}}),  // OUT#895 stays on.
      hses_(io, "arm (HSES)", config.listen, config.hses_port,
            [this](std::string_view datagram) { return AnswerHses(datagram); }),
      hses_files_(io, "arm (HSES files)", config.listen, FilePort(config.hses_port),
                  [](std::string_view datagram) { return RefuseFile(datagram); }) {}

void ArmEmulator::Tick(TimeNs now) {
  controller_.Tick(now);
  if (controller_.busy()) {
    if (const auto late = controller_.TakeLate()) {
      AnswerMotion(sm::Encode(*late), late_to_reply_);
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
  hses_files_.Tick(now);
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

TcpServer::Admission ArmEmulator::AdmitState() {
  const auto free = std::find(state_slots_.begin(), state_slots_.end(), Client{0});
  if (free != state_slots_.end()) return TcpServer::Admission::kAdd;
  // Whoever moves the arm now may be among them.
  if (controller_.queue_holds_data()) return TcpServer::Admission::kRefuse;
  state_.Cut(state_slots_.front());
  return TcpServer::Admission::kAdd;
}

void ArmEmulator::JoinState(Client client) {
  *std::find(state_slots_.begin(), state_slots_.end(), Client{0}) = client;
  controller_.io().SetOutput(kOutStateClient, true);
}

void ArmEmulator::LeaveState(Client client) {
  std::replace(state_slots_.begin(), state_slots_.end(), client, Client{0});
  controller_.io().SetOutput(kOutStateClient, state_.clients() > 0);
}

void ArmEmulator::AnswerMotion(const std::string& answer, bool to_reply) {
  last_motion_answer_ = answer;
  if (!to_reply) motion_.Send(motion_client_, answer);
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
    const auto front = ReadFront(unhandled_, kMotionIds);
    const bool to_reply = IsReply(unhandled_);
    if (const auto* none = std::get_if<sm::NoMessage>(&front)) {
      const std::string error = MotionError(unhandled_, *none);
      unhandled_.clear();
      return AnswerMotion(error, to_reply);
    }
    const sm::FrontRequest& request = std::get<sm::FrontRequest>(front);
    // Groups that are not there may come along.
    const bool all_groups = std::holds_alternative<sm::JointPointEx>(request.message.body) &&
                            unhandled_.size() == sm::kLargestMessage;
    unhandled_.erase(0, all_groups ? unhandled_.size() : request.size);
    const ArmController::Reaction reaction = controller_.Handle(request.message);
    if (reaction.disconnect) {
      unhandled_.clear();
      return motion_.Close(motion_client_);
    }
    late_to_reply_ = to_reply;
    if (reaction.same_again && !last_motion_answer_.empty()) {
      AnswerMotion(std::string(last_motion_answer_), to_reply);
    } else if (reaction.answer) {
      AnswerMotion(sm::Encode(*reaction.answer), to_reply);
    }
  }
  motion_.Pause(motion_client_, controller_.busy());
}

void ArmEmulator::ReceiveIo(Client client, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto front = ReadFront(bytes, kIoIds);
    if (const auto* none = std::get_if<sm::NoMessage>(&front)) {
      return io_.Send(client, IoError(WhyOf(*none)));
    }
    const sm::FrontRequest& request = std::get<sm::FrontRequest>(front);
    bytes.remove_prefix(request.size);
    const auto answer = controller_.io().Answer(request.message.body);
    io_.Send(client, answer ? sm::Encode(*answer) : IoError(sm::Invalid::kMessageType));
  }
}

std::optional<std::string> ArmEmulator::AnswerHses(std::string_view datagram) {
  const auto request = hses::DecodeRequest(datagram);
  const auto* asked = std::get_if<hses::Request>(&request);
  // Garbage and answers get none.
  if (asked == nullptr || asked->ack != 0) return std::nullopt;
  return hses::Encode(responder_.AnswerTo(*asked));
}

std::optional<std::string> ArmEmulator::RefuseFile(std::string_view datagram) {
  const auto request = hses::DecodeRequest(datagram);
  const auto* asked = std::get_if<hses::Request>(&request);
  if (asked == nullptr || asked->ack != 0) return std::nullopt;
  return hses::Encode(HsesResponder::NoFiles(*asked));
}

}  // namespace tubetwin
