#include "hw_bridge/emulators/ati/wrist_emulator.h"

#include <algorithm>
#include <array>
#include <asio.hpp>
#include <cmath>
#include <utility>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

using asio::ip::udp;

const char* const kWho = "emulated force/torque sensor";
constexpr int kMaxRequests = 64;  // Per control period.
constexpr std::uint64_t kMaxRecords = 1000;
constexpr double kSensorRate_Hz = 7000.0;  // Of the box's own count of samples.
constexpr std::size_t kLongestRequest = 4096;
constexpr int kConfigurations = 16;

std::string HttpAnswer(const char* status, const char* type, const std::string& body) {
  return std::string("HTTP/1.0 ") + status + "\r\nContent-Type: " + type +
         "\r\nContent-Length: " + std::to_string(body.size()) + "\r\nConnection: close\r\n\r\n" +
         body;
}

}  // namespace

struct WristEmulator::Udp {
  explicit Udp(asio::io_context& io) : socket(io) {}
  udp::socket socket;
  udp::endpoint client;  ///< Who is streamed to.
  udp::endpoint from;    ///< Of the newest request.
};

WristEmulator::WristEmulator(asio::io_context& io, ForceTorqueSensor& sensor,
                             const WristEmulatorConfig& config)
    : sensor_(sensor),
      config_(config),
      scale_{config.counts_per_N, config.counts_per_Nm},
      udp_(std::make_unique<Udp>(io)),
      http_(io, kWho, config.listen, config.http_port) {
  asio::error_code error;
  const asio::ip::address address = asio::ip::make_address(config.listen, error);
  const auto at = udp::endpoint(address, static_cast<std::uint16_t>(config.port));
  if (!error) udp_->socket.open(at.protocol(), error);
  if (!error) udp_->socket.bind(at, error);
  if (!error) udp_->socket.non_blocking(true, error);
  if (error) {
    throw Error(ErrorKind::kDevice, std::string(kWho) + ": cannot listen on UDP " + config.listen +
                                        ":" + std::to_string(config.port) + ": " + error.message());
  }
}

WristEmulator::~WristEmulator() = default;

int WristEmulator::port() const { return udp_->socket.local_endpoint().port(); }
int WristEmulator::http_port() const { return http_.port(); }

void WristEmulator::Tick(TimeNs now) {
  if (link_.freeze) return;
  TakeRequests(now);
  if (streaming_) Stream(now);
  send_queue_.Deliver(now, [this](std::uint64_t, const std::string& datagram) {
    asio::error_code lost;  // A client that is gone, a full queue: so is the datagram.
    udp_->socket.send_to(asio::buffer(datagram), udp_->client, 0, lost);
  });
  ServePage(now);
}

void WristEmulator::TakeRequests(TimeNs now) {
  for (int i = 0; i < kMaxRequests; ++i) {
    std::array<char, 64> bytes;
    asio::error_code error;
    const std::size_t size = udp_->socket.receive_from(asio::buffer(bytes), udp_->from, 0, error);
    if (error == asio::error::would_block || error == asio::error::try_again) return;
    // Others speak of a client that does not listen any more.
    if (error || link_.drop) continue;
    const auto request = DecodeRdtRequest({bytes.data(), size});
    if (const auto* understood = std::get_if<RdtRequest>(&request)) Start(now, *understood);
  }
}

void WristEmulator::Start(TimeNs now, const RdtRequest& request) {
  switch (request.command) {
    case RdtCommand::kStop:
      if (udp_->from != udp_->client) return;
      SendPending(now);
      streaming_ = false;
      return;
    case RdtCommand::kStartRealTime:
    case RdtCommand::kStartBuffered:
      udp_->client = udp_->from;
      streaming_ = true;
      buffered_ = request.command == RdtCommand::kStartBuffered;
      began_ = now;
      made_ = 0;
      wanted_ = request.sample_count;
      rdt_sequence_ = 0;
      pending_.clear();
      return;
    case RdtCommand::kResetThreshold:
      latched_ = false;
      return;
    case RdtCommand::kSetBias:
      bias_K_ = sensor_.Read().wrench_K;
      return;
    case RdtCommand::kStartMultiUnit:
      return;
  }
}

