#include "twin/live/activate_gripper.h"

#include "hw_bridge/cell/left_over.h"
#include "hw_bridge/cell/wall_clock.h"
#include "hw_bridge/drivers/device_lock.h"
#include "models/base/error.h"
#include "twin/live/live_cell.h"

namespace tubetwin {
namespace {

/// What hangs in the fingers by the word of the wrist, where arm and wrist are devices.
std::string LeftByWrist(const Scenario& scenario, const DriverContext& look) {
  const CellConfig& cell = scenario.cell;
  if (!cell.arm.IsDevice() || !cell.wrist.IsDevice()) return {};
  const auto wrist = cell.wrist.Connect(look);
  const auto arm = cell.arm.Connect(look);
  return LeftOnWrist(wrist->Read(), arm->State().q, look.model, ScenarioSafety(scenario),
                     LoadPart(ScenarioPartName(scenario)).mass_kg);
}

}  // namespace

ActivatedGripper ActivateGripper(const Scenario& scenario,
                                 const std::function<void(const std::string&)>& ask,
                                 const std::function<bool(const std::string&)>& confirm) {
  scenario.cell.ValidateOrThrow();
  const auto& role = scenario.cell.gripper;
  if (!role.IsDevice()) {
    throw Error(ErrorKind::kConfig, "cell.gripper.driver: is '" + role.driver +
                                        "', which needs no activation; allowed is a cell file "
                                        "with a device");
  }
  const WallClock clock(scenario.rate);
  const CellModel model = ScenarioModel(scenario);
  const DriverContext look = ScenarioContext(scenario, model, clock, CellPurpose::kLook);
  const DeviceLock lock(DeviceToOwn("gripper", role));
  std::optional<DeviceLock> wrist_lock;
  if (scenario.cell.wrist.IsDevice()) wrist_lock.emplace(DeviceToOwn("wrist", scenario.cell.wrist));
  ActivatedGripper out;
  out.before = role.Connect(look)->State();
  if (out.before.activated) return {out.before, out.before};
  std::string held = LeftInFingers(out.before);
  if (held.empty()) held = LeftByWrist(scenario, look);
  if (!held.empty()) {
    throw Error(ErrorKind::kDevice, held +
                                        ": activation opens the fingers; take it out first; "
                                        "nothing was moved");
  }
  ask(role.Chosen().Address());
  DriverContext move = ScenarioContext(scenario, model, clock, CellPurpose::kRun);
  move.confirm = confirm;
  out.after = role.Connect(move)->State();
  return out;
}

}  // namespace tubetwin
