#include "hw_bridge/drivers/ati/netft_sensor.h"

#include <memory>

#include "hw_bridge/drivers/ati/http_get.h"
#include "models/base/error.h"
#include "tests/drivers/served.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

NetftConfig To(ServedWrist& served) {
  NetftConfig config;
  config.host = "127.0.0.1";
  config.port = served.port();
  config.http_port = served.http_port();
  config.rate = kServedRate;
  return config;
}

void Load(ServedWrist& served, double force_N) {
  served.With([&](auto&, SetWrist& sensor) {
    sensor.sample.wrench_K.force_N = {1.5, -2.5, force_N};
    sensor.sample.wrench_K.torque_Nm = {0.1, -0.2, 0.05};
  });
}

struct Bench {
  Bench() { Load(served, 10.0); }
  bool EventuallyReads(double force_N) {
    return Eventually([&] { return driver.Read().wrench_K.force_N.z() == force_N; });
  }
  RunningClock clock{kServedRate};
  ServedWrist served;
  NetftSensor driver{To(served), clock};
};

TEST_CASE("The newest sample is what the box measures", "[unit]") {
  Bench bench;
  CHECK(bench.EventuallyReads(10.0));
  const WrenchSample sample = bench.driver.Read();
  CHECK(sample.wrench_K.force_N == Vector3(1.5, -2.5, 10.0));
  CHECK(sample.wrench_K.torque_Nm == Vector3(0.1, -0.2, 0.05));
  CHECK_FALSE(sample.saturated);
  CHECK(sample.time <= bench.clock.Now());
  Load(bench.served, -3.25);
  CHECK(bench.EventuallyReads(-3.25));
  CHECK(bench.driver.Read().time > sample.time);
  CHECK(bench.driver.statistics().malformed == 0);
  CHECK(bench.driver.statistics().late == 0);
}

TEST_CASE("Counts are those of the box, when the cell file has them too", "[unit]") {
  WristEmulatorConfig coarse;
  coarse.counts_per_N = 20.0;
  coarse.counts_per_Nm = 333.33;
  ServedWrist served(coarse);
  Load(served, 10.0);
  const RunningClock clock(kServedRate);
  NetftConfig config = To(served);
  try {
    const NetftSensor driver(config, clock);
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kConfig);
    CHECK_THAT(error.what(), Contains("its page says 20, cell.wrist.counts_per_N is 1e+06"));
  }
  config.counts_per_N = 20.0;
  config.counts_per_Nm = 333.33;
  const NetftSensor driver(config, clock);
  CHECK(Eventually([&] { return driver.Read().wrench_K.force_N.z() == 10.0; }));
  config.http_port = 0;  // Believed.
  config.counts_per_N = 10.0;
  const NetftSensor other(config, clock);
  CHECK(Eventually([&] { return other.Read().wrench_K.force_N.z() == 20.0; }));
}

TEST_CASE("Gaps, doubles and damage are counted", "[unit]") {
  Bench bench;
  SECTION("a gap") {
    bench.served.With([](WristEmulator& emulator, auto&) { emulator.SkipSequence(100); });
    CHECK(Eventually([&] { return bench.driver.statistics().lost == 100; }));
  }
  SECTION("doubles") {
    bench.served.With([](WristEmulator& emulator, auto&) { emulator.link().duplicate = true; });
    CHECK(Eventually([&] { return bench.driver.statistics().late > 10; }));
    CHECK(bench.driver.statistics().lost == 0);
  }
  SECTION("damage") {
    bench.served.With([](WristEmulator& emulator, auto&) { emulator.link().corrupt = true; });
    CHECK(Eventually([&] { return bench.driver.statistics().malformed > 10; }));
    bench.served.With([](WristEmulator& emulator, auto&) { emulator.link().corrupt = false; });
    CHECK(Eventually([&] { return bench.driver.statistics().lost > 10; }));
  }
  Load(bench.served, 7.0);
  CHECK(bench.EventuallyReads(7.0));
}

TEST_CASE("Saturation is told, a latched threshold is not, a fault is no sample", "[unit]") {
  Bench bench;
  bench.served.With([](auto&, SetWrist& sensor) { sensor.sample.saturated = true; });
  CHECK(Eventually([&] { return bench.driver.Read().saturated; }));
  CHECK(bench.driver.FaultText().empty());
  bench.served.With([](WristEmulator& emulator, SetWrist& sensor) {
    sensor.sample.saturated = false;
    emulator.LatchThreshold();
  });
  CHECK(Eventually([&] { return bench.driver.statistics().status == 0x80010000; }));
  CHECK(Eventually([&] { return !bench.driver.Read().saturated; }));
  CHECK(bench.driver.FaultText().empty());
  bench.served.With([](WristEmulator& emulator, auto&) { emulator.InjectStatus(0x20); });
  CHECK(Eventually([&] { return bench.driver.statistics().faulty > 0; }));
  CHECK_THAT(bench.driver.FaultText(), Contains("supply low"));
  const TimeNs old = bench.driver.Read().time;
  const auto faulty = bench.driver.statistics().faulty;
  CHECK(Eventually([&] { return bench.driver.statistics().faulty > faulty + 20; }));
  CHECK(bench.driver.Read().time == old);
}

