#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/emulators/photoneo/gige_control.h"
#include "hw_bridge/emulators/photoneo/scan_components.h"
#include "hw_bridge/emulators/photoneo/scanner_emulator.h"

namespace tubetwin {

struct ScannerGigeConfig {
  std::string listen = "127.0.0.1";  ///< IPv4 address; the port, UDP 3956, is fixed.
  int width = 1032, height = 772;    ///< Of every cloud of the scanner.
  ScanOptics optics = {};
};

/// A PhoXi on GigE Vision over any Scanner: software trigger in, or none at all, the enabled
/// components out (ScanComponent; the range image as shipped, in millimetres), no pose and no
/// labels. For its traffic on the network, and for the networks that it must be kept from, see
/// GigeControl.
///
/// The components are the parts of a multi-part frame when the client wants that; else the first is
/// an image and further ones come behind it as chunks. Without any enabled nothing is sent.
///
/// A trigger starts a scan; one that comes during a scan discards that scan and starts another
/// after it. What is left to compute, and the sending, run on a thread of their own, one scan at a
/// time; the destructor waits for it. Lost packets are sent again on request. A scan that cannot be
/// had (refusal, failure, a cloud of another size) is never answered, as GigE Vision has no word
/// for it: see last_problem(). A frozen link keeps its heartbeat.
class ScannerGigeEmulator : public ScannerEmulator {
 public:
  /// `scanner` must outlive it. Throws Error(kDevice) when the address or its port cannot be had.
  ScannerGigeEmulator(Scanner& scanner, const ScannerGigeConfig& config);
  ~ScannerGigeEmulator() override;

  void Tick(TimeNs now) override;

 private:
  enum class Stage { kIdle, kScanning, kComputing, kHolding, kSending };
  struct Taken {
    GvspSender::Frame frame;
    std::string problem;  ///< Then there is no frame.
  };
  static Taken FrameOf(const OrganizedCloud& cloud, const ScannerGigeConfig& config,
                       const GigeFrameSettings& settings);
  /// Nobody waits for the scan that runs any more.
  bool Outdated() const;
  void Start();
  void FollowScan();
  void Compute();
  void TakeFrame(TimeNs now);
  void Send(TimeNs now);
  void FollowSending();
  void GiveUp(const std::string& problem);

  Scanner& scanner_;
  ScannerGigeConfig config_;
  GvspSender sender_;
  GigeControl camera_;

  Stage stage_ = Stage::kIdle;
  GvspClient client_;  ///< Who wanted the scan that runs.
  ScanFaults::Ordered fault_;
  std::future<Taken> computing_;
  GvspSender::Frame frame_;  ///< Waits to be sent.
  TimeNs send_at_{0};
  std::uint64_t frame_id_ = 0;  ///< The last one.
  std::atomic<bool> stop_sending_ = false;
  std::future<void> sending_;
};

}  // namespace tubetwin
