#include "twin/live/emulated_cell.h"

#include <filesystem>
#include <utility>

#include <asio.hpp>

#include "hw_bridge/drivers/ati/netft_driver.h"
#include "hw_bridge/drivers/photoneo/photoneo_driver.h"
#include "hw_bridge/drivers/robotiq/robotiq_driver.h"
#include "hw_bridge/drivers/yaskawa/yaskawa_driver.h"
#include "hw_bridge/emulators/photoneo/scanner_folder_emulator.h"
#include "hw_bridge/emulators/photoneo/scanner_gige_emulator.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

ArmEmulatorConfig ArmAt(const YaskawaConfig& arm, const EmulationPlaces& places) {
  ArmEmulatorConfig config;
  config.listen = places.listen;
  config.motion_port = places.any_ports ? 0 : arm.motion_port;
  config.state_port = places.any_ports ? 0 : arm.state_port;
  config.io_port = places.any_ports ? 0 : arm.io_port;
  config.hses_port = places.any_ports ? 0 : arm.hses_port;
  config.pulses_per_degree = arm.pulses_per_degree;
  config.server = arm.server == "strict" ? ArmServer::kStrict : ArmServer::kMotoRos1;
  return config;
}

GripperEmulatorConfig GripperAt(const CellConfig& cell, const CellModel& model,
                                const EmulationPlaces& places) {
  const RobotiqConfig& gripper = cell.gripper.drivers.Get<RobotiqDriver>().config;
  GripperEmulatorConfig config;
  config.listen = places.listen;
  config.port = places.any_ports ? 0 : gripper.port;
  config.slave = gripper.slave;
  config.action_start = gripper.action_start;
  config.status_start = gripper.status_start;
  config.scale = ScaleOf(model.gripper);
  if (cell.gripper.driver == "modbus_rtu") {
    config.transport = "rtu";
    config.device = (fs::path(places.folder) / "gripper.tty").string();
  }
  return config;
}

WristEmulatorConfig WristAt(const NetftConfig& wrist, const CellModel& model,
                            const EmulationPlaces& places) {
  WristEmulatorConfig config;
  config.listen = places.listen;
  config.port = places.any_ports ? 0 : wrist.port;
  config.http_port = places.any_ports ? 0 : wrist.http_port;
  config.counts_per_N = wrist.counts_per_N;
  config.counts_per_Nm = wrist.counts_per_Nm;
  config.range = model.wrist.range;
  return config;
}

std::string ScanFolder(const EmulationPlaces& places) {
  return (fs::path(places.folder) / "scans").string();
}

std::unique_ptr<ScannerEmulator> ScannerAt(Scanner& scanner, const Scenario& scenario,
                                           const EmulationPlaces& places) {
  if (!places.gige) {
    ScannerFolderConfig config;
    config.path = ScanFolder(places);
    return std::make_unique<ScannerFolderEmulator>(scanner, config);
  }
  const ScanSettings scan = ScenarioScan(scenario, ScenarioModel(scenario), RoundPhysics());
  ScannerGigeConfig config{places.listen, scan.width, scan.height, {}};
  config.optics.focal_px = scan.spec.focal_px * scan.width / scan.spec.full_width;
  config.optics.sweet_spot_m = scan.spec.sweet_spot_m;
  config.optics.sigma_m = scan.spec.sigma_m;
  return std::make_unique<ScannerGigeEmulator>(scanner, config);
}

}  // namespace

struct EmulatedCell::Impl {
  Impl(TwinCell& of, const Scenario& given, const EmulationPlaces& at)
      : twin(of),
        scenario(given),
        places(at),
        arm(io, twin.servo_arm(), twin.cell().model.arm,
            ArmAt(given.cell.arm.drivers.Get<YaskawaDriver>().config, at)),
        gripper(io, twin.cell().gripper, GripperAt(given.cell, twin.cell().model, at)),
        wrist(io, twin.cell().wrist,
              WristAt(given.cell.wrist.drivers.Get<NetftDriver>().config, twin.cell().model, at)),
        scanner(ScannerAt(twin.cell().scanner, given, at)),
        moments(twin.cell().model, twin.cell().bin) {}

