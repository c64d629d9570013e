#include "hw_bridge/drivers/robotiq/robotiq_gripper.h"

#include <asio.hpp>
#include <limits>
#include <memory>

#include "models/base/error.h"
#include "tests/codecs/hex.h"
#include "tests/drivers/served.h"
#include "tests/support/catch.h"
#include "tests/support/paper_scale.h"
#include "tests/support/temporary_folder.h"

namespace tubetwin {
namespace {

using Catch::Matchers::Contains;

/// Of the paper's gripper.
RobotiqConfig Config() {
  RobotiqConfig config;
  config.scale = PaperScale();
  return config;
}

RobotiqConfig To(ServedGripper& served) {
  RobotiqConfig config = Config();
  config.host = "127.0.0.1";
  config.port = served.port();
  config.rate = kServedRate;
  return config;
}

/// Driver and emulated gripper; `rtu` by a pseudo-terminal.
struct Bench {
  explicit Bench(bool rtu = false) : served(rtu ? folder / "gripper" : "") {
    config.host = "127.0.0.1";
    if (!rtu) config.port = served.port();
    if (rtu) config.transport = "rtu";
    if (rtu) config.device = folder / "gripper";
    config.rate = kServedRate;
    driver = std::make_unique<RobotiqGripper>(config, clock);
  }
  GripperState Await() {
    CHECK(Eventually([&] { return driver->State().object != GripperObject::kMoving; }));
    return driver->State();
  }
  std::size_t commands() {
    return served.With([](auto&, MovingFingers& fingers) { return fingers.commands.size(); });
  }
  TemporaryFolder folder;
  RunningClock clock{kServedRate};
  ServedGripper served;
  RobotiqConfig config = Config();
  std::unique_ptr<RobotiqGripper> driver;
};

TEST_CASE("Connecting activates a gripper that is not, and no other", "[unit]") {
  const bool rtu = GENERATE(false, true);
  CAPTURE(rtu);
  Bench bench(rtu);
  GripperState state = bench.driver->State();
  CHECK(state.activated);
  CHECK(state.fault == 0);
  CHECK(state.object == GripperObject::kAtPosition);
  CHECK(bench.commands() == 3);  // Open, close, open.
  bench.served.With([](auto&, MovingFingers& fingers) { fingers.object_m = 0.025; });
  bench.driver->Command({0.0, 0.1, 60.0});
  CHECK(bench.Await().object == GripperObject::kContactClosing);
  // Another program takes over what the fingers hold.
  bench.driver.reset();
  bench.driver = std::make_unique<RobotiqGripper>(bench.config, bench.clock);
  state = bench.driver->State();
  CHECK(state.object == GripperObject::kContactClosing);
  CHECK(state.opening_m == Approx(0.025).margin(0.0004));
  CHECK(bench.commands() == 4);
}

TEST_CASE("Without leave to activate nothing moves", "[unit]") {
  ServedGripper served;
  RobotiqConfig config = To(served);
  config.activate = false;
  const RunningClock clock(kServedRate);
  const RobotiqGripper driver(config, clock);
  CHECK_FALSE(driver.State().activated);
  CHECK(served.With([](auto&, MovingFingers& fingers) { return fingers.commands.empty(); }));
}

TEST_CASE("A request is told as moving until the gripper says otherwise for it", "[unit]") {
  Bench bench;
  for (const double opening_m : {0.04, 0.04, 0.0, 0.085}) {
    CAPTURE(opening_m);
    bench.driver->Command({opening_m, 0.1, 60.0});
    CHECK(bench.driver->State().object == GripperObject::kMoving);
    CHECK(bench.driver->State().requested_m == Approx(opening_m).margin(0.0002));
    const GripperState state = bench.Await();
    CHECK(state.object == GripperObject::kAtPosition);
    CHECK(state.opening_m == Approx(opening_m).margin(0.0004));
  }
  // What comes last counts, however fast they come.
  for (int i = 0; i < 50; ++i) bench.driver->Command({0.001 * i, 0.15, 20.0});
  CHECK(bench.Await().opening_m == Approx(0.049).margin(0.0004));
  CHECK(bench.served.With([](auto&, MovingFingers& fingers) {
    return fingers.commands.back().speed_m_s;
  }) == 0.15);
}

TEST_CASE("A command that is no number is a bug and is not sent", "[unit]") {
  Bench bench;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(bench.driver->Command({nan, 0.1, 60.0}), LogicError);
  CHECK(bench.commands() == 3);
}

TEST_CASE("Faults of the gripper are told and nothing is commanded by itself", "[unit]") {
  Bench bench;
  bench.served.With([](auto&, MovingFingers& fingers) { fingers.object_m = 0.025; });
  bench.driver->Command({0.0, 0.1, 60.0});
  REQUIRE(bench.Await().object == GripperObject::kContactClosing);
  const auto commands = bench.commands();
  bench.served.With([](GripperEmulator& emulator, auto&) {
    emulator.controller().RaiseFault(kGripperFaultCurrent);
  });
  CHECK(Eventually([&] { return bench.driver->State().fault == kGripperFaultCurrent; }));
  CHECK(bench.driver->State().object == GripperObject::kContactClosing);
  CHECK(bench.commands() == commands);
  CHECK(bench.driver->LinkProblem().empty());
}

TEST_CASE("An object that is lost is told", "[unit]") {
  Bench bench;
  bench.served.With([](auto&, MovingFingers& fingers) { fingers.object_m = 0.025; });
  bench.driver->Command({0.0, 0.1, 60.0});
  REQUIRE(bench.Await().object == GripperObject::kContactClosing);
  SECTION("by the registers") {
    bench.served.With([](GripperEmulator& emulator, auto&) { emulator.controller().LoseObject(); });
  }
  SECTION("by the fingers") {
    bench.served.With([](auto&, MovingFingers& fingers) { fingers.object_m = -1.0; });
  }
  CHECK(Eventually([&] { return bench.driver->State().object == GripperObject::kAtPosition; }));
  CHECK(bench.driver->State().opening_m == 0.0);
}

/// Writes the action registers as another client would.
void WriteByAnother(int port, const GripperAction& action) {
  asio::io_context io;
  asio::ip::tcp::socket socket(io);
  socket.connect({asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(port)});
  std::string request = test::FromHex("0001 0000 000D 09 10 03E8 0003 06");
  for (const std::uint16_t word : EncodeGripperAction(action)) {
    request += static_cast<char>(word >> 8);
    request += static_cast<char>(word & 255);
  }
  asio::write(socket, asio::buffer(request));
  char answer[12];
  asio::read(socket, asio::buffer(answer));
}

TEST_CASE("A gripper that follows another client's request is told as somebody else's", "[unit]") {
  Bench bench;
  const int port = bench.config.port;
  GripperAction action;
  action.activate = action.go_to = true;
  SECTION("that opens what is held") {
    bench.served.With([](auto&, MovingFingers& fingers) { fingers.object_m = 0.025; });
    bench.driver->Command({0.0, 0.1, 60.0});
    REQUIRE(bench.Await().object == GripperObject::kContactClosing);
    CHECK(bench.driver->State().problem.empty());
    action.position = 3;
    WriteByAnother(port, action);
    CHECK(Eventually([&] { return !bench.driver->State().problem.empty(); }));
    CHECK(bench.driver->State().problem ==
          "another client commands the gripper: it was told to go "
          "to 85.0 mm, by this program to 0.0 mm");
  }
  SECTION("that stops it") {
    bench.driver->Command({0.0, 0.02, 60.0});
    action.go_to = false;
    action.position = 230;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    WriteByAnother(port, action);
    CHECK(Eventually([&] { return !bench.driver->State().problem.empty(); }));
    CHECK_THAT(bench.driver->State().problem, Contains("told to go nowhere"));
  }
  SECTION("before this program commands anything") {
    action.position = 116;
    WriteByAnother(port, action);
    CHECK(Eventually([&] { return !bench.driver->State().problem.empty(); }));
    CHECK_THAT(bench.driver->State().problem, Contains("by this program nowhere"));
  }
  const std::string first = bench.driver->State().problem;
  bench.driver->Command({0.03, 0.1, 60.0});
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  CHECK(bench.driver->State().problem == first);  // Once is enough.
}

TEST_CASE("Fingers that may hold something are not activated without a person's word", "[unit]") {
  ServedGripper served;
  RobotiqConfig config = To(served);
  const RunningClock clock(kServedRate);
  for (const double object_m : {0.025, -1.0}) {
    CAPTURE(object_m);
    {
      RobotiqGripper driver(config, clock);
      served.With([&](auto&, MovingFingers& fingers) { fingers.object_m = object_m; });
      driver.Command({0.0, 0.1, 60.0});
      CHECK(Eventually([&] { return driver.State().object != GripperObject::kMoving; }));
    }
    served.With([](GripperEmulator& emulator, auto&) {
      emulator.controller().RaiseFault(kGripperFaultCurrent);
    });
    const auto commands = [&] {
      return served.With([](auto&, MovingFingers& fingers) { return fingers.commands.size(); });
    };
    const auto before = commands();
    std::string asked;
    config.confirm = [&](const std::string& what) {
      asked = what;
      return false;
    };
    if (object_m < 0.0) {  // Closed on nothing: there is nothing to ask.
      CHECK(RobotiqGripper(config, clock).State().activated);
      CHECK(asked.empty());
      continue;
    }
    CHECK_THROWS_WITH(RobotiqGripper(config, clock),
                      Contains("needs activation (gSTA 3, gFLT 0x0E (over-current))") &&
                          Contains("they stand 25.1 mm apart and may hold something"));
    CHECK_THAT(asked, Contains("take it out first"));
    config.confirm = nullptr;
    CHECK_THROWS_WITH(RobotiqGripper(config, clock), Contains("may hold something"));
    CHECK(commands() == before);
    served.With([](auto&, MovingFingers& fingers) { fingers.object_m = -1.0; });
    config.confirm = [](const std::string&) { return true; };
    CHECK(RobotiqGripper(config, clock).State().activated);
  }
}

TEST_CASE("A link that stumbles is used on, commands are not lost", "[unit]") {
  Bench bench;
  const auto fault = GENERATE(&LinkFaults::drop, &LinkFaults::corrupt, &LinkFaults::duplicate);
  bench.served.With([&](GripperEmulator& emulator, auto&) { emulator.link().*fault = true; });
  bench.driver->Command({0.02, 0.15, 60.0});
  if (fault != &LinkFaults::duplicate) {
    CHECK(Eventually([&] { return bench.driver->unanswered() > 0; }));
  }
  CHECK(bench.driver->State().object == GripperObject::kMoving);
  bench.served.With([&](GripperEmulator& emulator, auto&) { emulator.link().*fault = false; });
  CHECK(bench.Await().opening_m == Approx(0.02).margin(0.0004));
  CHECK(bench.driver->LinkProblem().empty());
}

TEST_CASE("A silent gripper is lost for good and its fingers stay as they are", "[unit]") {
  Bench bench;
  bench.driver->Command({0.03, 0.15, 60.0});
  (void)bench.Await();
  const auto commands = bench.commands();
  bench.served.With([](GripperEmulator& emulator, auto&) { emulator.link().freeze = true; });
  CHECK(Eventually([&] { return !bench.driver->LinkProblem().empty(); }));
  CHECK_THAT(bench.driver->LinkProblem(),
             Contains("gripper 127.0.0.1:") && Contains("the link is lost: no answer for 1 s"));
  const GripperState lost = bench.driver->State();
  CHECK(lost.fault == kGripperFaultSilence);
  bench.served.With([](GripperEmulator& emulator, auto&) { emulator.link().freeze = false; });
  bench.driver->Command({0.085, 0.1, 60.0});
  for (int i = 0; i < 100; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(bench.driver->State().time == lost.time);
  CHECK(bench.commands() == commands);
}

TEST_CASE("A closed connection is lost at once", "[unit]") {
  auto served = std::make_unique<ServedGripper>();
  const RunningClock clock(kServedRate);
  const RobotiqGripper driver(To(*served), clock);
  served.reset();
  CHECK(Eventually([&] { return driver.State().fault == kGripperFaultSilence; }));
  CHECK_THAT(driver.LinkProblem(), Contains("the link is lost"));
}

TEST_CASE("A gripper that cannot be reached is named with its place", "[unit]") {
  RobotiqConfig config = Config();
  config.host = "127.0.0.1";
  {
    ServedGripper gone;
    config.port = gone.port();
  }
  const RunningClock clock(1.0);
  const auto why = [&](const RobotiqConfig& to) -> std::string {
    try {
      const RobotiqGripper driver(to, clock);
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::kDevice);
      return error.what();
    }
    return "no error";
  };
  CHECK_THAT(why(config), Contains("gripper 127.0.0.1:" + std::to_string(config.port) +
                                   ": no connection by Modbus TCP: Connection refused"));
  config.transport = "rtu";
  config.device = "/dev/there-is-no-such-device";
  CHECK_THAT(why(config), Contains("gripper /dev/there-is-no-such-device: no connection"));
}

TEST_CASE("The gripper's configuration says what is wrong with it", "[unit]") {
  RobotiqConfig config = Config();
  CHECK_NOTHROW(config.ValidateOrThrow());
  ConfigSource source;
  source.AddText("host = 'robot'\nport = 502\nslave = 10\ndevice = '/dev/ttyUSB0'\n", "cell.toml");
  source.ReadInto(config);
  CHECK(config.Name() == "gripper robot:502");
  config.transport = "rtu";
  CHECK(config.Name() == "gripper /dev/ttyUSB0");
  config.device.clear();
  CHECK_THROWS_WITH(config.ValidateOrThrow(), Contains("cell.gripper.device is empty"));
  config.device = "x";
  config.rate = 0;
  CHECK_THROWS_WITH(config.ValidateOrThrow(), Contains("rate is 0"));
  ConfigSource wrong;
  wrong.AddText("slave = 248\n", "cell.toml");
  CHECK_THROWS_WITH(wrong.ReadInto(config), Contains("cell.toml:1"));
}

}  // namespace
}  // namespace tubetwin
