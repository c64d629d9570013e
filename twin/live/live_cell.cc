#include "twin/live/live_cell.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "hw_bridge/cell/wall_clock.h"
#include "hw_bridge/drivers/ati/netft_sensor.h"
#include "hw_bridge/drivers/photoneo/scanner_link.h"
#include "hw_bridge/drivers/robotiq/robotiq_gripper.h"
#include "hw_bridge/drivers/yaskawa/yaskawa_arm.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "twin/cell/twin_cell.h"
#include "twin/round/twin_setup.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

/// Wall time, with a twin that is kept up to it. While the pipeline computes the twin stands still
/// and catches up afterwards.
class LiveClock : public CellClock {
 public:
  explicit LiveClock(double rate) : wall_(rate) {}
  void Keep(TwinCell& twin) { twin_ = &twin; }
  TimeNs Now() const override { return wall_.Now(); }
  void AdvanceTo(TimeNs t) override {
    if (twin_ != nullptr) {
      CellClock& twins = twin_->cell().clock;
      while (twins.Now() < t) {
        const TimeNs next = std::min(t, twins.Now() + kControlPeriod);
        wall_.AdvanceTo(next);
        twins.AdvanceTo(next);
      }
    }
    wall_.AdvanceTo(t);
  }

 private:
  WallClock wall_;
  TwinCell* twin_ = nullptr;
};

bool IsTwins(const std::string& driver) { return driver == "twin"; }

}  // namespace

void RequireArmed(const Scenario& scenario) {
  const CellConfig::Arm& arm = scenario.cell.arm;
  if (arm.driver != "simple_message" || arm.armed) return;
  throw Error(ErrorKind::kConfig,
              "cell.arm.armed: is false; the arm at " + arm.host + ":" +
                  std::to_string(arm.motion_port) +
                  " is not the twin's and moves only when a person who has checked the cell "
                  "writes armed = true into [cell.arm]; nothing was sent (see also --dry-run)");
}

std::unique_ptr<Arm> ConnectArm(const Scenario& scenario, const ArmModel& model,
                                const CellClock& clock, CellPurpose purpose) {
  const CellConfig::Arm& chosen = scenario.cell.arm;
  TT_CHECK(chosen.driver == "simple_message");
  YaskawaConfig config;
  config.host = chosen.host;
  config.motion_port = chosen.motion_port;
  config.state_port = chosen.state_port;
  config.io_port = chosen.io_port;
  config.pulses_per_degree = chosen.pulses_per_degree;
  config.armed = chosen.armed && purpose == CellPurpose::kRun;
  config.rate = scenario.rate;
  return std::make_unique<YaskawaArm>(config, model, clock);
}

std::unique_ptr<Gripper> ConnectGripper(const Scenario& scenario, const CellClock& clock,
                                        CellPurpose purpose) {
  const CellConfig::Gripper& chosen = scenario.cell.gripper;
  TT_CHECK(chosen.driver == "modbus_tcp" || chosen.driver == "modbus_rtu");
  RobotiqConfig config;
  config.transport = chosen.driver == "modbus_tcp" ? "tcp" : "rtu";
  config.host = chosen.host;
  config.port = chosen.port;
  config.device = chosen.device;
  config.slave = chosen.slave;
  config.rate = scenario.rate;
  config.activate = purpose == CellPurpose::kRun;
  return std::make_unique<RobotiqGripper>(config, clock);
}

std::unique_ptr<ForceTorqueSensor> ConnectWrist(const Scenario& scenario, const CellClock& clock) {
  const CellConfig::Wrist& chosen = scenario.cell.wrist;
  TT_CHECK(chosen.driver == "rdt");
  NetftConfig config;
  config.host = chosen.host;
  config.port = chosen.port;
  config.http_port = chosen.http_port;
  config.counts_per_N = chosen.counts_per_N;
  config.counts_per_Nm = chosen.counts_per_Nm;
  config.rate = scenario.rate;
  return std::make_unique<NetftSensor>(config, clock);
}

