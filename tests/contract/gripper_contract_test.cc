#include "tests/contract/gripper_contract.h"

#include "hw_bridge/drivers/robotiq/robotiq_gripper.h"
#include "hw_bridge/emulators/robotiq/gripper_emulator.h"
#include "hw_bridge/recording/cell_recorder.h"
#include "hw_bridge/recording/replay_cell.h"
#include "tests/contract/bench_rigs.h"
#include "tests/support/catch.h"
#include "tests/support/paper_scale.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin::test {
namespace {

/// The twin's gripper itself.
class TwinGripperRig : public GripperContractRig {
 public:
  Cell& cell() override { return world_.cell(); }
  double tube_diameter_m() override { return 2 * RigWorld::Radius(); }
  void TakeTubeAway() override { world_.TakeTubeAway(); }
  double TrueOpening_m() override { return world_.impl().gripper.TrueOpening(); }
  double PadForce_N() override { return world_.PadForce_N(); }
  double DeviceTime_s() override { return Seconds(world_.cell().clock.Now()); }

 private:
  RigWorld world_{true};
};

/// Before a recorder; what the bystander says is taken down, too.
class RecordedGripperRig : public GripperContractRig {
 public:
  RecordedGripperRig(const std::string& path, std::deque<double>& said)
      : recorder_(inner_.cell(), {}, path), said_(said) {}
  void Finish() { recorder_.Finish("the suite is over"); }
  Cell& cell() override { return recorder_.cell(); }
  double tube_diameter_m() override { return inner_.tube_diameter_m(); }
  void TakeTubeAway() override { inner_.TakeTubeAway(); }
  double TrueOpening_m() override { return said_.emplace_back(inner_.TrueOpening_m()); }
  double PadForce_N() override { return said_.emplace_back(inner_.PadForce_N()); }
  double DeviceTime_s() override { return said_.emplace_back(inner_.DeviceTime_s()); }

 private:
  TwinGripperRig inner_;
  CellRecorder recorder_;
  std::deque<double>& said_;
};

/// The recording's replay.
class ReplayedGripperRig : public GripperContractRig {
 public:
  ReplayedGripperRig(const std::string& path, std::deque<double> said)
      : replay_(CellRecording(path)), said_(std::move(said)) {}
  Cell& cell() override { return replay_.cell(); }
  double tube_diameter_m() override { return 2 * RigWorld::Radius(); }
  void TakeTubeAway() override {}
  double TrueOpening_m() override { return Next(); }
  double PadForce_N() override { return Next(); }
  double DeviceTime_s() override { return Next(); }
  const ReplayTally& Finish() {
    replay_.Finish();
    return replay_.tally();
  }

 private:
  double Next() {
    REQUIRE_FALSE(said_.empty());
    const double said = said_.front();
    said_.pop_front();
    return said;
  }
  ReplayCell replay_;
  std::deque<double> said_;
};

/// The driver and, over loopback, the emulated gripper on the twin's fingers, in real time.
class DriverGripperRig : public GripperContractRig {
 public:
  explicit DriverGripperRig(bool rtu)
      : served_(true,
                [&](asio::io_context& io, TwinCell::Impl& impl) {
                  GripperEmulatorConfig config;
                  config.scale = PaperScale();
                  config.port = 0;
                  config.transport = rtu ? "rtu" : "tcp";
                  return std::make_unique<GripperEmulator>(io, impl.gripper, config);
                }),
        driver_(Config(rtu), clock_),
        cell_(served_.Do([&](RigWorld& world) {
          return With(world.cell(), clock_, driver_, world.cell().wrist);
        })) {}
  Cell& cell() override { return cell_; }
  double tube_diameter_m() override { return 2 * RigWorld::Radius(); }
  void TakeTubeAway() override {
    served_.Do([](RigWorld& world) { world.TakeTubeAway(); });
  }
  double TrueOpening_m() override {
    return served_.Do([](RigWorld& world) { return world.impl().gripper.TrueOpening(); });
  }
  double PadForce_N() override {
    return served_.Do([](RigWorld& world) { return world.PadForce_N(); });
  }
  double DeviceTime_s() override {
    return served_.Do([](RigWorld& world) { return Seconds(world.cell().clock.Now()); });
  }

 private:
  RobotiqConfig Config(bool rtu) {
    RobotiqConfig config;
    config.scale = PaperScale();
    config.host = "127.0.0.1";
    config.transport = rtu ? "rtu" : "tcp";
    if (rtu) config.device = served_.emulator().device();
    if (!rtu) config.port = served_.emulator().port();
    return config;
  }
  ServedWorld<GripperEmulator> served_;
  WallClock clock_;
  RobotiqGripper driver_;
  Cell cell_;
};

using Suite = void (*)(GripperContractRig&);

TEST_CASE("Twin, its replay, and driver before emulated gripper keep the gripper's contract",
          "[contract]") {
  const auto [name, suite] = GENERATE(table<const char*, Suite>({
      {"moves", CheckGripperMoves},
      {"clamps", CheckGripperClamps},
      {"state", CheckGripperState},
      {"holds", CheckGripperHolds},
  }));
  CAPTURE(name);
  SECTION("twin") {
    TwinGripperRig rig;
    suite(rig);
  }
  SECTION("replay") {
    const TemporaryFolder folder;
    const std::string path = folder / "cell.rec.zst";
    std::deque<double> said;
    {
      RecordedGripperRig rig(path, said);
      suite(rig);
      rig.Finish();
    }
    ReplayedGripperRig rig(path, said);
    suite(rig);
    CHECK_FALSE(rig.Finish().difference.has_value());
  }
  SECTION("Modbus TCP") {
    DriverGripperRig rig(false);
    suite(rig);
  }
  SECTION("Modbus RTU") {
    DriverGripperRig rig(true);
    suite(rig);
  }
}

}  // namespace
}  // namespace tubetwin::test
