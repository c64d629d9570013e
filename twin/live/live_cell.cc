#include "twin/live/live_cell.h"

#include <algorithm>
#include <optional>

#include "hw_bridge/cell/wall_clock.h"
#include "models/base/error.h"
#include "models/base/json.h"
#include "twin/cell/twin_cell.h"
#include "twin/round/twin_setup.h"

namespace tubetwin {
namespace {

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
  return {model, clock, scenario.rate, purpose == CellPurpose::kRun, {}};
}

struct LiveCell::Impl {
  Impl(const Scenario& scenario, CellPurpose purpose, Parallelism parallelism)
      : devices(scenario.cell), clock(scenario.rate), model(ScenarioModel(scenario)) {
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
    if (devices.wrist.IsDevice()) wrist = devices.wrist.Connect(context);
    if (devices.arm.IsDevice()) arm = devices.arm.Connect(context);
    Arm& the_arm = arm ? *arm : twin->cell().arm;
    context.believed_X_NS = [&the_arm, this, X_NB = RigidTransform(bin.X_BN.inverse())] {
      return RigidTransform(X_NB * PoseOfScanner(model, the_arm.State().q));
    };
    if (devices.scanner.IsDevice()) scanner = devices.scanner.Connect(context);
    // Last: its activation moves the fingers, which none of the others does.
    if (devices.gripper.IsDevice()) gripper = devices.gripper.Connect(context);
    if (twin) clock.Keep(*twin);
    cell.emplace(Cell{clock, the_arm, gripper ? *gripper : twin->cell().gripper,
                      wrist ? *wrist : twin->cell().wrist,
                      scanner ? *scanner : twin->cell().scanner, model, bin,
                      ScenarioSafety(scenario)});
  }

  CellConfig devices;
  LiveClock clock;
  CellModel model;
  std::optional<TwinCell> twin;
  std::unique_ptr<Arm> arm;
  std::unique_ptr<Gripper> gripper;
  std::unique_ptr<ForceTorqueSensor> wrist;
  std::unique_ptr<Scanner> scanner;
  std::optional<Cell> cell;
};

LiveCell::LiveCell(const Scenario& scenario, CellPurpose purpose, Parallelism parallelism) {
  scenario.cell.ValidateOrThrow();
  if (purpose == CellPurpose::kRun) RequireArmed(scenario);
  impl_ = std::make_unique<Impl>(scenario, purpose, parallelism);
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