void WristEmulator::Stream(TimeNs now) {
  const WrenchSample sample = sensor_.Read();
  if (config_.threshold_N > 0 && sample.wrench_K.force_N.norm() > config_.threshold_N) {
    latched_ = true;
  }
  RdtRecord record;
  record.status = Status(sample);
  record.counts = scale_.CountsOf(sample.wrench_K - bias_K_);
  // The first at once, the k-th after it k periods later.
  const auto due =
      1 + static_cast<std::uint64_t>(std::floor(Seconds(now - began_) * config_.rate_Hz + 1e-6));
  if (due > made_ + kMaxRecords) made_ = due - kMaxRecords;  // A leap of the cell's clock.
  while (streaming_ && made_ < due) {
    ++made_;
    ++records_;
    record.rdt_sequence = ++rdt_sequence_;
    record.ft_sequence = static_cast<std::uint32_t>(std::llround(
        (Seconds(began_) + static_cast<double>(made_ - 1) / config_.rate_Hz) * kSensorRate_Hz));
    EncodeRdtRecord(record, pending_);
    if (wanted_ > 0 && made_ >= wanted_) streaming_ = false;
    if (!streaming_ || !buffered_ || pending_.size() == kMaxRdtRecords * kRdtRecordSize) {
      SendPending(now);
    }
  }
}

void WristEmulator::SendPending(TimeNs now) {
  if (pending_.empty()) return;
  std::string datagram = std::exchange(pending_, {});
  if (link_.corrupt) datagram.pop_back();
  send_queue_.Put(link_, now, 0, std::move(datagram));
}

std::uint32_t WristEmulator::Status(const WrenchSample& sample) const {
  std::uint32_t bits = injected_;
  if (sample.saturated || saturated_) bits |= kRdtSaturation;
  if (latched_) bits |= kRdtThresholdLatched;
  return bits == 0 ? 0 : bits | kRdtErrorSummary;
}

NetftPage WristEmulator::Page() const {
  NetftPage page;
  page.product = "Net F/T";
  page.counts_per_force = config_.counts_per_N;
  page.counts_per_torque = config_.counts_per_Nm;
  page.rate_Hz = config_.rate_Hz;
  page.status = Status(sensor_.Read());
  page.torque_unit = "Nm";
  page.configuration = "tubetwin";
  page.serial = "FT00000";
  for (const double range : config_.range) {
    page.ratings += (page.ratings.empty() ? "" : ";") + Number(range);
  }
  return page;
}

std::string WristEmulator::HttpAnswerTo(const std::string& request) const {
  if (!request.starts_with("GET ")) {
    return HttpAnswer("405 Method Not Allowed", "text/plain", "GET is allowed\n");
  }
  const std::string target = request.substr(4, request.find_first_of(" \r\n", 4) - 4);
  const std::size_t query = std::min(target.find('?'), target.size());
  const std::string page = target.substr(0, query), index = target.substr(query);
  // One of the box's sixteen configurations and calibrations; they are all alike.
  bool known = index.empty();
  for (int i = 0; i < kConfigurations; ++i) known = known || index == "?index=" + std::to_string(i);
  if (known && page == "/netftapi2.xml") {
    return HttpAnswer("200 OK", "text/xml", EncodeNetftPage(Page()));
  }
  if (known && page == "/netftcalapi.xml") {
    return HttpAnswer("200 OK", "text/xml", EncodeNetftCalibrationPage(Page()));
  }
  return HttpAnswer("404 Not Found", "text/plain",
                    "there are /netftapi2.xml and /netftcalapi.xml, with ?index=0 to 15\n");
}

void WristEmulator::ServePage(TimeNs now) {
  http_.Poll(now, [&](std::uint64_t client, std::string& received) {
    if (link_.drop) {
      received.clear();
      return TcpPort::Verdict::kKeep;
    }
    if (received.find("\r\n\r\n") == std::string::npos) {
      return received.size() > kLongestRequest ? TcpPort::Verdict::kClose : TcpPort::Verdict::kKeep;
    }
    http_.Send(client, HttpAnswerTo(received));
    return TcpPort::Verdict::kClose;
  });
}

}  // namespace tubetwin
