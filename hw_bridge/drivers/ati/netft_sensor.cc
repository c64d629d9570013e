#include "hw_bridge/drivers/ati/netft_sensor.h"

#include <algorithm>
#include <array>
#include <asio.hpp>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "hw_bridge/codecs/netft_config.h"
#include "hw_bridge/codecs/rdt.h"
#include "hw_bridge/drivers/ati/http_get.h"
#include "models/base/error.h"
#include "models/base/parallel.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

using asio::ip::udp;
using Wall = std::chrono::steady_clock;

constexpr double kConnect_s = 8.0;
constexpr auto kAskAgain = std::chrono::milliseconds(500);
/// Counts of two configurations are the same when they differ by less: pages print few digits.
constexpr double kSameCounts = 1e-4;
/// Noise changes the counts of a working sensor a thousand times per second.
constexpr TimeNs kStuck = std::chrono::milliseconds(100);
constexpr int kStuckRecords = 5;

std::chrono::nanoseconds Patience(double s, double rate) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * s * std::max(1.0, 1.0 / rate)));
}

RdtScale Configured(const NetftConfig& config) {
  return {config.counts_per_N, config.counts_per_Nm};
}

void RequireSame(const NetftConfig& config, const char* key, double box, double configured) {
  if (std::abs(box - configured) <= kSameCounts * configured) return;
  throw Error(ErrorKind::kConfig, config.Name() + ": its page says " + Number(box) +
                                      ", cell.wrist." + key + " is " + Number(configured) +
                                      ": set it to the page's if that is right");
}

RdtScale ScaleFromPage(const NetftConfig& config, std::chrono::nanoseconds limit) {
  const auto fail = [&](const std::string& problem) {
    throw Error(ErrorKind::kDevice, config.Name() + ": no configuration from http://" +
                                        config.host + ":" + std::to_string(config.http_port) +
                                        "/netftapi2.xml: " + problem);
  };
  const auto body = HttpGet(config.host, config.http_port, "/netftapi2.xml", limit);
  if (const auto* error = std::get_if<DecodeError>(&body)) fail(error->reason);
  const auto page = DecodeNetftPage(std::get<std::string>(body));
  if (const auto* error = std::get_if<DecodeError>(&page)) fail(error->reason);
  const auto scale = ScaleOf(std::get<NetftPage>(page));
  if (const auto* error = std::get_if<DecodeError>(&scale)) fail(error->reason);
  const RdtScale box = std::get<RdtScale>(scale);
  RequireSame(config, "counts_per_N", box.counts_per_N, config.counts_per_N);
  RequireSame(config, "counts_per_Nm", box.counts_per_Nm, config.counts_per_Nm);
  return box;
}

}  // namespace

