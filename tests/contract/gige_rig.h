#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "hw_bridge/drivers/photoneo/gige_scanner.h"
#include "hw_bridge/emulators/photoneo/scanner_gige_emulator.h"
#include "models/base/error.h"
#include "tests/contract/scanner_contract.h"
#include "tests/support/fake_scanner.h"

namespace tubetwin {

/// The link's configuration to an emulated scanner.
inline ScannerLinkConfig GigeLinkTo(const std::string& host, double timeout_s = 25.0) {
  ScannerLinkConfig config;
  config.driver = "gige";
  config.host = host;
  config.timeout_s = timeout_s;
  return config;
}

/// Driver and emulator on loopback, over a FakeScanner.
class GigeRig : public ScannerRig {
 public:
  static constexpr int kWidth = 160, kHeight = 120;  // Some 17 packets.

  explicit GigeRig(double timeout_s = 25.0) {
    device.sees = SomeScan(1, kWidth, kHeight);
    emulator.emplace(device, ScannerGigeConfig{"127.0.0.1", kWidth, kHeight});
    Connect(timeout_s);
  }
  void Connect(double timeout_s) {
    driver.emplace(GigeLinkTo("127.0.0.1", timeout_s), [this] { return X_NS; });
  }
  Scanner& scanner() override { return *driver; }
  void Step() override {
    device.now += FromSeconds(0.005);
    if (emulator) emulator->Tick(device.now);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  FakeScanner device;
  RigidTransform X_NS = Translation(0.1, 0.2, 0.5);
  std::optional<ScannerGigeEmulator> emulator;
  std::optional<GigeScanner> driver;
};

}  // namespace tubetwin
