// What happens to an arm and its links while the driver streams, and when it does not.

#include <asio.hpp>
#include <chrono>

#include "models/base/error.h"
#include "tests/drivers/arm_bench.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

using Catch::Matchers::Contains;
using Script = void (*)(ArmEmulator&);

/// The message of the Error(kDevice) that connecting throws.
std::string WhyNotConnected(const YaskawaConfig& config) {
  const WallClock clock(config.rate);
  try {
    const YaskawaArm driver(config, PaperCell().arm, clock);
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::kDevice);
    return error.what();
  }
  FAIL("it has connected");
  return {};
}

int FreePort() {
  asio::io_context io;
  asio::ip::tcp::acceptor acceptor(io, {asio::ip::make_address("127.0.0.1"), 0});
  return acceptor.local_endpoint().port();
}

TEST_CASE("What stops an arm drops the rest of its motion until a person's word", "[unit]") {
  const auto [name, happens, goes, mode, text] =
      GENERATE(table<const char*, Script, Script, ArmMode, const char*>({
          {"protective stop", [](ArmEmulator& e) { e.ProtectiveStop(); }, [](ArmEmulator&) {},
           ArmMode::kProtectiveStop, "contact stop (5011)"},
          {"emergency stop", [](ArmEmulator& e) { e.EmergencyStop(); },
           [](ArmEmulator& e) { e.ReleaseEmergencyStop(); }, ArmMode::kEmergencyStop, "emergency"},
          {"alarm", [](ArmEmulator& e) { e.Alarm(4107); }, [](ArmEmulator&) {}, ArmMode::kFault,
           "alarm"},
          {"lasting alarm", [](ArmEmulator& e) { e.Alarm(1325, true); },
           [](ArmEmulator& e) { e.ClearAlarmCause(); }, ArmMode::kFault, "alarm"},
          {"hold", [](ArmEmulator& e) { e.Hold(true); }, [](ArmEmulator& e) { e.Hold(false); },
           ArmMode::kIdle, "hold (5007)"},
          {"teach mode", [](ArmEmulator& e) { e.SetPlay(false); },
           [](ArmEmulator& e) { e.SetPlay(true); }, ArmMode::kIdle, "PLAY mode (5004)"},
          {"local mode", [](ArmEmulator& e) { e.SetRemote(false); },
           [](ArmEmulator& e) { e.SetRemote(true); }, ArmMode::kIdle, "REMOTE mode (5005)"},
          {"drives off", [](ArmEmulator& e) { e.SwitchServo(false); }, [](ArmEmulator&) {},
           ArmMode::kIdle, "servo off (5006)"},
      }));
  const bool moving = GENERATE(true, false);
  CAPTURE(name, moving);
  ArmBench bench;
  if (moving) bench.MoveOn();
  bench.served.With([h = happens](ArmEmulator& emulator, FakeServoArm&) { h(emulator); });
  // Why motion is not possible is asked for: a standing arm is idle meanwhile.
  REQUIRE(Eventually([&, m = mode, t = text] {
    const ArmState state = bench.State();
    return state.mode == m && state.fault.find(t) != std::string::npos;
  }));
  const ArmState state = bench.State();
  CHECK(state.done != moving);
  if (moving) CHECK(state.progress_s < 3.0);
  CHECK(bench.Stands());
  const CommandResult refused = bench.driver->Start(Moved(state.q, 0.1, 0.5));
  CHECK_FALSE(refused.accepted());
  CHECK_THAT(refused.reason, Contains(text));
  // The cause goes away, the stop does not.
  bench.served.With([g = goes](ArmEmulator& emulator, FakeServoArm&) { g(emulator); });
  bench.Pass(0.2);
  CHECK(bench.State().mode == mode);
  REQUIRE(bench.driver->Recover().accepted());
  REQUIRE(bench.Await(ArmMode::kReady));
  CHECK(bench.State().fault.empty());
  CHECK(bench.Stands(0.1));
  REQUIRE(bench.driver->Start(Moved(bench.State().q, 0.1, 0.5)).accepted());
  CHECK(bench.Rest().done);
}

