// The emulated controller's motion port against the documented bytes and rules.

#include <cmath>

#include "tests/codecs/hex.h"
#include "tests/emulators/arm_rig.h"
#include "tests/support/catch.h"

namespace tubetwin::test {
namespace {

namespace sm = simple_message;
using sm::Invalid;
using sm::NotReady;
using sm::Result;

constexpr double kFloat_rad = 3e-7;  ///< Half a step of a float32 at 4 rad, and some.

}  // namespace

TEST_CASE("the motion port answers the documented bytes", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  const auto ask = [&](const std::string& request, std::size_t size) {
    motion.Send(FromHex(request));
    return ToHex(motion.Receive(size));
  };
  const auto hex = [](const char* text) { return ToHex(FromHex(text)); };

  CHECK(ask("0c000000 01000000 02000000 00000000", 16) ==
        hex("0c000000 01000000 03000000 01000000"));
  rig.emulator.SetRemote(false);
  CHECK(ask("40000000 d1070000 02000000 00000000 00000000 00000000 a50d0300 00*40", 76) ==
        hex("48000000 d2070000 03000000 01000000 00000000 00000000 a50d0300 02000000 8d130000 "
            "00*40"));
  rig.emulator.SetRemote(true);
  CHECK(ask("40000000 d1070000 02000000 00000000 00000000 00000000 b90d0300 00*40", 76) ==
        hex("48000000 d2070000 03000000 01000000 00000000 00000000 b90d0300 00000000 00000000 "
            "00*40"));
  JointVector q;
  q << 0.1, -0.2, 1.5, 0, 0.25, 0;
  rig.arm.Place(q);
  CHECK(ask("94000000 0e000000 02000000 00000000 00000000 00000000 07000000 00000000 cdcccc3d "
            "cdcc4cbe 0000c03f 00000000 0000803e 00*100",
            76) == hex("48000000 d2070000 03000000 01000000 00000000 00000000 0e000000 00000000 "
                       "00000000 00*40"));
  // Two points at once: the second comes while the first is still being cut.
  sm::JointPoint point;
  point.sequence = 1;
  point.time_s = 1.2f;
  point.q_rad = sm::ToSlots(q);
  const std::string bytes = sm::Encode(sm::Request(point));
  motion.Send(bytes + bytes);
  motion.Receive(76);
  CHECK(ToHex(motion.Receive(76)) == hex("48000000 d2070000 03000000 01000000 00000000 01000000 "
                                         "0e000000 01000000 00000000 00*40"));
  CHECK(ask("40000000 d1070000 02000000 00000000 00000000 00000000 af0d0300 00*40", 76) ==
        hex("48000000 d2070000 03000000 01000000 00000000 00000000 af0d0300 00000000 00000000 "
            "00*40"));
}

TEST_CASE("streamed points become the cubic between them, 4 ms at a time", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  const JointVector q0 = rig.arm.Servo().q, v = 0.5 * kOnes;
  // To 0.1 s with speed, on at constant speed, then to rest: each by its own closed form.
  REQUIRE(Stream(motion, 0, 0.0, q0).result == Result::kSuccess);
  REQUIRE(Stream(motion, 1, 0.1, q0 + 0.02 * kOnes, v).result == Result::kSuccess);
  REQUIRE(Stream(motion, 2, 0.2, q0 + 0.07 * kOnes, v).result == Result::kSuccess);
  REQUIRE(Stream(motion, 3, 0.3, q0 + 0.09 * kOnes).result == Result::kSuccess);
  CHECK(rig.arm.references > 0);

  JointTrajectory path;
  for (const auto& [t, q, qd] :
       {std::tuple{0.0, 0.0, 0.0}, {0.1, 0.02, 0.5}, {0.2, 0.07, 0.5}, {0.3, 0.09, 0.0}}) {
    path.points.push_back({t, q0 + q * kOnes, qd * kOnes, JointVector::Zero()});
  }
  while (rig.emulator.controller().moving()) {
    const int passed = rig.arm.references - 1;
    const JointVector should = Sample(path, 1e-3 * passed).q;
    REQUIRE((rig.arm.Servo().q - should).cwiseAbs().maxCoeff() < kFloat_rad);
    rig.Run(1);
  }
  CHECK(rig.arm.references == 301);
  CHECK((rig.arm.Servo().q - (q0 + 0.09 * kOnes)).cwiseAbs().maxCoeff() < kFloat_rad);
  CHECK(rig.arm.Servo().qd.cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("the queue holds 200 increments and the rest of a point keeps the controller busy",
          "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  const JointVector q0 = rig.arm.Servo().q;
  REQUIRE(Stream(motion, 0, 0.0, q0).result == Result::kSuccess);
  REQUIRE(Stream(motion, 1, 2.0, q0 + 0.1 * kOnes).result == Result::kSuccess);  // 500 increments.
  rig.Run(5);
  const sm::MotionReply count = Command(motion, sm::Command::kCheckQueueCount);
  CHECK(count.result == Result::kSuccess);
  CHECK(count.subcode == 200);
  CHECK(SendPoint(motion, 2, 3.0, q0).result == Result::kBusy);
  CHECK(Command(motion, sm::Command::kStopTrajectoryMode).result == Result::kFailure);
  CHECK(Command(motion, sm::Command::kDisconnect).result == Result::kFailure);
  CHECK(Stream(motion, 2, 3.0, q0).result == Result::kSuccess);
  // It was taken once no more than 200 increments were left of the first 2 s.
  CHECK(rig.arm.references >= 1190);

  CHECK(Command(motion, sm::Command::kStopMotion).result == Result::kSuccess);
  CHECK(Command(motion, sm::Command::kCheckQueueCount).subcode == 0);
  const int before = rig.arm.references;
  rig.Run(20);
  CHECK(rig.arm.references == before);
  // The next trajectory begins from here.
  CHECK(SendPoint(motion, 0, 0.0, rig.arm.Servo().q).result == Result::kSuccess);
}

TEST_CASE("what is no message gets the controller's own answers and the socket stays open",
          "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  const auto answer = [&](const std::string& bytes) {
    motion.Send(bytes);
    const auto decoded = sm::DecodeFront(motion.Receive(76), true);
    return std::get<sm::MotionReply>(std::get<sm::Message>(decoded).body);
  };
  const std::string ready =
      sm::Encode(sm::Request(sm::MotionControl{0, 7, sm::Command::kCheckMotionReady, {}}));
  std::string unknown = ready;
  unknown[4] = 0x63;
  sm::MotionReply reply = answer(unknown);
  CHECK(reply.group == -1);
  CHECK(reply.sequence == -1);
  CHECK(reply.command == 0x0763);
  CHECK(reply.result == Result::kInvalid);
  CHECK(reply.subcode == Code(Invalid::kMessageType));
  // Half a message is not waited for; the length before it does not count.
  CHECK(answer(ready.substr(0, 60)).subcode == Code(Invalid::kMessageSize));
  CHECK(answer("abc").subcode == Code(Invalid::kMessageSize));
  std::string length = ready;
  length[0] = 1;
  CHECK(answer(length).sequence == 7);
  CHECK(answer(sm::Encode(sm::Request(sm::ReadRegister{7}))).subcode ==
        Code(Invalid::kMessageType));
  // It has no answer of its own to an unknown command: the one before is sent again.
  CHECK(answer(sm::Encode(sm::Request(sm::MotionControl{0, 0, sm::Command(200999), {}}))).subcode ==
        Code(Invalid::kMessageType));
  // Several messages in one segment are handled one after another.
  motion.Send(ready + ready + ready);
  CHECK(motion.Receive(3 * 76).size() == 3 * 76);
}

TEST_CASE("a newcomer takes over the motion port only while no motion waits", "[unit]") {
  ArmRig rig;
  ArmRig::Socket first = rig.Motion();
  ArmRig::Socket second = rig.Motion();
  CHECK(first.closed());
  CHECK(rig.emulator.motion_clients() == 1);
  Ready(second);
  const JointVector q = rig.arm.Servo().q;
  Stream(second, 0, 0.0, q);
  Stream(second, 1, 1.0, q + 0.05 * kOnes);
  ArmRig::Socket third = rig.Motion();
  CHECK(third.closed());
  CHECK(Command(second, sm::Command::kCheckMotionReady).result == Result::kSuccess);
}

TEST_CASE("starting the trajectory mode powers drives and starts the job, in time", "[unit]") {
  ArmEmulatorConfig config = ArmRig::Loopback();
  config.servo_on = false;
  ArmRig rig(config);
  ArmRig::Socket motion = rig.Motion();
  CHECK(Command(motion, sm::Command::kCheckMotionReady).subcode == Code(NotReady::kServoOff));
  const TimeNs before = rig.now;
  Ready(motion);
  CHECK(rig.now - before >= std::chrono::milliseconds(250));
  CHECK(rig.now - before < std::chrono::milliseconds(300));
  CHECK(rig.emulator.controller().io().Output(kOutWaiting));
  CHECK(Command(motion, sm::Command::kCheckMotionReady).result == Result::kSuccess);
  // What came while it waited is answered afterwards, in order.
  CHECK(Command(motion, sm::Command::kStopServos).result == Result::kSuccess);
  const auto control = [](sm::Command command, int sequence) {
    return sm::Encode(sm::Request(sm::MotionControl{0, sequence, command, {}}));
  };
  motion.Send(control(sm::Command::kStartTrajectoryMode, 1));
  rig.Run(3);
  motion.Send(control(sm::Command::kCheckMotionReady, 2));
  const std::string both = motion.Receive(2 * 76);
  REQUIRE(both.size() == 2 * 76);
  CHECK(both[20] == 1);
  CHECK(both[76 + 20] == 2);
  // It cannot come to pass: no waiting.
  rig.emulator.EmergencyStop();
  CHECK(Command(motion, sm::Command::kStartTrajectoryMode).subcode ==
        Code(NotReady::kEmergencyStop));
}

TEST_CASE("each fault ends the motion, says why, and needs the trajectory mode again", "[unit]") {
  using Emulator = ArmEmulator;
  const auto [name, fault, cure, subcode] =
      GENERATE(table<const char*, void (*)(Emulator&), void (*)(Emulator&), NotReady>({
          {"contact", [](Emulator& e) { e.ProtectiveStop(); }, [](Emulator&) {},
           NotReady::kContactStop},
          {"e-stop", [](Emulator& e) { e.EmergencyStop(); },
           [](Emulator& e) { e.ReleaseEmergencyStop(); }, NotReady::kEmergencyStop},
          {"alarm", [](Emulator& e) { e.Alarm(4315); }, [](Emulator&) {}, NotReady::kAlarm},
          {"lasting alarm", [](Emulator& e) { e.Alarm(4315, true); },
           [](Emulator& e) { e.ClearAlarmCause(); }, NotReady::kAlarm},
          {"hold", [](Emulator& e) { e.Hold(true); }, [](Emulator& e) { e.Hold(false); },
           NotReady::kHold},
          {"teach", [](Emulator& e) { e.SetPlay(false); }, [](Emulator& e) { e.SetPlay(true); },
           NotReady::kNotPlay},
          {"local", [](Emulator& e) { e.SetRemote(false); }, [](Emulator& e) { e.SetRemote(true); },
           NotReady::kNotRemote},
          {"servo", [](Emulator& e) { e.SwitchServo(false); }, [](Emulator&) {},
           NotReady::kServoOff},
      }));
  CAPTURE(name);
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  const JointVector q = rig.arm.Servo().q;
  Stream(motion, 0, 0.0, q);
  Stream(motion, 1, 1.0, q + 0.05 * kOnes);
  rig.Run(20);
  fault(rig.emulator);
  const int references = rig.arm.references;
  rig.Run(20);
  CHECK(rig.arm.references == references);
  CHECK(Command(motion, sm::Command::kCheckQueueCount).subcode == 0);
  CHECK(Command(motion, sm::Command::kCheckMotionReady).subcode == Code(subcode));
  CHECK(SendPoint(motion, 2, 2.0, q).result == Result::kNotReady);
  CHECK(rig.emulator.controller().Status().motion_possible == 0);
  cure(rig.emulator);
  rig.Run(20);
  CHECK(rig.emulator.controller().Status().motion_possible == 0);  // Never by itself.
  Ready(motion);
  CHECK(rig.emulator.controller().Status().motion_possible == 1);
  CHECK(rig.arm.references == references);  // And nothing has moved.
}

TEST_CASE("drives that give up are a contact stop", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  rig.arm.Fail("joint 2 is blocked");
  rig.Run(2);
  CHECK(Command(motion, sm::Command::kCheckMotionReady).subcode == Code(NotReady::kContactStop));
  Ready(motion);
  CHECK(rig.arm.Servo().fault.empty());
}

}  // namespace tubetwin::test