std::unique_ptr<Scanner> ConnectScanner(const Scenario& scenario, const std::string& folder,
                                        std::function<RigidTransform()> believed_X_NS) {
  const CellConfig::Scanner& chosen = scenario.cell.scanner;
  TT_CHECK(chosen.driver == "folder" || chosen.driver == "gige");
  ScannerLinkConfig config;
  config.driver = chosen.driver;
  config.host = chosen.host;
  config.path = (fs::path(folder) / chosen.path).lexically_normal().string();
  config.timeout_s = chosen.timeout_s;
  config.rate = scenario.rate;
  return ConnectScanner(config, std::move(believed_X_NS));
}

struct LiveCell::Impl {
  Impl(const Scenario& scenario, const std::string& scenario_folder, const std::string& cell_folder,
       CellPurpose purpose, Parallelism parallelism)
      : clock(scenario.rate) {
    Bin bin;
    if (scenario.cell.HasTwin()) {
      const Pile asked = ScenarioPile(scenario, scenario_folder);
      const RoundPhysics physics = ScenarioPhysics(scenario, asked.part);
      const Pile pile = StartPile(scenario, asked, physics);
      bin = pile.bin;
      twin.emplace(pile, ScenarioTwin(scenario, physics, parallelism));
    } else {
      bin = ScenarioBin(scenario, Bin().size_m, cell_folder);
    }
    const CellConfig& chosen = scenario.cell;
    if (!IsTwins(chosen.wrist.driver)) wrist = ConnectWrist(scenario, clock);
    if (!IsTwins(chosen.arm.driver)) arm = ConnectArm(scenario, Hc10(), clock, purpose);
    Arm& the_arm = arm ? *arm : twin->cell().arm;
    if (!IsTwins(chosen.scanner.driver)) {
      scanner = ConnectScanner(
          scenario, cell_folder,
          [&the_arm, X_NB = RigidTransform(bin.X_BN.inverse()),
           X_FS = ScenarioLayout(scenario).X_FS] {
            return RigidTransform(X_NB * FlangePose(Hc10(), the_arm.State().q) * X_FS);
          });
    }
    // Last: its activation moves the fingers, which none of the others does.
    if (!IsTwins(chosen.gripper.driver)) gripper = ConnectGripper(scenario, clock, purpose);
    if (twin) clock.Keep(*twin);
    cell.emplace(Cell{clock, the_arm, gripper ? *gripper : twin->cell().gripper,
                      wrist ? *wrist : twin->cell().wrist,
                      scanner ? *scanner : twin->cell().scanner, Hc10(), ScenarioLayout(scenario),
                      bin, ScenarioSafety(scenario)});
  }

  LiveClock clock;
  std::optional<TwinCell> twin;
  std::unique_ptr<Arm> arm;
  std::unique_ptr<Gripper> gripper;
  std::unique_ptr<ForceTorqueSensor> wrist;
  std::unique_ptr<Scanner> scanner;
  std::optional<Cell> cell;
};

LiveCell::LiveCell(const Scenario& scenario, const std::string& scenario_folder,
                   const std::string& cell_folder, CellPurpose purpose, Parallelism parallelism) {
  scenario.cell.ValidateOrThrow();
  if (purpose == CellPurpose::kRun) RequireArmed(scenario);
  impl_ = std::make_unique<Impl>(scenario, scenario_folder, cell_folder, purpose, parallelism);
}
LiveCell::~LiveCell() = default;
Cell& LiveCell::cell() { return *impl_->cell; }

Json LiveCell::Links() const {
  Json out = Json::object();
  if (const auto* gripper = dynamic_cast<const RobotiqGripper*>(impl_->gripper.get())) {
    out["gripper"] =
        Json{{"unanswered", gripper->unanswered()}, {"problem", gripper->LinkProblem()}};
  }
  if (const auto* wrist = dynamic_cast<const NetftSensor*>(impl_->wrist.get())) {
    const NetftSensor::Statistics s = wrist->statistics();
    out["wrist"] = Json{{"samples", s.samples},
                        {"lost", s.lost},
                        {"late", s.late},
                        {"malformed", s.malformed},
                        {"faulty", s.faulty}};
  }
  return out;
}

}  // namespace tubetwin