TEST_CASE("An arm whose cause of a stop is still there does not recover", "[unit]") {
  ArmBench bench;
  bench.served.With([](ArmEmulator& emulator, FakeServoArm&) { emulator.EmergencyStop(); });
  REQUIRE(bench.Await(ArmMode::kEmergencyStop));
  REQUIRE(bench.driver->Recover().accepted());
  CHECK(Eventually([&] {
    return bench.State().fault.find("START_TRAJ_MODE was refused") != std::string::npos;
  }));
  CHECK(bench.State().mode == ArmMode::kEmergencyStop);
  bench.served.With([](ArmEmulator& emulator, FakeServoArm&) { emulator.ReleaseEmergencyStop(); });
  REQUIRE(bench.driver->Recover().accepted());
  CHECK(bench.Await(ArmMode::kReady));
}

TEST_CASE("An arm that stands in a stop is told so on connecting, and not made ready", "[unit]") {
  ServedArm served;
  served.With([](ArmEmulator& emulator, FakeServoArm&) { emulator.Alarm(4107, true); });
  const WallClock clock(2.0);
  YaskawaArm driver(served.Config(), PaperCell().arm, clock);
  CHECK(driver.State().mode == ArmMode::kFault);
  CHECK_THAT(driver.State().fault, Contains("alarm"));
  served.With([](ArmEmulator& emulator, FakeServoArm&) { emulator.ClearAlarmCause(); });
  clock.Now();
  CHECK(driver.State().mode == ArmMode::kFault);
  CHECK(driver.Recover().accepted());
  CHECK(Eventually([&] { return driver.State().mode == ArmMode::kReady; }));
}

TEST_CASE("Lost links end the motion for good", "[unit]") {
  const auto [name, happens, text] = GENERATE(table<const char*, Script, const char*>({
      {"state closed", [](ArmEmulator& e) { e.CloseState(); }, "(state)"},
      {"motion closed", [](ArmEmulator& e) { e.CloseMotion(); }, "(motion)"},
      {"state frozen", [](ArmEmulator& e) { e.state_link().freeze = true; }, "no joint feedback"},
      {"state dropped", [](ArmEmulator& e) { e.state_link().drop = true; }, "no joint feedback"},
      {"motion frozen", [](ArmEmulator& e) { e.motion_link().freeze = true; }, "no answer to"},
      {"motion dropped", [](ArmEmulator& e) { e.motion_link().drop = true; }, "no answer to"},
  }));
  const bool moving = GENERATE(true, false);
  CAPTURE(name, moving);
  ArmBench bench;
  if (moving) bench.MoveOn();
  bench.served.With([h = happens](ArmEmulator& emulator, FakeServoArm&) { h(emulator); });
  REQUIRE(bench.Await(ArmMode::kDisconnected));
  const ArmState state = bench.State();
  CHECK_THAT(state.fault, Contains(text));
  CHECK(state.done != moving);
  CHECK(Eventually([&] { return bench.Stands(0.1); }));  // What it had been given is run.
  CHECK_FALSE(bench.driver->Start(Moved(state.q, 0.1, 0.5)).accepted());
  CHECK_THAT(bench.driver->Recover().reason, Contains("disconnected"));
  bench.driver->Stop(StopKind::kFast);
  // It comes back, the driver does not.
  bench.served.With([](ArmEmulator& emulator, FakeServoArm&) {
    emulator.state_link() = emulator.motion_link() = LinkFaults();
  });
  CHECK(bench.Stands());
  CHECK(bench.State().mode == ArmMode::kDisconnected);
  CHECK(bench.State().time == state.time);
}

TEST_CASE("A frozen state stream stops the arm over the motion port", "[unit]") {
  ArmBench bench;
  bench.MoveOn();
  bench.served.With([](ArmEmulator& e, FakeServoArm&) { e.state_link().freeze = true; });
  REQUIRE(bench.Await(ArmMode::kDisconnected));
  CHECK(Eventually([&] {
    return bench.served.With([](ArmEmulator& e, FakeServoArm&) {
      return !e.controller().queue_holds_data() && !e.controller().moving();
    });
  }));
  CHECK(bench.Stands());
}

TEST_CASE("Links that repeat themselves or lag a little do no harm", "[unit]") {
  const bool repeat = GENERATE(true, false);
  ArmBench bench;
  bench.served.With([repeat](ArmEmulator& e, FakeServoArm&) {
    for (LinkFaults* link : {&e.motion_link(), &e.state_link()}) {
      link->duplicate = repeat;
      link->delay = repeat ? TimeNs{0} : std::chrono::milliseconds(15);
    }
  });
  REQUIRE(bench.driver->Start(Moved(bench.State().q, 0.3, 1.0)).accepted());
  const ArmState state = bench.Rest();
  CHECK(state.mode == ArmMode::kReady);
  CHECK(state.done);
}

