#include "tests/contract/wrist_contract.h"

#include "hw_bridge/drivers/ati/netft_sensor.h"
#include "hw_bridge/emulators/ati/wrist_emulator.h"
#include "hw_bridge/recording/cell_recorder.h"
#include "hw_bridge/recording/replay_cell.h"
#include "tests/contract/bench_rigs.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin::test {
namespace {

/// The twin's sensor itself.
class TwinWristRig : public WristContractRig {
 public:
  Cell& cell() override { return world_.cell(); }
  double tool_weight_N() override { return RigWorld::ToolWeight_N(); }
  Wrench Pull(const Vector3& force_K) override { return world_.Pull(force_K); }

 private:
  RigWorld world_{false};
};

/// Before a recorder; the loads are taken down, too.
class RecordedWristRig : public WristContractRig {
 public:
  RecordedWristRig(const std::string& path, std::deque<Wrench>& loads)
      : recorder_(inner_.cell(), {}, path), loads_(loads) {}
  void Finish() { recorder_.Finish("the suite is over"); }
  Cell& cell() override { return recorder_.cell(); }
  double tool_weight_N() override { return inner_.tool_weight_N(); }
  Wrench Pull(const Vector3& force_K) override { return loads_.emplace_back(inner_.Pull(force_K)); }

 private:
  TwinWristRig inner_;
  CellRecorder recorder_;
  std::deque<Wrench>& loads_;
};

/// The recording's replay.
class ReplayedWristRig : public WristContractRig {
 public:
  ReplayedWristRig(const std::string& path, std::deque<Wrench> loads)
      : replay_(CellRecording(path)), loads_(std::move(loads)) {}
  Cell& cell() override { return replay_.cell(); }
  double tool_weight_N() override { return RigWorld::ToolWeight_N(); }
  Wrench Pull(const Vector3&) override {
    REQUIRE_FALSE(loads_.empty());
    const Wrench load = loads_.front();
    loads_.pop_front();
    return load;
  }
  const ReplayTally& Finish() {
    replay_.Finish();
    return replay_.tally();
  }

 private:
  ReplayCell replay_;
  std::deque<Wrench> loads_;
};

/// The driver and, over loopback, the emulated box on the twin's sensor, in real time.
class DriverWristRig : public WristContractRig {
 public:
  DriverWristRig()
      : served_(false,
                [](asio::io_context& io, TwinCell::Impl& impl) {
                  WristEmulatorConfig config;
                  config.port = config.http_port = 0;
                  return std::make_unique<WristEmulator>(io, impl.wrist, config);
                }),
        driver_(Config(), clock_),
        cell_(served_.Do([&](RigWorld& world) {
          return With(world.cell(), clock_, world.cell().gripper, driver_);
        })) {}
  Cell& cell() override { return cell_; }
  double tool_weight_N() override { return RigWorld::ToolWeight_N(); }
  Wrench Pull(const Vector3& force_K) override {
    return served_.Do([&](RigWorld& world) { return world.Pull(force_K); });
  }

 private:
  NetftConfig Config() {
    NetftConfig config;
    config.host = "127.0.0.1";
    config.port = served_.emulator().port();
    config.http_port = served_.emulator().http_port();
    return config;
  }
  ServedWorld<WristEmulator> served_;
  WallClock clock_;
  NetftSensor driver_;
  Cell cell_;
};

using Suite = void (*)(WristContractRig&);

TEST_CASE("Twin, its replay, and driver before emulated box keep the sensor's contract",
          "[contract]") {
  const auto [name, suite] = GENERATE(table<const char*, Suite>({
      {"times", CheckWristTimes},
      {"reads", CheckWristReads},
      {"saturates", CheckWristSaturates},
  }));
  CAPTURE(name);
  SECTION("twin") {
    TwinWristRig rig;
    suite(rig);
  }
  SECTION("replay") {
    const TemporaryFolder folder;
    const std::string path = folder / "cell.rec.zst";
    std::deque<Wrench> loads;
    {
      RecordedWristRig rig(path, loads);
      suite(rig);
      rig.Finish();
    }
    ReplayedWristRig rig(path, loads);
    suite(rig);
    CHECK_FALSE(rig.Finish().difference.has_value());
  }
  SECTION("raw data transfer") {
    DriverWristRig rig;
    suite(rig);
  }
}

}  // namespace
}  // namespace tubetwin::test
