#include "twin/live/live_cell.h"

#include <optional>
#include <vector>

#include "hw_bridge/drivers/device_lock.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "twin/cell/twin_cell.h"
#include "twin/live/kept_devices.h"
#include "twin/live/live_clock.h"
#include "twin/round/twin_setup.h"

namespace tubetwin {
namespace {

/// How long the twin's arm may take to come where the real one stands, and how near.
constexpr double kShadow_s = 30.0, kShadowed_rad = 0.005;

/// Only one program may use a device. Without leave to move anything an arm is only watched, which
/// more than one may.
std::vector<DeviceLock> LockDevices(const CellConfig& cell, CellPurpose purpose) {
  std::vector<DeviceLock> locks;
  const auto lock = [&locks](const char* role, const auto& chosen) {
    const std::string device = DeviceToOwn(role, chosen);
    if (!device.empty()) locks.emplace_back(device);
  };
  if (purpose == CellPurpose::kRun) lock("arm", cell.arm);
  lock("gripper", cell.gripper);
  lock("wrist", cell.wrist);
  lock("scanner", cell.scanner);
  return locks;
}

}  // namespace

void RequireArmed(const Scenario& scenario) {
  const CellConfig::Arm& arm = scenario.cell.arm;
  if (!arm.IsDevice() || arm.armed) return;
  const std::string address = arm.Chosen().Address();
  throw Error(ErrorKind::kConfig,
              "cell.arm.armed: is false; the arm " +
                  (address.empty() ? "" : "at " + address + " ") +
                  "is not the twin's and moves only when a person who has checked the cell "
                  "writes armed = true into [cell.arm]; nothing was sent (see also --dry-run)");
}

DriverContext ScenarioContext(const Scenario& scenario, const CellModel& model,
                              const CellClock& clock, CellPurpose purpose) {
  return {model, clock, scenario.rate, purpose == CellPurpose::kRun, {}, {}};
}

struct LiveCell::Impl {
  Impl(const Scenario& scenario, CellPurpose purpose, Parallelism parallelism,
       const LiveCell::Confirm& confirm)
      : devices(scenario.cell),
        locks(LockDevices(scenario.cell, purpose)),
        clock(scenario.rate),
        model(ScenarioModel(scenario)) {
    Bin bin;
    if (scenario.cell.HasTwin()) {
      const Pile asked = ScenarioPile(scenario);
      const RoundPhysics physics = ScenarioPhysics(scenario, asked.part);
      const Pile pile = StartPile(scenario, asked, physics);
      bin = pile.bin;
      twin.emplace(pile, ScenarioTwin(scenario, physics, parallelism));
    } else {
      bin = ScenarioBin(scenario, std::nullopt);
    }
    DriverContext context = ScenarioContext(scenario, model, clock, purpose);
    context.confirm = confirm;
    if (devices.wrist.IsDevice()) wrist = devices.wrist.Connect(context);
    if (devices.arm.IsDevice()) arm = devices.arm.Connect(context);
    if (twin) Keep(twin->cell());
    Arm& the_arm = arm ? *arm : *kept_arm;
    context.believed_X_NS = [&the_arm, this, X_NB = RigidTransform(bin.X_BN.inverse())] {
      return RigidTransform(X_NB * PoseOfScanner(model, the_arm.State().q));
    };
    if (devices.scanner.IsDevice()) scanner = devices.scanner.Connect(context);
    // Last: its activation moves the fingers, which none of the others does.
    if (devices.gripper.IsDevice()) gripper = devices.gripper.Connect(context);
    if (twin) Live();
    cell.emplace(Cell{clock, the_arm, gripper ? *gripper : *kept_gripper,
                      wrist ? *wrist : *kept_wrist, scanner ? *scanner : *kept_scanner, model, bin,
                      ScenarioSafety(scenario)});
  }

  void Keep(Cell& twins) {
    kept_arm.emplace(twins.arm, clock);
    kept_gripper.emplace(twins.gripper, clock);
    kept_wrist.emplace(twins.wrist, clock);
    kept_scanner.emplace(twins.scanner, clock);
  }

  /// From here on the twin keeps up with the wall; its arm stands where a real one does.
  void Live() {
    CellClock& twins = twin->cell().clock;
    if (!arm) return clock.Keep(twins, {});
    shadow.emplace(*arm, twin->servo_arm());
    const TimeNs end = twins.Now() + FromSeconds(kShadow_s);
    while (shadow->Off_rad() > kShadowed_rad) {
      if (twins.Now() >= end) {
        throw Error(ErrorKind::kDevice,
                    "the twin of the arm does not come to where the arm stands within 30 s");
      }
      shadow->Follow();
      twins.AdvanceTo(twins.Now() + kControlPeriod);
    }
    clock.Keep(twins, [this] { shadow->Follow(); });
  }

  CellConfig devices;
  std::vector<DeviceLock> locks;
  LiveClock clock;
  CellModel model;
  std::optional<TwinCell> twin;
  std::unique_ptr<Arm> arm;
  std::unique_ptr<Gripper> gripper;
  std::unique_ptr<ForceTorqueSensor> wrist;
  std::unique_ptr<Scanner> scanner;
  std::optional<KeptArm> kept_arm;
  std::optional<KeptGripper> kept_gripper;
  std::optional<KeptWrist> kept_wrist;
  std::optional<KeptScanner> kept_scanner;
  std::optional<ShadowArm> shadow;
  std::optional<Cell> cell;
};

LiveCell::LiveCell(const Scenario& scenario, CellPurpose purpose, Parallelism parallelism,
                   const Confirm& confirm) {
  scenario.cell.ValidateOrThrow();
  if (purpose == CellPurpose::kRun) RequireArmed(scenario);
  impl_ = std::make_unique<Impl>(scenario, purpose, parallelism, confirm);
}
LiveCell::~LiveCell() = default;
Cell& LiveCell::cell() { return *impl_->cell; }

Json LiveCell::Links() const {
  Json out = Json::object();
  const auto count = [&out](const char* role, const auto& chosen, const auto& device) {
    Json counts;
    if (device) chosen.Chosen().CountLink(*device, counts);
    if (!counts.is_null()) out[role] = std::move(counts);
  };
  count("arm", impl_->devices.arm, impl_->arm);
  count("gripper", impl_->devices.gripper, impl_->gripper);
  count("wrist", impl_->devices.wrist, impl_->wrist);
  count("scanner", impl_->devices.scanner, impl_->scanner);
  return out;
}

}  // namespace tubetwin