TEST_CASE("A motion link too slow to stream by ends in a fault, at rest", "[unit]") {
  ArmBench bench;
  bench.MoveOn();
  bench.served.With([](ArmEmulator& e, FakeServoArm&) {
    e.motion_link().delay = std::chrono::milliseconds(600);
  });
  const ArmState state = bench.Rest();
  CHECK((state.mode == ArmMode::kFault || state.mode == ArmMode::kDisconnected));
  CHECK_FALSE(state.fault.empty());
  CHECK(Eventually([&] { return bench.Stands(0.2); }));
}

TEST_CASE("Garbage on a link loses it", "[unit]") {
  const bool of_state = GENERATE(true, false);
  ArmBench bench;
  bench.MoveOn(1.0, 8.0);
  bench.served.With([of_state](ArmEmulator& e, FakeServoArm&) {
    (of_state ? e.state_link() : e.motion_link()).corrupt = true;
  });
  CHECK_FALSE(bench.Rest().fault.empty());
  CHECK(Eventually([&] { return bench.Stands(0.2); }));
}

TEST_CASE("An arm that is not armed is watched, and not a byte is sent to it", "[unit]") {
  ArmBench bench(false);
  CHECK(bench.State().mode == ArmMode::kIdle);
  CHECK_THAT(bench.State().fault, Contains("not armed"));
  const CommandResult started = bench.driver->Start(Moved(bench.State().q, 0.1, 0.5));
  CHECK_FALSE(started.accepted());
  CHECK_THAT(started.reason, Contains("not armed") && Contains("armed = false"));
  CHECK_FALSE(bench.driver->Append(Moved(bench.State().q, 0.1, 0.5)).accepted());
  CHECK_FALSE(bench.driver->Recover().accepted());
  bench.driver->Stop(StopKind::kFast);
  JointVector q = bench.State().q;
  q[0] += 0.01;
  bench.served.With([q](ArmEmulator& emulator, FakeServoArm& arm) {
    arm.Place(q);
    emulator.EmergencyStop();
  });
  CHECK(bench.Await(ArmMode::kEmergencyStop));
  CHECK(Eventually([&] { return (bench.State().q - q).cwiseAbs().maxCoeff() < 1e-6; }));
  bench.served.With([](ArmEmulator& emulator, FakeServoArm&) { emulator.ReleaseEmergencyStop(); });
  CHECK(bench.Await(ArmMode::kIdle));
  bench.Pass(1.0);
  bench.driver.reset();
  bench.served.With([](ArmEmulator& emulator, FakeServoArm&) {
    CHECK(emulator.motion_bytes() == 0);
    CHECK(emulator.motion_clients() == 0);
  });
}

TEST_CASE("Whatever cannot be connected is named with its place and what was awaited", "[unit]") {
  ServedArm served;
  YaskawaConfig config = served.Config();
  config.state_port = FreePort();
  CHECK_THAT(WhyNotConnected(config),
             Contains("arm (state) at 127.0.0.1:" + std::to_string(config.state_port)));
  config = served.Config();
  config.motion_port = FreePort();
  CHECK_THAT(WhyNotConnected(config),
             Contains("arm (motion) at 127.0.0.1:" + std::to_string(config.motion_port)));
  config = served.Config();
  config.motion_port = config.state_port;  // Listens, but does not answer.
  CHECK_THAT(WhyNotConnected(config), Contains("no answer to STOP_MOTION"));
  config.rate = 0.0;
  const WallClock clock;
  CHECK_THROWS_WITH(YaskawaArm(config, PaperCell().arm, clock), Contains("rate is 0"));
}

TEST_CASE("The end of the driver is the end of the motion", "[unit]") {
  ArmBench bench;
  bench.MoveOn();
  const auto begin = std::chrono::steady_clock::now();
  bench.driver.reset();
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(1));
  CHECK(Eventually([&] {
    return bench.served.With(
        [](ArmEmulator& e, FakeServoArm&) { return !e.controller().moving(); });
  }));
  CHECK(bench.Stands());
  // The job has ended: nobody moves the arm without starting it again.
  CHECK(bench.served.With([](ArmEmulator& e, FakeServoArm&) { return !e.controller().running(); }));
  bench.driver = std::make_unique<YaskawaArm>(bench.config, PaperCell().arm, bench.clock);
  CHECK(bench.State().mode == ArmMode::kReady);
}

}  // namespace
}  // namespace tubetwin::test
