#include "twin/live/emulated_cell.h"

#include <chrono>
#include <optional>
#include <thread>

#include "hw_bridge/drivers/ati/netft_driver.h"
#include "hw_bridge/drivers/photoneo/photoneo_driver.h"
#include "hw_bridge/drivers/robotiq/robotiq_driver.h"
#include "hw_bridge/drivers/yaskawa/yaskawa_driver.h"
#include "hw_bridge/emulators/photoneo/scanner_gige_emulator.h"
#include "models/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"
#include "tests/support/temporary_folder.h"
#include "twin/live/fault_script.h"
#include "twin/live/live_cell.h"
#include "twin/round/twin_setup.h"

namespace tubetwin {
namespace {

/// An emulated cell with one tube and no client.
struct Bench {
  explicit Bench(const std::string& listen = "127.0.0.1", bool gige = false) {
    scenario.pile.count = 1;
    const Pile pile = ScenarioPile(scenario);
    twin.emplace(pile, ScenarioTwin(scenario, ScenarioPhysics(scenario, pile.part), {1}));
    cell.emplace(*twin, scenario, EmulationPlaces{listen, true, folder.path(), gige});
  }
  TemporaryFolder folder;
  Scenario scenario;
  std::optional<TwinCell> twin;
  std::optional<EmulatedCell> cell;
};

}  // namespace

TEST_CASE("A scripted fault begins at its time or moment and is undone after its duration",
          "[unit]") {
  Bench bench;
  ScriptedFault timed;
  timed.at_s = 0.010;
  timed.for_s = 0.005;
  timed.device = "arm.state";
  timed.action = "freeze";
  ScriptedFault at_moment;
  at_moment.on = "scan";
  at_moment.nth = 2;
  at_moment.delay_s = 0.003;
  at_moment.device = "arm";
  at_moment.action = "emergency_stop";
  FaultScript script({timed, at_moment});
  std::vector<std::string> said;
  for (int ms = 1; ms <= 30; ++ms) {
    bench.cell->Step();
    if (ms == 18 || ms == 20) script.Hear("scan", bench.cell->now());
    for (const std::string& line : script.Act(*bench.cell, bench.cell->now())) {
      said.push_back(std::to_string(ms) + " " + line);
    }
    CHECK(bench.cell->arm().state_link().freeze == (ms >= 10 && ms < 15));
    CHECK(bench.cell->arm().controller().emergency_stop() == (ms >= 23));
  }
  CHECK(said == std::vector<std::string>{"10 arm.state freeze", "15 arm.state freeze undone",
                                         "23 arm emergency_stop"});
  CHECK(script.done() == 2);
}

TEST_CASE("Every action can be done and undone at any time", "[unit]") {
  Bench bench;
  for (const std::string& device : FaultDevices()) {
    for (const std::string& action : FaultActions(device)) {
      CAPTURE(device, action);
      ScriptedFault fault;
      fault.device = device;
      fault.action = action;
      fault.value = device == "gripper" ? 9 : action == "refuse" ? 3011 : 1;
      ApplyFault(*bench.cell, fault, false);
      for (int i = 0; i < 3; ++i) bench.cell->Step();
      ApplyFault(*bench.cell, fault, true);
      for (int i = 0; i < 3; ++i) bench.cell->Step();
    }
  }
  CHECK_FALSE(bench.cell->arm().motion_link().freeze);
  CHECK_FALSE(bench.cell->arm().controller().emergency_stop());
}

TEST_CASE("A cell file arms the arm of a loopback address only, and names every port", "[unit]") {
  {
    Bench bench;
    const Scenario reaching = bench.cell->Reaching();
    CHECK(reaching.cell.arm.armed);
    CHECK(reaching.cell.arm.drivers.Get<YaskawaDriver>().config.host == "127.0.0.1");
    CHECK(reaching.cell.arm.drivers.Get<YaskawaDriver>().config.motion_port ==
          bench.cell->arm().motion_port());
    CHECK(reaching.cell.gripper.drivers.Get<RobotiqDriver>().config.port ==
          bench.cell->gripper().port());
    CHECK(reaching.cell.wrist.drivers.Get<NetftDriver>().config.port == bench.cell->wrist().port());
    CHECK_FALSE(reaching.cell.HasTwin());
  }
  Bench bench("0.0.0.0");
  CHECK_FALSE(bench.cell->Reaching().cell.arm.armed);
}

TEST_CASE("GigE Vision is served when it is asked for, and not otherwise", "[unit]") {
  Bench folder;
  CHECK(folder.cell->Reaching().cell.scanner.driver == "folder");
  CHECK_FALSE(
      folder.cell->Reaching().cell.scanner.drivers.Get<PhotoneoDriver>().config.path.empty());
  {  // Whoever can have the port sees that nobody else has it.
    const ScannerGigeEmulator other(folder.twin->cell().scanner, {});
    try {
      const Bench taken("127.0.0.1", true);
      FAIL("no error");
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::kDevice);
      CHECK_THAT(error.what(), Catch::Contains("cannot listen on 127.0.0.1:3956, UDP"));
    }
  }
  Bench bench("127.0.0.1", true);
  CellConfig::Scanner chosen = bench.cell->Reaching().cell.scanner;
  CHECK(chosen.driver == "gige");
  CHECK(chosen.drivers.Get<PhotoneoDriver>().config.host == "127.0.0.1");
  CHECK(chosen.drivers.Get<PhotoneoDriver>().config.path.empty());
  CHECK_NOTHROW(bench.cell->Reaching().cell.ValidateOrThrow());
  chosen.drivers.Get<PhotoneoDriver>().config.timeout_s = 25.0;
  DriverContext context =
      ScenarioContext(bench.scenario, PaperCell(), bench.twin->cell().clock, CellPurpose::kLook);
  context.believed_X_NS = [] { return RigidTransform::Identity(); };
  const auto driver = chosen.Connect(context);
  REQUIRE(driver->Trigger().accepted());
  for (int i = 0; i < 20000 && driver->Status() == ScanStatus::kBusy; ++i) {
    bench.cell->Step();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  INFO(driver->FailureReason());
  REQUIRE(driver->Status() == ScanStatus::kReady);
  const OrganizedCloud cloud = driver->Take();
  CHECK(cloud.width == 1032);
  CHECK(cloud.height == 772);
  CHECK(bench.cell->scanner().triggers() == 1);
}

}  // namespace tubetwin
