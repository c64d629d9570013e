// What a motion client leaves behind, and when the emulated controller is believed to be ready.

#include <cmath>
#include <functional>
#include <optional>

#include "tests/emulators/arm_rig.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

namespace sm = simple_message;
using sm::NotReady;
using sm::Result;

}  // namespace

TEST_CASE("a disconnection ends the job and answers nothing", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  motion.Send(sm::Encode(sm::Request(sm::MotionControl{0, 0, sm::Command::kDisconnect, {}})));
  CHECK(motion.closed());
  CHECK(motion.Collect(5).empty());
  CHECK_FALSE(rig.emulator.controller().running());
}

TEST_CASE("what a client leaves behind runs on for 50 ms and goes on with the next client",
          "[unit]") {
  ArmRig rig;
  std::optional<ArmRig::Socket> first(rig.Motion());
  Ready(*first);
  const JointVector q0 = rig.arm.Servo().q;
  Stream(*first, 0, 0.0, q0);
  Stream(*first, 1, 0.6, q0 + 0.06 * kOnes);
  rig.Run(100);
  first->Close();
  rig.Run(3);
  const int left = rig.arm.references;
  rig.Run(100);
  CHECK(rig.arm.references - left >= 40);
  CHECK(rig.arm.references - left <= 50);
  // It stands, and says that it is in motion.
  CHECK(rig.emulator.controller().queue_holds_data());
  CHECK(rig.emulator.controller().Status().in_motion == 1);
  const int before = rig.arm.references;
  rig.Run(200);
  CHECK(rig.arm.references == before);

  SECTION("from where the arm is by then") {
    const JointVector done = rig.arm.Servo().q - q0;
    rig.arm.Place(rig.arm.Servo().q + 0.2 * kOnes);
    ArmRig::Socket second = rig.Motion();
    rig.Run(700);
    // Increments say how far, not where to.
    CHECK((rig.arm.Servo().q - q0 - 0.26 * kOnes).cwiseAbs().maxCoeff() < 1e-5);
    CHECK(done[0] > 0.005);
  }
  SECTION("unless the first that the next one says is to stop") {
    ArmRig::Socket second = rig.Motion();
    CHECK(Command(second, sm::Command::kStopMotion).result == Result::kSuccess);
    const int stopped = rig.arm.references;
    CHECK(stopped - before < 10);
    rig.Run(200);
    CHECK(rig.arm.references == stopped);
    CHECK(rig.emulator.controller().Status().in_motion == 0);
  }
  SECTION("unless it is held meanwhile") {
    rig.emulator.Hold(true);
    rig.Run(1);
    CHECK(rig.emulator.controller().Status().in_motion == 0);
    rig.emulator.Hold(false);
    ArmRig::Socket second = rig.Motion();
    rig.Run(200);
    CHECK(rig.arm.references == before);
  }
}

TEST_CASE("a job that is started again is believed at once, and then not for 50 ms", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  REQUIRE(Command(motion, sm::Command::kStopTrajectoryMode).result == Result::kSuccess);
  rig.Run(5);
  CHECK(Command(motion, sm::Command::kCheckMotionReady).subcode == Code(NotReady::kNotStarted));
  const TimeNs before = rig.now;
  Ready(motion);
  CHECK(rig.now - before < std::chrono::milliseconds(5));
  rig.Run(10);
  CHECK(Command(motion, sm::Command::kCheckMotionReady).subcode == Code(NotReady::kWaiting));
  CHECK(rig.emulator.controller().Status().motion_possible == 0);
  // What runs already is not started again.
  CHECK(Command(motion, sm::Command::kStartTrajectoryMode).subcode == Code(NotReady::kWaiting));
  rig.Run(50);
  CHECK(Command(motion, sm::Command::kCheckMotionReady).result == Result::kSuccess);
}

TEST_CASE("a speed limit makes the arm lag on its path and tells nobody", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  const JointVector q0 = rig.arm.Servo().q;
  rig.emulator.controller().LimitSpeed(0.02);
  JointVector by = JointVector::Zero();
  by[0] = 0.1;
  Stream(motion, 0, 0.0, q0);
  Stream(motion, 1, 0.5, q0 + by);
  double fastest_m_s = 0.0;
  int periods = 0;
  for (; rig.emulator.controller().queue_holds_data(); ++periods) {
    const JacobianMatrix J =
        Jacobian(PaperCell().arm, rig.arm.Servo().q, RigidTransform::Identity());
    if (periods > 100) {  // The controller needs a moment to brake.
      fastest_m_s = std::max(fastest_m_s, (J * rig.arm.Servo().qd).head<3>().norm());
    }
    CHECK(rig.emulator.controller().Status().motion_possible == 1);
    REQUIRE(periods < 20000);
    rig.Run(1);
  }
  CHECK(fastest_m_s < 0.021);
  CHECK(periods > 1000);
  rig.Run(3);
  CHECK((rig.arm.Servo().q - q0 - by).cwiseAbs().maxCoeff() < 1e-5);
}

}  // namespace tubetwin::test