struct NetftSensor::Impl {
  Impl(const NetftConfig& how, const CellClock& told) : config(how), clock(told), socket(io) {}
  ~Impl() {
    if (!thread.joinable()) return;
    asio::post(io, [this] {
      asio::error_code ignored;
      Send(RdtCommand::kStop);
      socket.close(ignored);
    });
    thread.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void Connect() {
    asio::error_code error;
    udp::resolver resolver(io);
    const auto found = resolver.resolve(config.host, std::to_string(config.port),
                                        udp::resolver::numeric_service, error);
    if (!error) asio::connect(socket, found, error);
    if (error) throw Error(ErrorKind::kDevice, config.Name() + ": " + error.message());
  }

  void Send(RdtCommand command) {
    const std::string bytes = EncodeRdtRequest({command, 0});
    asio::error_code lost;  // As datagrams may be.
    socket.send(asio::buffer(bytes), 0, lost);
  }

  void Receive() {
    socket.async_receive(asio::buffer(buffer), [this](asio::error_code error, std::size_t size) {
      if (error == asio::error::operation_aborted || !socket.is_open()) return;
      // Others say that nobody listens over there yet, or any more.
      if (!error) Take({buffer.data(), size});
      Receive();
    });
  }

  void Take(std::string_view datagram) {
    const TimeNs now = clock.Now();
    const auto decoded = DecodeRdtRecords(datagram);
    const std::lock_guard lock(mutex);
    const auto* records = std::get_if<std::vector<RdtRecord>>(&decoded);
    if (records == nullptr) {
      ++seen.malformed;
      return;
    }
    for (const RdtRecord& record : *records) TakeRecord(record, now);
    if (first && seen.samples > 0) came.notify_all();
  }

  void TakeRecord(const RdtRecord& record, TimeNs now) {
    // The box's own count of samples tells old from new, also across a stream that began again.
    if (last && static_cast<std::int32_t>(record.ft_sequence - last->ft_sequence) <= 0) {
      ++seen.late;
      return;
    }
    if (last) {
      const auto step = static_cast<std::int32_t>(record.rdt_sequence - last->rdt_sequence);
      if (step > 1) seen.lost += static_cast<std::uint64_t>(step - 1);
    }
    last = record;
    seen.status = record.status;
    if (RdtFaultBits(record.status) != 0) {
      ++seen.faulty;
      return;
    }
    ++seen.samples;
    if (seen.samples == 1 || record.counts != same_counts) {
      same_counts = record.counts;
      same_since = now;
      same = 0;
    }
    const bool stuck = ++same >= kStuckRecords && now - same_since >= kStuck;
    newest.problem = stuck ? "the same counts for " +
                                 Number(std::round(10.0 * Seconds(now - same_since)) / 10.0) +
                                 " s: the sensor is stuck, or somebody repeats what it said"
                           : "";
    newest.time = now;
    newest.wrench_K = scale.WrenchOf(record.counts);
    newest.saturated = (record.status & kRdtSaturation) != 0;
  }

  void AwaitFirst(Wall::time_point deadline) {
    std::unique_lock lock(mutex);
    while (seen.samples == 0) {
      if (Wall::now() >= deadline) {
        const std::string fault = RdtStatusText(seen.status);
        throw Error(ErrorKind::kDevice, config.Name() +
                                            ": no sample within 8 s of asking for a stream" +
                                            (seen.faulty > 0 ? ": " + fault : std::string()) +
                                            (seen.malformed > 0 ? ": what came is no record" : ""));
      }
      lock.unlock();
      asio::post(io, [this] { Send(RdtCommand::kStartRealTime); });
      lock.lock();
      came.wait_until(lock, std::min(deadline, Wall::now() + kAskAgain),
                      [this] { return seen.samples > 0; });
    }
    first = false;
  }

  NetftConfig config;
  const CellClock& clock;
  RdtScale scale;
  asio::io_context io;
  udp::socket socket;  ///< Of the thread, once it runs.
  std::array<char, 4096> buffer{};

  std::mutex mutex;  ///< Of all below but the thread.
  std::condition_variable came;
  bool first = true;                          ///< Somebody waits for the first sample.
  std::array<std::int32_t, 6> same_counts{};  ///< Of the newest record,
  TimeNs same_since{0};                       ///< since when,
  int same = 0;                               ///< and in how many.
  std::optional<RdtRecord> last;
  Statistics seen;
  WrenchSample newest;

  std::thread thread;
};

NetftSensor::NetftSensor(const NetftConfig& config, const CellClock& clock) {
  config.ValidateOrThrow();
  impl_ = std::make_unique<Impl>(config, clock);
  const auto limit = Patience(kConnect_s, config.rate);
  const auto deadline = Wall::now() + limit;
  impl_->scale = config.http_port == 0 ? Configured(config) : ScaleFromPage(config, limit);
  impl_->Connect();
  impl_->Receive();
  impl_->thread = std::thread([impl = impl_.get()] {
    KeepTime();
    impl->io.run();
  });
  impl_->AwaitFirst(deadline);
}

NetftSensor::~NetftSensor() = default;

WrenchSample NetftSensor::Read() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->newest;
}

NetftSensor::Statistics NetftSensor::statistics() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->seen;
}

std::string NetftSensor::FaultText() const {
  const std::lock_guard lock(impl_->mutex);
  return RdtFaultBits(impl_->seen.status) == 0 ? std::string() : RdtStatusText(impl_->seen.status);
}

}  // namespace tubetwin
