#pragma once

#include <chrono>
#include <thread>

#include "hw_bridge/drivers/photoneo/folder_scanner.h"
#include "hw_bridge/emulators/photoneo/scanner_folder_emulator.h"
#include "tests/contract/scanner_contract.h"
#include "tests/support/fake_scanner.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {

/// Driver and emulator on one folder, over a FakeScanner.
class FolderRig : public ScannerRig {
 public:
  explicit FolderRig(const std::string& format = "pcd", double timeout_s = 25.0)
      : emulator(device, Served(format)), driver(Link(timeout_s), [this] { return X_NS; }) {
    device.sees = SomeScan(1);
  }
  Scanner& scanner() override { return driver; }
  void Step() override {
    device.now += FromSeconds(0.005);
    if (feed_runs) emulator.Tick(device.now);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ScannerFolderConfig Served(const std::string& format) {
    ScannerFolderConfig config;
    config.path = folder.path();
    config.format = format;
    return config;
  }
  ScannerLinkConfig Link(double timeout_s) {
    ScannerLinkConfig config;
    config.path = folder.path();
    config.timeout_s = timeout_s;
    return config;
  }

  TemporaryFolder folder;
  FakeScanner device;
  RigidTransform X_NS = Translation(0.1, 0.2, 0.5);
  bool feed_runs = true;
  ScannerFolderEmulator emulator;
  FolderScanner driver;
};

}  // namespace tubetwin
