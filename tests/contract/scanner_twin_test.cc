#include <chrono>
#include <functional>
#include <mutex>
#include <thread>

#include "models/arm/arm.h"
#include "tests/contract/folder_rig.h"
#include "tests/contract/gige_rig.h"
#include "tests/support/catch.h"
#include "tests/twin_cell/cell_fixture.h"

namespace tubetwin::test {
namespace {

Pile SomePile() { return OneTube("pvc_a", {0.0, 0.0, 0.0125}); }

TwinCellOptions SmallScans(const Pile& pile) {
  TwinCellOptions options = NominalOptions(pile);
  options.scan.width = 172;
  options.scan.height = 128;
  return options;
}

/// The simulated scanner itself.
class TwinRig : public ScannerRig {
 public:
  TwinRig() : twin_(SomePile(), SmallScans(SomePile())) {}
  Scanner& scanner() override { return cell().scanner; }
  void Step() override { cell().clock.AdvanceTo(cell().clock.Now() + FromSeconds(0.005)); }
  Cell& cell() { return twin_.cell(); }

 private:
  TwinCell twin_;
};

/// Another scanner, of which it keeps what was taken last.
class TappedScanner : public Scanner {
 public:
  explicit TappedScanner(Scanner& scanner) : scanner_(scanner) {}
  CommandResult Trigger() override { return scanner_.Trigger(); }
  ScanStatus Status() const override { return scanner_.Status(); }
  OrganizedCloud Take() override { return TakeLater()(); }
  std::function<OrganizedCloud()> TakeLater() override {
    return [this, take = scanner_.TakeLater()] {
      const std::lock_guard lock(mutex_);
      return last_ = take();
    };
  }
  OrganizedCloud last() const {
    const std::lock_guard lock(mutex_);
    return last_;
  }

 private:
  Scanner& scanner_;
  mutable std::mutex mutex_;
  OrganizedCloud last_;
};

/// The simulated scanner behind a folder, under the driver.
class TwinFolderRig : public ScannerRig {
 public:
  explicit TwinFolderRig(const std::string& format)
      : tap_(twin_.scanner()), emulator_(tap_, Served(format)), driver_(Link(), [this] {
          Cell& cell = twin_.cell();
          return cell.bin.X_BN.inverse() * FlangePose(cell.model.arm, cell.arm.State().q) *
                 cell.model.layout.X_FS;
        }) {}
  Scanner& scanner() override { return driver_; }
  void Step() override {
    twin_.Step();
    emulator_.Tick(twin_.cell().clock.Now());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  OrganizedCloud seen() const { return tap_.last(); }

 private:
  ScannerFolderConfig Served(const std::string& format) {
    ScannerFolderConfig config;
    config.path = folder_.path();
    config.format = format;
    return config;
  }
  ScannerLinkConfig Link() {
    ScannerLinkConfig config;
    config.path = folder_.path();
    config.timeout_s = 25.0;
    return config;
  }

  TemporaryFolder folder_;
  TwinRig twin_;
  TappedScanner tap_;
  ScannerFolderEmulator emulator_;
  FolderScanner driver_;
};

/// The simulated scanner behind GigE Vision on loopback, under the driver.
class TwinGigeRig : public ScannerRig {
 public:
  TwinGigeRig()
      : tap_(twin_.scanner()),
        emulator_(tap_, {"127.0.0.1", 172, 128}),
        driver_(GigeLinkTo("127.0.0.1"), [] { return RigidTransform::Identity(); }) {}
  Scanner& scanner() override { return driver_; }
  void Step() override {
    twin_.Step();
    emulator_.Tick(twin_.cell().clock.Now());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  OrganizedCloud seen() const { return tap_.last(); }

 private:
  TwinRig twin_;
  TappedScanner tap_;
  ScannerGigeEmulator emulator_;
  GigeScanner driver_;
};

TEST_CASE("The twin's scanner keeps the scanner's contract", "[contract]") {
  TwinRig rig;
  CheckScannerContract(rig);
}

TEST_CASE("The twin's scanner behind a folder keeps the scanner's contract", "[contract]") {
  TwinFolderRig rig("pcd");
  CheckScannerContract(rig);
}

TEST_CASE("What the driver receives is what the twin's scanner saw", "[contract]") {
  const std::string format = GENERATE("pcd", "ply");
  TwinFolderRig rig(format);
  for (int shot = 0; shot < 2; ++shot) {
    const OrganizedCloud got = TakeScan(rig);
    CheckSamePoints(got, rig.seen(), format == "pcd" ? 0.0f : kMillimetreRounding);
    constexpr double kMeasuredJoints = 1e-4;  // The arm holds; its joints tremble meanwhile.
    CHECK(got.X_NS.isApprox(rig.seen().X_NS, kMeasuredJoints));
  }
}

TEST_CASE("The twin's scanner behind GigE Vision keeps the contract and its points", "[contract]") {
  TwinGigeRig rig;
  CheckScannerContract(rig);
  for (int shot = 0; shot < 2; ++shot) {
    const OrganizedCloud got = TakeScan(rig);
    CheckSamePoints(got, rig.seen(), kMillimetreRounding);
  }
}

}  // namespace
}  // namespace tubetwin::test
