// What the arm's controller tells of itself beside its motion and state ports.

#include "hw_bridge/drivers/yaskawa/supervision.h"

#include <map>
#include <string>

#include "tests/drivers/arm_bench.h"

namespace tubetwin::test {
namespace {

using Catch::Matchers::Contains;
using Script = void (*)(ArmEmulator&);

std::map<std::string, DeviceFinding> Told(const ServedArm& served, YaskawaConfig config) {
  config.hses_port = served.hses_port();
  std::map<std::string, DeviceFinding> out;
  JointVector q;
  q << 0.1, 0.4, 1.5, 0.0, 0.25, 0.0;
  for (const DeviceFinding& finding : Supervise(config, q)) out[finding.what] = finding;
  return out;
}

TEST_CASE("A controller in order is told line by line, with nothing to do", "[unit]") {
  ServedArm served;
  const WallClock clock(2.0);
  const YaskawaArm driver(served.Config(), PaperCell().arm, clock);
  const auto told = Told(served, served.Config());
  for (const auto& [what, finding] : told) {
    CAPTURE(what, finding.told);
    CHECK(finding.fix.empty());
  }
  CHECK(told.at("arm alarm").told == "none");
  CHECK(told.at("arm mode").told == "PLAY, REMOTE");
  CHECK(told.at("arm hold").told == "none");
  CHECK(told.at("arm drives").told == "on");
  CHECK(told.at("arm job").told == "INIT_ROS, runs, line 5");
  CHECK(told.at("arm encoders").told == "1000 pulses per degree, the cell file says 1000");
  CHECK_THAT(told.at("arm outputs 889 to 896").told,
             Contains("889 waits for motion") && Contains("891 initialised") &&
                 Contains("892 server runs") && Contains("893 motion client") &&
                 Contains("894 state client") && Contains("895 I/O client") && !Contains("896"));
  // Nothing was moved or changed.
  served.With([](ArmEmulator& e, FakeServoArm&) { CHECK(e.controller().points_taken() == 0); });
}

TEST_CASE("What is wrong with a controller is told with what a person does about it", "[unit]") {
  const auto [what, happens, says, fix] =
      GENERATE(table<const char*, Script, const char*, const char*>({
          {"arm alarm", [](ArmEmulator& e) { e.Alarm(4315); }, "4315 COLLISION DETECT", "reset it"},
          {"arm mode", [](ArmEmulator& e) { e.SetPlay(false); }, "TEACH, REMOTE", "key"},
          {"arm mode", [](ArmEmulator& e) { e.SetRemote(false); }, "PLAY, not REMOTE", "key"},
          {"arm hold", [](ArmEmulator& e) { e.Hold(true); }, "by a command", "release it"},
          {"arm drives", [](ArmEmulator& e) { e.SwitchServo(false); }, "off", ""},
          {"arm job", [](ArmEmulator& e) { e.controller().SelectJob("WELD"); },
           "WELD, does not run; INIT_ROS is not seen", "load INIT_ROS"},
          {"arm speed", [](ArmEmulator& e) { e.controller().LimitSpeed(0.1); }, "limited by", ""},
          {"arm outputs 889 to 896",
           [](ArmEmulator& e) { e.controller().io().SetOutput(kOutFailure, true); }, "896 failure",
           "MotoROS has failed"},
          {"arm outputs 889 to 896",
           [](ArmEmulator& e) { e.controller().io().SetOutput(kOutServer, false); }, "891",
           "install MotoROS"},
      }));
  CAPTURE(what);
  ServedArm served;
  served.With([h = happens](ArmEmulator& e, FakeServoArm&) { h(e); });
  const DeviceFinding finding = Told(served, served.Config()).at(what);
  CHECK_THAT(finding.told, Contains(says));
  CHECK_THAT(finding.fix, Contains(fix));
  CHECK(finding.fix.empty() == std::string(fix).empty());
}

TEST_CASE("Supervision that is not there is a finding that names its key", "[unit]") {
  ServedArm served;
  YaskawaConfig config = served.Config();
  config.io_port = served.hses_port();  // A UDP port: nobody listens by TCP.
  config.hses_port = 1;
  const auto silent = Supervise(config, JointVector::Zero());
  REQUIRE(silent.size() == 2);
  CHECK_THAT(silent[0].told, Contains("arm supervision 127.0.0.1:1: no answer"));
  CHECK_THAT(silent[0].fix, Contains("cell.arm.hses_port, or set it to 0"));
  CHECK_THAT(silent[1].told, Contains("arm (I/O) at 127.0.0.1:"));
  CHECK_THAT(silent[1].fix, Contains("cell.arm.io_port, or set it to 0"));
  config.hses_port = config.io_port = 0;
  for (const DeviceFinding& finding : Supervise(config, JointVector::Zero())) {
    CHECK(finding.fix.empty());
    CHECK_THAT(finding.told, Contains("_port = 0"));
  }
}

TEST_CASE("Pulses per degree are those of the coarsest joint that is turned enough", "[unit]") {
  JointVector q = JointVector::Zero();
  CHECK_FALSE(PulsesPerDegree({}, q).pulses_per_degree);
  q << Radians(10.0), Radians(-20.0), Radians(4.9), 0, Radians(30.0), 0;
  const PulseScale scale = PulsesPerDegree({15000, -24000, 1, 77, 30600, 0, 0, 0}, q);
  CHECK(*scale.pulses_per_degree == Approx(1020.0));
  CHECK(PulsesPerDegree({15000, 24000, 0, 0, 0, 0, 0, 0}, q).wrong_joint == 2);
  // A cell file that says something else is told to be mended.
  ServedArm served;
  YaskawaConfig config = served.Config();
  config.pulses_per_degree = 1300;
  CHECK(Told(served, config).at("arm encoders").fix == "set cell.arm.pulses_per_degree = 1000");
}

TEST_CASE("An alarm is told with its name, where supervision knows it", "[unit]") {
  const bool moving = GENERATE(true, false);
  const bool supervised = GENERATE(true, false);
  // The controller may refuse a point without a reason before it tells of its alarm.
  const bool refused = GENERATE(true, false);
  CAPTURE(moving, supervised, refused);
  ServedArm served;
  YaskawaConfig config = served.Config();
  config.hses_port = supervised ? served.hses_port() : 0;
  const WallClock clock(2.0);
  YaskawaArm driver(config, PaperCell().arm, clock);
  if (moving) {
    REQUIRE(driver.Start(Moved(driver.State().q, 0.5, 4.0)).accepted());
    REQUIRE(Eventually([&] { return driver.State().progress_s > 0.3; }));
  }
  served.With([refused](ArmEmulator& e, FakeServoArm&) {
    if (refused) e.Refuse(0, 1);
    e.Alarm(4315);
  });
  ArmState state;
  REQUIRE(Eventually([&] {
    state = driver.State();
    return state.mode == ArmMode::kFault;
  }));
  INFO(state.fault);
  if (moving) {  // The motion counts as running until the name is there.
    CHECK((state.fault.find("COLLISION DETECT") != std::string::npos) == supervised);
  } else if (supervised) {
    CHECK(Eventually(
        [&] { return driver.State().fault.find("COLLISION DETECT") != std::string::npos; }));
  }
  CHECK_THAT(state.fault, Contains("alarm"));
  REQUIRE(driver.Recover().accepted());
  CHECK(Eventually([&] { return driver.State().mode == ArmMode::kReady; }));
}

}  // namespace
}  // namespace tubetwin::test
