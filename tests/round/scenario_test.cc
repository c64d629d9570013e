#include "twin/round/scenario.h"

#include "tests/support/catch.h"

namespace tubetwin {
namespace {

TEST_CASE("The paper's profile changes defaults, a layer still wins over it", "[unit]") {
  ConfigSource source;
  source.AddOverride("profile=leao2020");
  source.AddOverride("planner.samples=5");
  const Scenario scenario = ReadScenario(source);
  CHECK(scenario.profile == "leao2020");
  CHECK(scenario.perception.profile == "leao2020");
  CHECK(scenario.planner.classes == "occluded_joints");
  CHECK(scenario.planner.samples == 5);
  CHECK(scenario.planner.weight_extra == 0.0);
  CHECK(scenario.planner.max_candidates == 1000);
  CHECK(scenario.resolution.strategy == "plus45");
  CHECK(scenario.cycle.tolerance_share == 0.5);
}

TEST_CASE("The paper's profile nudges no tube, whatever a layer says", "[unit]") {
  ConfigSource source;
  CHECK(ReadScenario(source).planner.nudges == 2);
  CHECK(ReadScenario(source, "leao2020").planner.nudges == 0);
  source.AddOverride("planner.nudges=1");
  CHECK(ReadScenario(source, "best").planner.nudges == 1);
  CHECK_THROWS_WITH(ReadScenario(source, "leao2020"),
                    Catch::Matchers::Contains("planner.nudges is 1; only 0 is allowed"));
}

TEST_CASE("The tolerance of success has defaults, and bad values are refused by what is allowed",
          "[unit]") {
  ConfigSource none;
  CHECK(ReadScenario(none).success.position_mm == 20.0);
  CHECK(ReadScenario(none).success.yaw_deg == 10.0);
  const auto refused = [](const std::string& text, const std::string& said) {
    ConfigSource source;
    source.AddText(text, "S.toml");
    CHECK_THROWS_WITH(ReadScenario(source), Catch::Matchers::Contains(said));
  };
  refused("[success]\nposition_mm = -1\n", "S.toml:2:15: success.position_mm: is -1, allowed");
  refused("[success]\nyaw_deg = 91\n", "S.toml:2:11: success.yaw_deg: is 91, allowed");
  refused("[success]\nyaw_deg = \"ten\"\n", "success.yaw_deg");
  refused("[success]\nposition_m = 0.02\n", "nearest known is 'success.position_mm'");
}

TEST_CASE("The profile of the command line wins, and the default is best", "[unit]") {
  ConfigSource source;
  CHECK(ReadScenario(source).perception.profile == "best");
  source.AddOverride("profile=leao2020");
  CHECK(ReadScenario(source, "best").perception.profile == "best");
  CHECK(ReadScenario(source, "best").profile == "best");
}

TEST_CASE("A resolved scenario of a profile reads back the same", "[unit]") {
  ConfigSource source;
  source.AddOverride("profile=leao2020");
  Scenario scenario = ReadScenario(source);
  const auto text = [](Scenario& s) {
    return WriteToml([&s](ConfigVisitor& v) { s.Visit(v); }, false);
  };
  ConfigSource again;
  again.AddText(text(scenario), "resolved");
  Scenario read = ReadScenario(again);
  CHECK(text(read) == text(scenario));
}

}  // namespace
}  // namespace tubetwin
