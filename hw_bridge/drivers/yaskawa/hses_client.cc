#include "hw_bridge/drivers/yaskawa/hses_client.h"

#include <array>
#include <asio.hpp>
#include <chrono>
#include <optional>
#include <utility>

#include "models/base/error.h"
#include "models/base/frames.h"

namespace tubetwin {
namespace {

using asio::ip::udp;
using Wall = std::chrono::steady_clock;

hses::Request Getting(std::uint16_t command, std::uint16_t instance) {
  hses::Request request;
  request.command = command;
  request.instance = instance;
  return request;
}

}  // namespace

std::string HsesConfig::Name() const {
  return "arm supervision " + host + ":" + std::to_string(port);
}

struct HsesClient::Impl {
  /// The next datagram until then; nothing: none came.
  std::optional<std::string> Receive(Wall::time_point until) {
    std::array<char, 2048> buffer{};
    std::optional<std::size_t> size;
    bool done = false;
    socket.async_receive(asio::buffer(buffer), [&](const asio::error_code& error, std::size_t n) {
      done = true;
      if (!error) size = n;  // Others say that nobody listens over there.
    });
    io.restart();
    while (!done && Wall::now() < until) io.run_one_until(until);
    if (!done) {
      socket.cancel();
      io.restart();
      while (!done) io.run_one();
    }
    if (!size) return std::nullopt;
    return std::string(buffer.data(), *size);
  }

  asio::io_context io{1};
  udp::socket socket{io};
  std::uint8_t id = 0;
  int ignored = 0;
};

HsesClient::HsesClient(const HsesConfig& config)
    : config_(config), impl_(std::make_unique<Impl>()) {
  TT_CHECK(config.tries > 0 && config.answer_s > 0.0);
  asio::error_code error;
  udp::resolver resolver(impl_->io);
  const auto found = resolver.resolve(config.host, std::to_string(config.port),
                                      udp::resolver::numeric_service, error);
  if (!error) asio::connect(impl_->socket, found, error);
  if (error) throw Error(ErrorKind::kDevice, config_.Name() + ": " + error.message());
}

HsesClient::~HsesClient() = default;

HsesResult<std::string> HsesClient::Ask(hses::Request request, int tries) {
  request.id = ++impl_->id;
  const std::string bytes = hses::Encode(request);
  const auto limit =
      std::chrono::duration_cast<Wall::duration>(std::chrono::duration<double>(config_.answer_s));
  for (int i = 0; i < tries; ++i) {
    asio::error_code lost;  // As datagrams may be.
    impl_->socket.send(asio::buffer(bytes), 0, lost);
    const auto until = Wall::now() + limit;
    while (Wall::now() < until) {
      const auto datagram = impl_->Receive(until);
      if (!datagram) continue;
      const auto decoded = hses::DecodeAnswer(*datagram);
      const auto* answer = std::get_if<hses::Answer>(&decoded);
      // Answers to earlier questions come late, or twice.
      if (answer == nullptr || answer->id != request.id || answer->service != request.service ||
          answer->division != request.division) {
        ++impl_->ignored;
        continue;
      }
      if (answer->status == hses::kOk) return answer->data;
      return HsesProblem{config_.Name() + ": " + hses::StatusText(*answer), false,
                         answer->added_status};
    }
  }
  return HsesProblem{config_.Name() + ": no answer in " + std::to_string(tries) + " tries", true,
                     0};
}

template <typename T, typename Decode>
HsesResult<T> HsesClient::Read(hses::Request request, Decode decode) {
  const HsesResult<std::string> data = Ask(std::move(request), config_.tries);
  if (const auto* problem = std::get_if<HsesProblem>(&data)) return *problem;
  auto decoded = decode(std::get<std::string>(data));
  if (const auto* error = std::get_if<DecodeError>(&decoded)) {
    return HsesProblem{config_.Name() + ": " + error->reason, false, 0};
  }
  return std::get<T>(std::move(decoded));
}

HsesResult<hses::Status> HsesClient::ReadStatus() {
  return Read<hses::Status>(Getting(hses::kStatus, 1), hses::DecodeStatus);
}

HsesResult<hses::Alarm> HsesClient::ReadAlarm(std::uint16_t which) {
  return Read<hses::Alarm>(Getting(hses::kAlarm, which), hses::DecodeAlarm);
}

HsesResult<hses::Job> HsesClient::ReadJob() {
  return Read<hses::Job>(Getting(hses::kExecutingJob, 1), hses::DecodeJob);
}

HsesResult<hses::Position> HsesClient::ReadPosition(std::uint16_t instance) {
  return Read<hses::Position>(Getting(hses::kPosition, instance), hses::DecodePosition);
}

HsesResult<JointVector> HsesClient::ReadJoints() {
  const HsesResult<hses::Position> read = ReadPosition(hses::kPulses);
  if (const auto* problem = std::get_if<HsesProblem>(&read)) return *problem;
  JointVector q;
  for (int i = 0; i < kNumJoints; ++i) {
    q[i] = Radians(std::get<hses::Position>(read).axes[i] / config_.pulses_per_degree);
  }
  return q;
}

HsesResult<hses::Value> HsesClient::ReadValue(std::uint16_t command, std::uint16_t number) {
  hses::Request request = Getting(command, number);
  request.attribute = 1;
  request.service = hses::kGetOne;
  return Read<hses::Value>(std::move(request), [command](const std::string& data) {
    return hses::DecodeValue(command, data);
  });
}

HsesResult<HsesDone> HsesClient::WriteValue(std::uint16_t command, std::uint16_t number,
                                            const hses::Value& value) {
  hses::Request request = Getting(command, number);
  request.attribute = 1;
  request.service = hses::kSetOne;
  request.data = hses::Encode(value);
  const HsesResult<std::string> data = Ask(std::move(request), config_.tries);
  if (const auto* problem = std::get_if<HsesProblem>(&data)) return *problem;
  return HsesDone{};
}

HsesResult<HsesDone> HsesClient::Set(std::uint16_t command, std::uint16_t instance,
                                     std::uint32_t word, int tries) {
  hses::Request request = Getting(command, instance);
  request.attribute = 1;
  request.service = hses::kSetOne;
  request.data = hses::Word(word);
  const HsesResult<std::string> data = Ask(std::move(request), tries);
  if (const auto* problem = std::get_if<HsesProblem>(&data)) return *problem;
  return HsesDone{};
}

HsesResult<HsesDone> HsesClient::SetHold(bool on) {
  return Set(hses::kPower, hses::kHold, on ? hses::kOn : hses::kOff, config_.tries);
}

HsesResult<HsesDone> HsesClient::SetServo(bool on) {
  return Set(hses::kPower, hses::kServo, on ? hses::kOn : hses::kOff, config_.tries);
}

HsesResult<HsesDone> HsesClient::ResetAlarm() {
  return Set(hses::kReset, hses::kResetAlarm, hses::kOn, config_.tries);
}

HsesResult<HsesDone> HsesClient::StartJob() { return Set(hses::kStartJob, 1, hses::kOn, 1); }

int HsesClient::ignored() const { return impl_->ignored; }

}  // namespace tubetwin
