// What an earlier connection may have left in the controller, and how the driver meets it.

#include <atomic>
#include <csignal>
#include <random>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include <asio.hpp>

#include "hw_bridge/codecs/simple_message.h"
#include "models/base/error.h"
#include "tests/drivers/arm_bench.h"

namespace tubetwin::test {
namespace {

using Catch::Matchers::Contains;
namespace sm = simple_message;

constexpr double kRate = 2.0;

int References(ServedArm& served) {
  return served.With([](ArmEmulator&, FakeServoArm& arm) { return arm.references; });
}

bool QueueHoldsData(ServedArm& served) {
  return served.With(
      [](ArmEmulator& e, FakeServoArm&) { return e.controller().queue_holds_data(); });
}

/// A program that connects, starts a long motion and waits for its end.
pid_t StartProgram(const YaskawaConfig& config, const JointVector& q, double by_rad) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  try {
    const WallClock clock(kRate);
    YaskawaArm driver(config, PaperCell().arm, clock);
    if (!driver.Start(Moved(q, by_rad, 3.0)).accepted()) ::_exit(2);
    for (;;) ::pause();
  } catch (const std::exception&) {
    ::_exit(1);
  }
}

/// Drives have stood for 50 ms of wall time.
void AwaitRest(ServedArm& served) {
  REQUIRE(Eventually([&] {
    const int before = References(served);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return References(served) == before;
  }));
}

TEST_CASE("A program that is killed in motion leaves no motion to the next one", "[unit]") {
  constexpr int kTimes = 20;
  constexpr unsigned kSeed = 20;
  ServedArm served(kRate);
  const YaskawaConfig config = served.Config();
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> wait_s(0.0, 1.7);
  int left_behind = 0;
  for (int i = 0; i < kTimes; ++i) {
    CAPTURE(kSeed, i);
    const int at_rest = References(served);
    const JointVector q =
        served.With([](ArmEmulator&, FakeServoArm& arm) { return arm.Servo().q; });
    const pid_t program = StartProgram(config, q, i % 2 == 0 ? 0.3 : -0.3);
    REQUIRE(Eventually([&] { return References(served) > at_rest; }));
    std::this_thread::sleep_for(std::chrono::duration<double>(wait_s(random)));
    ::kill(program, SIGKILL);
    int status = 0;
    REQUIRE(::waitpid(program, &status, 0) == program);
    REQUIRE(WIFSIGNALED(status));
    AwaitRest(served);

    const int stands = References(served);
    const bool left = QueueHoldsData(served);
    left_behind += left ? 1 : 0;
    const WallClock clock(kRate);
    if (left) {
      CHECK_THROWS_WITH(YaskawaArm(config, PaperCell().arm, clock),
                        Contains("arm (state) at 127.0.0.1:") &&
                            Contains("an earlier connection has left motion") &&
                            Contains("press HOLD") && Contains("nothing was sent"));
      CHECK(References(served) == stands);
      // What the person at the pendant does.
      served.With([](ArmEmulator& e, FakeServoArm&) { e.Hold(true); });
      served.With([](ArmEmulator& e, FakeServoArm&) { e.Hold(false); });
    }
    const YaskawaArm driver(config, PaperCell().arm, clock);
    CHECK(driver.State().mode == ArmMode::kReady);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    CHECK(References(served) == stands);
  }
  CHECK(left_behind > kTimes / 2);
}

TEST_CASE("The first message to a controller is to stop", "[unit]") {
  ServedArm served(kRate);
  asio::io_context io;
  asio::ip::tcp::acceptor acceptor(io, {asio::ip::make_address("127.0.0.1"), 0});
  YaskawaConfig config = served.Config();
  config.motion_port = acceptor.local_endpoint().port();
  std::string first(68, '\0');
  std::thread controller([&] {
    asio::ip::tcp::socket socket = acceptor.accept();
    asio::read(socket, asio::buffer(first));
  });
  const WallClock clock(kRate);
  CHECK_THROWS_WITH(YaskawaArm(config, PaperCell().arm, clock), Contains("arm (motion)"));
  controller.join();
  CHECK(first == sm::Encode(sm::Request(sm::MotionControl{0, 1, sm::Command::kStopMotion, {}})));
}

TEST_CASE("An arm that somebody else moves is refused", "[unit]") {
  ServedArm served(kRate);
  std::atomic<bool> moves = true;
  served.With([&](ArmEmulator&, FakeServoArm& arm) {
    served.each_period = [&, other = &arm](const FakeServoArm&) {
      if (!moves) return;
      ServoReference next;
      next.q = other->Servo().q + 1e-4 * JointVector::Ones();
      next.qd = 0.1 * JointVector::Ones();
      other->Follow(next);
    };
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const WallClock clock(kRate);
  CHECK_THROWS_WITH(YaskawaArm(served.Config(), PaperCell().arm, clock),
                    Contains("the arm moves though nobody commands it from here"));
  served.With([](ArmEmulator& e, FakeServoArm&) { CHECK(e.motion_bytes() == 0); });
  moves = false;
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(YaskawaArm(served.Config(), PaperCell().arm, clock).State().mode == ArmMode::kReady);
}

TEST_CASE("A job that is started a second time may need its time to wait for motion", "[unit]") {
  ServedArm served(kRate);
  const WallClock clock(kRate);
  for (int round = 0; round < 4; ++round) {
    CAPTURE(round);
    YaskawaArm driver(served.Config(), PaperCell().arm, clock);
    const ArmState state = driver.State();
    REQUIRE(state.mode == ArmMode::kReady);
    REQUIRE(driver.Start(Moved(state.q, round % 2 == 0 ? 0.05 : -0.05, 0.4)).accepted());
    CHECK(Eventually([&] { return driver.State().mode != ArmMode::kMoving; }));
    CHECK(driver.State().fault.empty());
    CHECK(driver.State().done);
  }
}

TEST_CASE("A job that never comes to its WAIT is told with the controller's own code", "[unit]") {
  ServedArm served(kRate);
  const WallClock clock(kRate);
  // The controller believes in a job that has waited once before.
  CHECK(YaskawaArm(served.Config(), PaperCell().arm, clock).State().mode == ArmMode::kReady);
  served.With([](ArmEmulator& e, FakeServoArm&) { e.controller().StickJob(true); });
  YaskawaArm driver(served.Config(), PaperCell().arm, clock);
  CHECK(Eventually([&] { return driver.State().fault.find("5009") != std::string::npos; }));
  CHECK(driver.State().mode == ArmMode::kIdle);
}

}  // namespace
}  // namespace tubetwin::test