  void Look() {
    const bool moves = arm.controller().moving();
    if (moves != moved && hear) hear(moves ? "arm moves" : "arm rests");
    moved = moves;
    CycleMoments::Look look;
    look.q = twin.servo_arm().Servo().q;
    look.fingers = twin.cell().gripper.State();
    look.fingers_in_use = gripper.controller().Status().activation == GripperActivation::kDone;
    look.scans = scanner->triggers();
    for (const std::string& moment : moments.After(look)) {
      if (hear) hear(moment);
    }
  }

  TwinCell& twin;
  Scenario scenario;
  EmulationPlaces places;
  asio::io_context io;
  ArmEmulator arm;
  GripperEmulator gripper;
  WristEmulator wrist;
  std::unique_ptr<ScannerEmulator> scanner;
  CycleMoments moments;
  std::function<void(const std::string&)> hear;
  bool moved = false;
};

EmulatedCell::EmulatedCell(TwinCell& twin, const Scenario& scenario, const EmulationPlaces& places)
    : impl_(std::make_unique<Impl>(twin, scenario, places)) {}
EmulatedCell::~EmulatedCell() = default;

void EmulatedCell::Poll() {
  impl_->io.restart();
  impl_->io.poll();
}

void EmulatedCell::Step() {
  Poll();
  CellClock& clock = impl_->twin.cell().clock;
  clock.AdvanceTo(clock.Now() + kControlPeriod);
  const TimeNs now = clock.Now();
  for (Emulator* emulator :
       {static_cast<Emulator*>(&impl_->arm), static_cast<Emulator*>(&impl_->gripper),
        static_cast<Emulator*>(&impl_->wrist), static_cast<Emulator*>(impl_->scanner.get())}) {
    emulator->Tick(now);
  }
  impl_->Look();
}

TimeNs EmulatedCell::now() const { return impl_->twin.cell().clock.Now(); }

void EmulatedCell::OnMoment(std::function<void(const std::string&)> hear) {
  impl_->hear = std::move(hear);
}

ArmEmulator& EmulatedCell::arm() { return impl_->arm; }
GripperEmulator& EmulatedCell::gripper() { return impl_->gripper; }
WristEmulator& EmulatedCell::wrist() { return impl_->wrist; }
ScannerEmulator& EmulatedCell::scanner() { return *impl_->scanner; }

Scenario EmulatedCell::Reaching() const {
  Scenario out = impl_->scenario;
  CellConfig& cell = out.cell;
  // A loopback address is this emulation and nothing else; no other arm is armed by a program.
  const bool loopback = asio::ip::make_address(impl_->places.listen).is_loopback();
  cell.arm.driver = "simple_message";
  cell.arm.armed = loopback;
  YaskawaConfig& arm = cell.arm.drivers.Get<YaskawaDriver>().config;
  arm.motion_port = impl_->arm.motion_port();
  arm.state_port = impl_->arm.state_port();
  arm.io_port = impl_->arm.io_port();
  arm.hses_port = impl_->arm.hses_port();
  RobotiqConfig& gripper = cell.gripper.drivers.Get<RobotiqDriver>().config;
  if (cell.gripper.driver == "modbus_rtu") {
    gripper.device = impl_->gripper.device();
  } else {
    cell.gripper.driver = "modbus_tcp";
    gripper.port = impl_->gripper.port();
  }
  cell.wrist.driver = "rdt";
  NetftConfig& wrist = cell.wrist.drivers.Get<NetftDriver>().config;
  wrist.port = impl_->wrist.port();
  wrist.http_port = impl_->wrist.http_port();
  cell.scanner.driver = impl_->places.gige ? "gige" : "folder";
  ScannerLinkConfig& scanner = cell.scanner.drivers.Get<PhotoneoDriver>().config;
  scanner.path = impl_->places.gige ? "" : ScanFolder(impl_->places);
  arm.host = gripper.host = wrist.host = scanner.host = impl_->places.listen;
  return out;
}

}  // namespace tubetwin
