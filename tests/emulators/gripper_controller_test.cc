#include "hw_bridge/emulators/robotiq/gripper_controller.h"

#include <algorithm>

#include "tests/support/catch.h"
#include "tests/support/moving_fingers.h"
#include "tests/support/paper_scale.h"

namespace tubetwin {
namespace {

struct ControllerBench {
  MovingFingers fingers;
  GripperController controller{fingers, PaperScale()};
  TimeNs now{0};

  void Advance(double duration_s) {
    for (const TimeNs end = now + FromSeconds(duration_s); now < end;) {
      now += kControlPeriod;
      fingers.Advance(kControlPeriod);
      controller.Heard(now);
      controller.Tick(now);
    }
  }
  void Write(const GripperAction& action) {
    const GripperRegisters words = EncodeGripperAction(action);
    controller.Write(kGripperActionStart, {words.begin(), words.end()});
  }
  GripperStatus Read() {
    const auto words = controller.Read(kGripperStatusStart, 3);
    return std::get<GripperStatus>(DecodeGripperStatus({words.at(0), words.at(1), words.at(2)}));
  }
  GripperAction Activate() {
    GripperAction action;
    action.activate = true;
    Write(action);
    Advance(2.0);
    REQUIRE(Read().activation == GripperActivation::kDone);
    return action;
  }
  GripperAction Close(GripperAction action) {
    action.go_to = true;
    action.position = 255;
    action.speed = action.force = 128;
    Write(action);
    return action;
  }
};

TEST_CASE("Activation opens and closes the fingers once and ends open", "[unit]") {
  ControllerBench bench;
  GripperStatus status = bench.Read();
  CHECK_FALSE(status.activate);
  CHECK(status.activation == GripperActivation::kReset);
  GripperAction action;
  action.activate = true;
  bench.Write(action);
  bool closed = false;
  int took_ms = 0;
  while (bench.Read().activation != GripperActivation::kDone) {
    CHECK(bench.Read().activation == GripperActivation::kRunning);
    bench.Advance(0.01);
    closed = closed || bench.fingers.opening_m() == 0.0;
    took_ms += 10;
    REQUIRE(took_ms < 5000);
  }
  CHECK(closed);
  CHECK(took_ms > 1500);  // Twice the stroke at 100 mm/s.
  CHECK(bench.fingers.opening_m() == 0.085);
  CHECK(bench.Read().position == 3);
  // Written again it changes nothing.
  const auto before = bench.fingers.commands.size();
  bench.Write(action);
  bench.Advance(0.1);
  CHECK(bench.fingers.commands.size() == before);
}

TEST_CASE("A request moves the fingers as its bytes say", "[unit]") {
  ControllerBench bench;
  GripperAction action = bench.Activate();
  action.go_to = true;
  action.position = 116;
  action.speed = 255;
  action.force = 0;
  bench.Write(action);
  CHECK(bench.fingers.commands.back().opening_m == Approx(0.085 * 114 / 227));
  CHECK(bench.fingers.commands.back().speed_m_s == 0.150);
  CHECK(bench.fingers.commands.back().force_N == 20.0);
  CHECK(bench.Read().motion == GripperMotion::kMoving);
  CHECK(bench.Read().position_request == 116);
  CHECK(bench.Read().current > 0);
  bench.Advance(0.5);
  CHECK(bench.Read().motion == GripperMotion::kArrived);
  CHECK(bench.Read().position == 116);
  CHECK(bench.Read().current == 0);
  CHECK(bench.Read().go_to);
  // A new value while rGTO stays, without anything else.
  action.position = 255;
  bench.Write(action);
  bench.Advance(1.0);
  CHECK(bench.Read().position == 230);
  CHECK(bench.Read().motion == GripperMotion::kArrived);
}

TEST_CASE("What lies between the fingers is felt, and missed when it is gone", "[unit]") {
  ControllerBench bench;
  bench.fingers.object_m = 0.025;
  GripperAction action;
  action.activate = true;
  bench.Write(action);
  bench.Advance(2.5);
  bench.Close(action);
  bench.Advance(1.0);
  CHECK(bench.Read().motion == GripperMotion::kStoppedClosing);
  CHECK(bench.Read().position == 163);
  bench.fingers.object_m = -1.0;
  bench.Advance(0.01);
  CHECK(bench.Read().motion == GripperMotion::kMoving);
  bench.Advance(1.0);
  CHECK(bench.Read().motion == GripperMotion::kArrived);
}

TEST_CASE("A lost object is only told, until the next request", "[unit]") {
  ControllerBench bench;
  GripperAction action = bench.Activate();
  bench.fingers.object_m = 0.025;
  action = bench.Close(action);
  bench.Advance(1.0);
  const auto commands = bench.fingers.commands.size();
  bench.controller.LoseObject();
  CHECK(bench.Read().motion == GripperMotion::kArrived);
  CHECK(bench.Read().position == 230);
  CHECK(bench.fingers.opening_m() == 0.025);
  CHECK(bench.fingers.commands.size() == commands);
  action.position = 0;
  bench.Write(action);
  CHECK(bench.Read().motion == GripperMotion::kMoving);
}

TEST_CASE("A request during activation waits and says so", "[unit]") {
  ControllerBench bench;
  GripperAction action;
  action.activate = true;
  bench.Write(action);
  bench.Advance(0.2);
  bench.Close(action);
  CHECK(bench.Read().fault == kGripperFaultDelayed);
  CHECK(bench.Read().motion == GripperMotion::kMoving);
  bench.Advance(4.0);
  CHECK(bench.Read().fault == 0);
  CHECK(bench.Read().position == 230);
}

TEST_CASE("A request without activation is a fault and moves nothing", "[unit]") {
  ControllerBench bench;
  GripperAction action;
  action.go_to = true;
  action.position = 255;
  bench.Write(action);
  bench.Advance(1.0);
  CHECK(bench.Read().fault == kGripperFaultNotActivated);
  CHECK(bench.fingers.commands.empty());
  bench.Write({});
  CHECK(bench.Read().fault == 0);
}

TEST_CASE("A second of silence is told once", "[unit]") {
  ControllerBench bench;
  (void)bench.Activate();
  bench.now += FromSeconds(1.001);
  bench.controller.Tick(bench.now);
  CHECK(bench.Read().fault == kGripperFaultSilence);
  bench.controller.Heard(bench.now);
  CHECK(bench.Read().fault == 0);
}

TEST_CASE("Automatic release opens slowly and ends in a fault that activation clears", "[unit]") {
  ControllerBench bench;
  GripperAction action = bench.Close(bench.Activate());
  bench.Advance(1.5);
  REQUIRE(bench.fingers.opening_m() == 0.0);
  action.automatic_release = action.release_opens = true;
  bench.Write(action);
  CHECK(bench.Read().fault == kGripperFaultReleasing);
  CHECK(bench.Read().activation == GripperActivation::kReset);
  CHECK(bench.fingers.commands.back().speed_m_s == 0.020);
  bench.Advance(5.0);
  CHECK(bench.fingers.opening_m() == 0.085);
  CHECK(bench.Read().fault == kGripperFaultReleased);
  bench.Write({});
  (void)bench.Activate();
  CHECK(bench.Read().fault == 0);
}

TEST_CASE("A major fault holds what is held until the gripper is activated anew", "[unit]") {
  ControllerBench bench;
  GripperAction action = bench.Activate();
  bench.fingers.object_m = 0.025;
  action = bench.Close(action);
  bench.Advance(1.0);
  const auto commands = bench.fingers.commands.size();
  bench.controller.RaiseFault(kGripperFaultCurrent);
  CHECK(bench.Read().fault == kGripperFaultCurrent);
  action.position = 0;
  bench.Write(action);
  bench.Advance(1.0);
  CHECK(bench.fingers.commands.size() == commands);
  CHECK(bench.Read().fault == kGripperFaultCurrent);
  bench.Write({});
  CHECK(bench.Read().fault == kGripperFaultCurrent);
  action.go_to = false;
  bench.Write(action);
  CHECK(bench.Read().fault == 0);
  CHECK(bench.Read().activation == GripperActivation::kRunning);
}

TEST_CASE("A fault stops fingers that open, and nothing else opens them", "[unit]") {
  ControllerBench bench;
  GripperAction action = bench.Close(bench.Activate());
  bench.Advance(1.5);
  action.position = 0;
  bench.Write(action);
  bench.Advance(0.2);
  bench.controller.RaiseFault(kGripperFaultVoltage);
  const double stopped_m = bench.fingers.opening_m();
  bench.Advance(1.0);
  CHECK(bench.fingers.opening_m() == Approx(stopped_m).margin(1e-9));
}

TEST_CASE("Without rGTO or rACT moving fingers stop, and pressing ones press on", "[unit]") {
  for (const bool closing : {true, false}) {
    for (const bool reset : {true, false}) {
      CAPTURE(closing, reset);
      ControllerBench bench;
      GripperAction action = bench.Activate();
      action.go_to = true;
      action.speed = action.force = 128;
      action.position = 255;
      bench.Write(action);
      bench.Advance(closing ? 0.2 : 1.5);
      if (!closing) {
        action.position = 0;
        bench.Write(action);
        bench.Advance(0.2);
      }
      action.go_to = false;
      action.activate = !reset;
      bench.Write(action);
      const double stopped_m = bench.fingers.opening_m();
      CHECK(stopped_m > 0.01);
      CHECK(stopped_m < 0.08);
      bench.Advance(1.0);
      CHECK(bench.fingers.opening_m() == Approx(stopped_m).margin(1e-9));
    }
  }
  ControllerBench holding;
  GripperAction action = holding.Activate();
  holding.fingers.object_m = 0.025;
  action = holding.Close(action);
  holding.Advance(1.0);
  const auto commands = holding.fingers.commands.size();
  action.go_to = false;
  holding.Write(action);
  holding.Write({});
  holding.Advance(0.5);
  CHECK(holding.fingers.commands.size() == commands);
}

TEST_CASE("The registers may begin elsewhere, both at 0", "[unit]") {
  MovingFingers fingers;
  GripperController controller(fingers, PaperScale(), 0, 0);
  controller.Write(0, {0x0100, 0, 0});
  CHECK(controller.Read(0, 1) == std::vector<std::uint16_t>{0x1100});
  CHECK_FALSE(controller.IsReadable(kGripperStatusStart, 1));
  CHECK_FALSE(controller.IsWritable(kGripperActionStart, 1));
}

TEST_CASE("Registers can be read and written in part, and no others", "[unit]") {
  ControllerBench bench;
  (void)bench.Activate();
  bench.controller.Write(kGripperActionStart + 1, {0x0042, 0x8040});
  const auto words = bench.controller.Read(kGripperActionStart, 3);
  CHECK(words == std::vector<std::uint16_t>{0x0100, 0x0042, 0x8040});
  CHECK(bench.controller.Read(kGripperStatusStart + 1, 1) == std::vector<std::uint16_t>{0x0042});
  for (const int start : {0, 0x03E7, 0x03E9, 0x07CF, 0x07D1, 0xFFFF}) {
    CHECK_FALSE(bench.controller.IsReadable(start, 16));
    CHECK_FALSE(bench.controller.IsWritable(start, 16));
  }
  // Clients read and write more than there is: the rest is 0 and means nothing.
  const std::vector<std::uint16_t> all = bench.controller.Read(kGripperStatusStart, 16);
  REQUIRE(all.size() == 16);
  CHECK(all[1] == 0x0042);
  CHECK(std::all_of(all.begin() + 3, all.end(), [](std::uint16_t word) { return word == 0; }));
  bench.controller.Write(kGripperActionStart + 2, {0x1020, 0xFFFF, 0xFFFF});
  CHECK(bench.controller.Read(kGripperActionStart, 5) ==
        std::vector<std::uint16_t>{0x0100, 0x0042, 0x1020, 0, 0});
  CHECK_FALSE(bench.controller.IsWritable(kGripperStatusStart, 1));
}

}  // namespace
}  // namespace tubetwin