TEST_CASE("Counts that stay the same on all axes are a stuck sensor, not a load", "[unit]") {
  Bench bench;
  CHECK(bench.EventuallyReads(10.0));
  CHECK(Eventually([&] { return !bench.driver.Read().problem.empty(); }));
  CHECK_THAT(bench.driver.Read().problem, Contains("the same counts for 0.1"));
  const TimeNs stuck = bench.driver.Read().time;
  // One count of one axis is enough to be alive.
  for (int i = 0; i < 60; ++i) {
    bench.served.With(
        [&](auto&, SetWrist& sensor) { sensor.sample.wrench_K.torque_Nm.z() += 1e-6; });
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const WrenchSample sample = bench.driver.Read();
    if (sample.time > stuck + FromSeconds(0.05)) CHECK(sample.problem.empty());
  }
  CHECK(bench.driver.Read().time > stuck + FromSeconds(0.1));
}

TEST_CASE("A silent box is not asked again, and its sample gets old", "[unit]") {
  Bench bench;
  CHECK(bench.EventuallyReads(10.0));
  bench.served.With([](WristEmulator& emulator, auto&) { emulator.link().drop = true; });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const WrenchSample old = bench.driver.Read();
  Load(bench.served, 4.0);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(bench.driver.Read().time == old.time);
  CHECK(bench.driver.Read().wrench_K.force_N.z() == 10.0);
}

TEST_CASE("The driver stops the stream that it has started", "[unit]") {
  ServedWrist served;
  const RunningClock clock(kServedRate);
  const auto streams = [&] {
    return served.With([](WristEmulator& emulator, auto&) { return emulator.streaming(); });
  };
  {
    const NetftSensor driver(To(served), clock);
    CHECK(streams());
  }
  CHECK(Eventually([&] { return !streams(); }));
}

TEST_CASE("A box that cannot be reached is named with its place", "[unit]") {
  const RunningClock clock(1000.0);
  NetftConfig config;
  config.host = "127.0.0.1";
  config.rate = 1000.0;
  const auto why = [&]() -> std::string {
    try {
      const NetftSensor driver(config, clock);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::kDevice);
      return error.what();
    }
    return "no error";
  };
  {
    ServedWrist gone;
    config.port = gone.port();
    config.http_port = gone.http_port();
  }
  CHECK_THAT(why(), Contains("force/torque sensor 127.0.0.1:" + std::to_string(config.port) +
                             ": no configuration from http://127.0.0.1:") &&
                        Contains("/netftapi2.xml: Connection refused"));
}

TEST_CASE("A box that never streams is given up after eight seconds", "[slow]") {
  ServedWrist served;
  NetftConfig config = To(served);
  config.http_port = 0;
  served.With([](WristEmulator& emulator, auto&) { emulator.link().drop = true; });
  const RunningClock clock(1.0);
  CHECK_THROWS_WITH(NetftSensor(config, clock), Contains("no sample within 8 s"));
}

TEST_CASE("A page is got over HTTP or it is said why not", "[unit]") {
  ServedWrist served;
  const auto limit = std::chrono::seconds(20);
  const auto page = HttpGet("127.0.0.1", served.http_port(), "/netftapi2.xml", limit);
  REQUIRE(std::holds_alternative<std::string>(page));
  CHECK_THAT(std::get<std::string>(page), Contains("<scfgfu>N</scfgfu>"));
  const auto none = HttpGet("127.0.0.1", served.http_port(), "/other", limit);
  CHECK_THAT(std::get<DecodeError>(none).reason, Contains("404"));
  served.With([](WristEmulator& emulator, auto&) { emulator.link().freeze = true; });
  const auto late =
      HttpGet("127.0.0.1", served.http_port(), "/netftapi2.xml", std::chrono::milliseconds(50));
  CHECK(std::get<DecodeError>(late).reason == "no whole answer in time");
}

TEST_CASE("The sensor's configuration says what is wrong with it", "[unit]") {
  NetftConfig config;
  CHECK_NOTHROW(config.ValidateOrThrow());
  ConfigSource source;
  source.AddText("host = 'box'\nport = 5\nhttp_port = 80\ncounts_per_N = 20.0\n", "cell.toml");
  source.ReadInto(config);
  CHECK(config.Name() == "force/torque sensor box:5");
  CHECK(config.counts_per_N == 20.0);
  config.host.clear();
  CHECK_THROWS_WITH(config.ValidateOrThrow(), Contains("cell.wrist.host is empty"));
  ConfigSource wrong;
  wrong.AddText("counts_per_Nm = 0\n", "cell.toml");
  CHECK_THROWS_WITH(wrong.ReadInto(config), Contains("cell.toml:1"));
}

}  // namespace
}  // namespace tubetwin
