// A device driver, complete: a wrist "sensor" that always reports the same force, for benches
// without one. hw_bridge/drivers/README.md explains it step by step.

#include "hw_bridge/drivers/registry.h"
#include "models/base/json.h"
#include "tests/support/catch.h"
#include "twin/live/live_cell.h"

namespace tubetwin {
namespace {

// 1. The device: what the pick cycle talks to.
class ConstantWrench : public ForceTorqueSensor {
 public:
  ConstantWrench(double force_N, const CellClock& clock) : force_N_(force_N), clock_(clock) {}
  WrenchSample Read() const override {
    WrenchSample sample;
    sample.time = clock_.Now();
    sample.wrench_K.force_N.z() = force_N_;
    return sample;
  }

 private:
  double force_N_;
  const CellClock& clock_;
};

// 2. The driver: its name, its keys in a cell file, and how the device is made.
class ConstantWrenchDriver : public DeviceDriver<ForceTorqueSensor> {
 public:
  std::unique_ptr<DeviceDriver> Clone() const override {
    return std::make_unique<ConstantWrenchDriver>(*this);
  }
  std::vector<DriverLink> Links() const override {
    return {{"constant", "nothing to check: it has no cable", ""}};
  }
  std::string Summary() const override { return "a constant force"; }
  void Visit(ConfigVisitor& v) override {
    v.Section("constant", "the driver 'constant'", [this](ConfigVisitor& own) {
      own.Field("force_N", "force along the tool", force_N_, {-100, 100});
    });
  }
  std::unique_ptr<ForceTorqueSensor> Connect(const std::string&,
                                             const DriverContext& context) const override {
    return std::make_unique<ConstantWrench>(force_N_, context.clock);
  }

 private:
  double force_N_ = 0.0;
};

// 3. The registry line. A driver that belongs to this program has it in registry.cc.
DeviceDrivers ExampleDrivers() {
  DeviceDrivers drivers = BuiltInDrivers();
  drivers.wrist.Add<ConstantWrenchDriver>();
  return drivers;
}

/// The scenario of a cell file's text, with those drivers to choose from.
Scenario ScenarioWith(const DeviceDrivers& drivers, const std::string& cell_file) {
  Scenario scenario;
  scenario.cell = CellConfig(drivers);
  ConfigSource source;
  source.AddText(cell_file, "cell.toml");
  source.ReadInto(scenario);
  return scenario;
}

}  // namespace

TEST_CASE("A driver of one's own serves its role in a cell of which the rest is the twin's",
          "[unit]") {
  Scenario scenario = ScenarioWith(ExampleDrivers(),
                                   "[cell.wrist]\n"
                                   "driver = 'constant'\n"
                                   "constant.force_N = -7.5\n");
  scenario.pile.count = 1;
  LiveCell live(scenario, CellPurpose::kLook, {1});
  Cell& cell = live.cell();
  CHECK(cell.wrist.Read().wrench_K.force_N.z() == -7.5);
  cell.clock.AdvanceTo(cell.clock.Now() + FromSeconds(0.01));
  CHECK(cell.wrist.Read().time >= FromSeconds(0.01));
  CHECK(live.Links().empty());
}

TEST_CASE("A registered driver's name and keys are those that a cell file may use", "[unit]") {
  const std::string wrong = "[cell.wrist]\ndriver = 'constance'\n";
  CHECK_THROWS_WITH(ScenarioWith(ExampleDrivers(), wrong),
                    Catch::Contains("allowed are twin, rdt, constant, replay"));
  CHECK_THROWS_WITH(ScenarioWith(BuiltInDrivers(), wrong),
                    Catch::Contains("allowed are twin, rdt, replay"));
  CHECK_THROWS_WITH(ScenarioWith(BuiltInDrivers(), "[cell.wrist]\nconstant.force_N = 1\n"),
                    Catch::Contains("unknown"));
}

TEST_CASE("Copies of a cell's configuration keep their own values", "[unit]") {
  const Scenario one = ScenarioWith(ExampleDrivers(), "[cell.wrist]\nconstant.force_N = 1\n");
  Scenario two = one;
  ConfigSource source;
  source.AddOverride("cell.wrist.constant.force_N=2");
  source.ReadInto(two);
  const auto text = [](Scenario scenario) {
    return WriteToml([&](ConfigVisitor& v) { scenario.Visit(v); }, false);
  };
  CHECK_THAT(text(one), Catch::Contains("[cell.wrist.constant]\nforce_N = 1.0"));
  CHECK_THAT(text(two), Catch::Contains("[cell.wrist.constant]\nforce_N = 2.0"));
}

}  // namespace tubetwin
