#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/codecs/netft_config.h"
#include "hw_bridge/codecs/rdt.h"
#include "hw_bridge/emulators/emulator.h"
#include "hw_bridge/emulators/link_faults.h"
#include "hw_bridge/emulators/send_queue.h"
#include "hw_bridge/emulators/tcp_port.h"

namespace tubetwin {

struct WristEmulatorConfig {
  std::string listen = "127.0.0.1";
  int port = 49152;      ///< UDP, raw data transfer; 0: any free port.
  int http_port = 8049;  ///< TCP, configuration page; 0: any free port.
  double counts_per_N = 1e6, counts_per_Nm = 1e6;
  double rate_Hz = 1000;          ///< Records per second of cell time, 1 to 7000.
  double threshold_N = 0;         ///< A larger force latches the threshold bit; 0: none does.
  std::array<double, 6> range{};  ///< Largest readings, N and N m, for its pages.
};

/// An ATI Net F/T box with the readings of any ForceTorqueSensor: raw data transfer over UDP
/// (commands 0, 2, 3, 0x41, 0x42; others are ignored) and the pages /netftapi2.xml and
/// /netftcalapi.xml over HTTP, with or without ?index=0 to 15. It streams to one client, the last
/// that asked. Everything happens in Tick(); records of one period carry the same reading.
class WristEmulator : public Emulator {
 public:
  /// `sensor` and `io` must outlive it. Throws Error(kDevice) when a port cannot be had.
  WristEmulator(asio::io_context& io, ForceTorqueSensor& sensor, const WristEmulatorConfig& config);
  ~WristEmulator() override;

  void Tick(TimeNs now) override;

  int port() const;
  int http_port() const;
  std::uint64_t records() const { return records_; }  ///< Sent so far, or lost by a link fault.
  bool streaming() const { return streaming_; }

  // What fault scripts do. A corrupt record also loses its last byte: UDP's own check sum would
  // not let it through otherwise.
  LinkFaults& link() { return link_; }
  /// These bits, with the summary bit, until 0 is injected.
  void InjectStatus(std::uint32_t bits) { injected_ = bits; }
  void Saturate(bool saturated) { saturated_ = saturated; }
  void LatchThreshold() { latched_ = true; }
  /// Leaves out that many numbers in the records' sequence, as if they had been lost.
  void SkipSequence(std::uint32_t records) { rdt_sequence_ += records; }

 private:
  struct Udp;
  void TakeRequests(TimeNs now);
  void Start(TimeNs now, const RdtRequest& request);
  void Stream(TimeNs now);
  void SendPending(TimeNs now);
  void ServePage(TimeNs now);
  NetftPage Page() const;
  std::string HttpAnswerTo(const std::string& request) const;
  std::uint32_t Status(const WrenchSample& sample) const;

  ForceTorqueSensor& sensor_;
  WristEmulatorConfig config_;
  RdtScale scale_;
  std::unique_ptr<Udp> udp_;
  TcpPort http_;
  LinkFaults link_;
  SendQueue send_queue_;

  bool streaming_ = false, buffered_ = false;
  TimeNs began_{0};           ///< Of the stream.
  std::uint64_t made_ = 0;    ///< Records since then.
  std::uint64_t wanted_ = 0;  ///< Records until it ends; 0: never.
  std::uint32_t rdt_sequence_ = 0;
  std::string pending_;  ///< Records of a datagram that is not full yet.
  Wrench bias_K_;

  std::uint32_t injected_ = 0;
  bool saturated_ = false, latched_ = false;
  std::uint64_t records_ = 0;
};

}  // namespace tubetwin
