// Drives the arm to where a round may begin.

#include <CLI/CLI.hpp>

#include "hw_bridge/drivers/device_lock.h"
#include "models/base/text.h"
#include "twin/app/arm_to_move.h"
#include "twin/app/ask.h"
#include "twin/app/common.h"
#include "twin/live/home.h"
#include "twin/live/live_cell.h"

namespace tubetwin {
namespace {

struct HomeOptions {
  std::string cell;
  bool yes = false;
};

int RunHome(const HomeOptions& home, const Common& common) {
  const Scenario scenario = LoadCellToMove(home.cell, "home", common);
  const CellConfig::Arm& role = scenario.cell.arm;
  const DeviceLock lock(DeviceToOwn("arm", role));
  const SafetyLimits safety = ScenarioSafety(scenario);
  const std::string speed =
      safety.start_speed_m_s > 0.0 ? Number(safety.start_speed_m_s) + " m/s" : "planned speed";
  RequireWord({"home", "the arm may move",
               "The arm at " + role.Chosen().Address() +
                   " will go to over the bin's middle, E no faster than " + speed +
                   "; it keeps clear of what the cell model knows of, and of nothing else.",
               "move"},
              home.yes);
  // Everything else is only read: the fingers stay as they are.
  LiveCell live(scenario, CellPurpose::kLook, common.parallelism());
  Cell& look = live.cell();
  const auto arm =
      role.Connect(ScenarioContext(scenario, look.model, look.clock, CellPurpose::kRun));
  Cell cell{look.clock, *arm, look.gripper, look.wrist, look.scanner, look.model, look.bin, safety};
  cell.stop_at_once = StopOnSignals();
  const JointVector q = DriveHome(cell, LoadPart(ScenarioPartName(scenario)).mass_kg);
  PrintJoints(q, common);
  return 0;
}

}  // namespace

void AddHomeVerb(CLI::App& app, Common& common) {
  auto home = std::make_shared<HomeOptions>();
  CLI::App* verb = app.add_subcommand(
      "home",
      "Example: tubetwin home --cell cell.toml\n\nDrives an armed arm to over the bin's middle at "
      "carry height, at start speed, keeping clear of all that the cell model knows of. Asks "
      "first; refuses while the fingers may hold something.");
  verb->add_option("--cell", home->cell, "Cell file (TOML)")->required();
  verb->add_flag("--yes", home->yes, "Do not ask: whoever wrote it sees the arm");
  AddCommonOptions(*verb, common, {"cell", "calibration", "bin", "scan", "pile", "part", "rate"},
                   "", false);
  verb->callback(
      [home, &common] { common.action = [home, &common] { return RunHome(*home, common); }; });
}

}  // namespace tubetwin
