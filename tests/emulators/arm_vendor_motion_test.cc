// The motion port against the vendor's published server (MotoROS 1.9.12, MotionServer.c), message
// by message.

#include <cmath>
#include <functional>
#include <map>

#include "hw_bridge/emulators/yaskawa/dh_parameters.h"
#include "tests/codecs/hex.h"
#include "tests/emulators/arm_rig.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

namespace sm = simple_message;
using C = sm::Command;

/// Where a controller stands before a message comes.
const std::map<std::string, std::function<void(ArmRig&, ArmRig::Socket&)>>& States() {
  static const std::map<std::string, std::function<void(ArmRig&, ArmRig::Socket&)>> states = {
      {"servo off", [](ArmRig& r, auto&) { r.emulator.SwitchServo(false); }},
      {"not started", [](ArmRig&, auto&) {}},
      {"ready", [](ArmRig&, auto& m) { Ready(m); }},
      {"begun",
       [](ArmRig& r, auto& m) {
         Ready(m);
         Stream(m, 0, 0.0, r.arm.Servo().q);
       }},
      {"moving",
       [](ArmRig& r, auto& m) {
         Ready(m);
         const JointVector q = r.arm.Servo().q;
         Stream(m, 0, 0.0, q);
         Stream(m, 1, 0.5, q + 0.05 * kOnes);
         r.Run(5);
       }},
      {"full",
       [](ArmRig& r, auto& m) {
         Ready(m);
         const JointVector q = r.arm.Servo().q;
         Stream(m, 0, 0.0, q);
         Stream(m, 1, 5.0, q + 0.05 * kOnes);
         r.Run(5);
       }},
      {"alarm", [](ArmRig& r, auto& m) { Ready(m), r.emulator.Alarm(4315); }},
      {"lasting alarm", [](ArmRig& r, auto& m) { Ready(m), r.emulator.Alarm(4315, true); }},
      {"e-stop", [](ArmRig& r, auto& m) { Ready(m), r.emulator.EmergencyStop(); }},
      {"hold", [](ArmRig& r, auto& m) { Ready(m), r.emulator.Hold(true); }},
      {"local", [](ArmRig& r, auto& m) { Ready(m), r.emulator.SetRemote(false); }},
      {"teach", [](ArmRig& r, auto& m) { Ready(m), r.emulator.SetPlay(false); }},
      {"contact", [](ArmRig& r, auto& m) { Ready(m), r.emulator.ProtectiveStop(); }},
      {"ended",
       [](ArmRig& r, auto& m) {
         Ready(m);
         Command(m, C::kStopTrajectoryMode);
         r.Run(3);
       }},
  };
  return states;
}

sm::MotionControl Control(sm::Command command, std::int32_t group = 0) {
  return {group, 77, command, {}};
}

struct Case {
  const char* state;
  sm::MotionControl request;
  int result, subcode;
};

const Case kControls[] = {
    {"servo off", Control(C::kCheckMotionReady), 2, 5006},
    {"not started", Control(C::kCheckMotionReady), 2, 5008},
    {"ready", Control(C::kCheckMotionReady), 0, 0},
    {"ready", Control(C::kCheckMotionReady, 3), 0, 0},
    {"moving", Control(C::kCheckMotionReady), 0, 0},
    {"alarm", Control(C::kCheckMotionReady), 2, 5001},
    {"e-stop", Control(C::kCheckMotionReady), 2, 5003},
    {"teach", Control(C::kCheckMotionReady), 2, 5004},
    {"local", Control(C::kCheckMotionReady), 2, 5005},
    {"hold", Control(C::kCheckMotionReady), 2, 5007},
    {"contact", Control(C::kCheckMotionReady), 2, 5011},
    {"ended", Control(C::kCheckMotionReady), 2, 5008},
    {"ready", Control(C::kCheckQueueCount), 0, 0},
    {"ready", Control(C::kCheckQueueCount, 1), 2, -1},
    {"ready", Control(C::kCheckQueueCount, -1), 2, -1},
    {"full", Control(C::kCheckQueueCount), 0, 200},
    {"alarm", Control(C::kCheckQueueCount), 0, 0},
    {"servo off", Control(C::kStopMotion), 0, 0},
    {"moving", Control(C::kStopMotion), 0, 0},
    {"moving", Control(C::kStopMotion, 2), 0, 0},
    {"alarm", Control(C::kStopMotion), 0, 0},
    {"servo off", Control(C::kStartServos), 0, 0},
    {"ready", Control(C::kStartServos), 0, 0},
    {"e-stop", Control(C::kStartServos), 2, 0},
    {"alarm", Control(C::kStartServos), 2, 0},
    {"ready", Control(C::kStopServos), 0, 0},
    {"servo off", Control(C::kStopServos), 0, 0},
    {"ready", Control(C::kResetAlarm), 0, 0},
    {"alarm", Control(C::kResetAlarm), 0, 0},
    {"lasting alarm", Control(C::kResetAlarm), 2, 0},
    {"servo off", Control(C::kStartTrajectoryMode), 0, 0},
    {"not started", Control(C::kStartTrajectoryMode), 0, 0},
    {"not started", Control(C::kStartTrajectoryMode, 5), 0, 0},
    {"ready", Control(C::kStartTrajectoryMode), 0, 0},
    {"moving", Control(C::kStartTrajectoryMode), 0, 0},
    {"alarm", Control(C::kStartTrajectoryMode), 0, 0},
    {"lasting alarm", Control(C::kStartTrajectoryMode), 5, 5001},
    {"e-stop", Control(C::kStartTrajectoryMode), 5, 5003},
    {"teach", Control(C::kStartTrajectoryMode), 5, 5004},
    {"local", Control(C::kStartTrajectoryMode), 5, 5005},
    {"hold", Control(C::kStartTrajectoryMode), 5, 5007},
    {"contact", Control(C::kStartTrajectoryMode), 0, 0},
    {"ended", Control(C::kStartTrajectoryMode), 0, 0},
    {"not started", Control(C::kStopTrajectoryMode), 0, 0},
    {"ready", Control(C::kStopTrajectoryMode), 0, 0},
    {"begun", Control(C::kStopTrajectoryMode), 0, 0},
    {"moving", Control(C::kStopTrajectoryMode), 2, 0},
    {"moving", Control(C::kDisconnect), 2, 0},
};

/// A first point of where the arm is, but for what a case changes.
sm::GroupPoint Here(ArmRig& rig) {
  sm::GroupPoint point;
  point.q_rad = sm::ToSlots(rig.arm.Servo().q);
  return point;
}

struct PointCase {
  const char* state;
  std::int32_t sequence;
  std::function<void(sm::GroupPoint&)> change;
  int result, subcode;
};

const PointCase kPoints[] = {
    {"servo off", 0, [](auto&) {}, 5, 5006},
    {"not started", 0, [](auto&) {}, 5, 5008},
    {"alarm", 0, [](auto&) {}, 5, 5001},
    {"e-stop", 1, [](auto&) {}, 5, 5003},
    {"hold", 1, [](auto& p) { p.group = 9; }, 5, 5007},
    {"contact", 1, [](auto&) {}, 5, 5011},
    {"ready", 0, [](auto&) {}, 0, 0},
    {"ready", 0, [](auto& p) { p.time_s = 3.5f; }, 0, 0},
    {"ready", 0, [](auto& p) { p.valid_fields = 15; }, 0, 0},
    {"ready", 0, [](auto& p) { p.valid_fields = 6; }, 3, 3015},
    {"ready", 0, [](auto& p) { p.valid_fields = 5; }, 3, 3015},
    {"ready", 0, [](auto& p) { p.valid_fields = 3; }, 3, 3015},
    {"ready", 0, [](auto& p) { p.valid_fields = 0; }, 3, 3015},
    {"ready", 0, [](auto& p) { p.group = 1; }, 3, 3004},
    {"ready", 0, [](auto& p) { p.group = -1; }, 3, 3004},
    {"ready", -1, [](auto&) {}, 3, 3005},
    {"ready", -2147483647, [](auto&) {}, 3, 3005},
    {"ready", 0, [](auto& p) { p.q_rad[0] += 0.0006f; }, 3, 3011},
    {"ready", 0, [](auto& p) { p.q_rad[5] -= 0.0006f; }, 3, 3011},
    {"ready", 0, [](auto& p) { p.q_rad[0] += 0.0004f; }, 0, 0},
    {"ready", 0, [](auto& p) { p.q_rad[8] = 1.0f; }, 0, 0},
    {"ready", 0, [](auto& p) { p.qd_rad_s[0] = 2.9f; }, 0, 0},
    {"ready", 0, [](auto& p) { p.qd_rad_s[0] = 3.1f; }, 3, 3013},
    {"ready", 0, [](auto& p) { p.qd_rad_s[5] = -4.9f; }, 0, 0},
    {"ready", 0, [](auto& p) { p.qd_rad_s[5] = -5.1f; }, 3, 3013},
    {"ready", 0, [](auto& p) { p.qd_rad_s[7] = 1.0f; }, 3, 3013},
    {"ready", 0, [](auto& p) { p.qd_rad_s[7] = 0.9f; }, 0, 0},
    {"ready", 0, [](auto& p) { p.qdd_rad_s2[0] = 1e9f; }, 0, 0},
    // The first axis' speed is looked at before the second's place, and after its own.
    {"ready", 0, [](auto& p) { p.qd_rad_s[0] = 9, p.q_rad[1] += 1; }, 3, 3013},
    {"ready", 0, [](auto& p) { p.qd_rad_s[1] = 9, p.q_rad[1] += 1; }, 3, 3011},
    {"begun", 1, [](auto& p) { p.time_s = 0.1f; }, 0, 0},
    {"begun", 4711, [](auto& p) { p.time_s = 0.1f; }, 0, 0},
    {"begun", 1, [](auto& p) { p.time_s = 0.0f; }, 0, 0},
    {"begun", 1, [](auto& p) { p.time_s = -5.0f; }, 0, 0},
    {"begun", 1, [](auto& p) { p.time_s = 0.1f, p.qd_rad_s[7] = 9; }, 0, 0},
    {"begun", 1, [](auto& p) { p.time_s = 0.1f, p.qd_rad_s[2] = 4.1f; }, 3, 3013},
    {"begun", 1, [](auto& p) { p.time_s = 9, p.q_rad[3] += 6; }, 0, 0},  // No soft limits here.
    {"ready", 1, [](auto& p) { p.time_s = 0.1f; }, 0, 0},
    {"full", 2, [](auto& p) { p.time_s = 6.0f; }, 1, 0},
    {"full", 2, [](auto& p) { p.time_s = 6.0f, p.group = 2; }, 3, 3004},
};

}  // namespace

TEST_CASE("controls are answered as by the vendor's server", "[unit]") {
  for (const Case& one : kControls) {
    const auto command = static_cast<std::int32_t>(one.request.command);
    CAPTURE(one.state, command, one.request.group);
    ArmRig rig;
    ArmRig::Socket motion = rig.Motion();
    States().at(one.state)(rig, motion);
    const sm::Message reply = motion.Ask(sm::Request(one.request));
    CHECK(reply == sm::Reply(sm::MotionReply{
                       one.request.group, 77, command, sm::Result(one.result), one.subcode, {}}));
  }
}

TEST_CASE("points are answered as by the vendor's server, alone and for several groups", "[unit]") {
  for (const bool ex : {false, true}) {
    for (const PointCase& one : kPoints) {
      const auto number = &one - kPoints;
      CAPTURE(ex, number, one.state, one.sequence);
      ArmRig rig;
      ArmRig::Socket motion = rig.Motion();
      States().at(one.state)(rig, motion);
      sm::GroupPoint p = Here(rig);
      one.change(p);
      sm::Body body = sm::JointPoint{p.group, one.sequence, p.valid_fields, p.time_s,
                                     p.q_rad, p.qd_rad_s,   p.qdd_rad_s2};
      if (ex) body = sm::JointPointEx{1, one.sequence, {p}};
      CHECK(motion.Ask(sm::Request(body)) ==
            sm::Reply(sm::MotionReply{
                p.group, one.sequence, ex ? 2016 : 14, sm::Result(one.result), one.subcode, {}}));
    }
  }
}

TEST_CASE("a single point's time has a limit that several groups' has not", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  sm::GroupPoint p = Here(rig);
  p.time_s = 14400.0f;
  const auto reply = [&](const sm::Body& body) {
    return std::get<sm::MotionReply>(motion.Ask(sm::Request(body)).body);
  };
  CHECK(reply(sm::JointPoint{0, 0, 7, p.time_s, p.q_rad, {}, {}}).subcode == 3016);
  CHECK(reply(sm::JointPointEx{1, 0, {p}}).result == sm::Result::kSuccess);
  // All groups are looked at for their number and their fields before any is taken.
  p.time_s = 0.0f;
  sm::GroupPoint other = p;
  other.group = 1;
  CHECK(reply(sm::JointPointEx{2, 0, {p, other}}).subcode == 3004);
  CHECK(reply(sm::JointPointEx{2, 0, {p, other}}).group == 1);
  // A group that comes twice is busy with the first.
  p.time_s = 14500.0f;
  CHECK(reply(sm::JointPointEx{2, 3, {p, p}}).result == sm::Result::kBusy);
}

TEST_CASE("messages have the size that their id says, whatever comes with them", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  const auto ask = [&](const std::string& hex, std::size_t size) {
    motion.Send(FromHex(hex));
    return ToHex(motion.Receive(size, 50));
  };
  const auto hex = [](const std::string& text) { return ToHex(FromHex(text)); };
  const std::string reply = "48000000 d2070000 03000000 01000000 ";
  const auto invalid = [&](const char* head, const char* subcode) {
    return hex(reply + head + " 03000000 " + subcode + " 00*40");
  };
  // Unknown, or of another port.
  for (const char* id : {"63070000", "d4070000", "d6070000", "dc070000", "dd070000", "02000000",
                         "e3070000", "e5070000"}) {
    CAPTURE(id);
    CHECK(ask("0c000000 " + std::string(id) + " 02000000 00000000", 76) ==
          invalid((std::string("ffffffff ffffffff ") + id).c_str(), "bb0b0000"));
  }
  // Too short: sequence and command are looked for in what is there.
  CHECK(ask("40000000 d1070000 02000000 00000000 00000000 09000000", 76) ==
        invalid("00000000 09000000 00000000", "b90b0000"));
  CHECK(ask("40000000 d1070000 02000000 00000000 05000000 09000000 a50d0300", 76) ==
        invalid("00000000 09000000 a50d0300", "b90b0000"));
  CHECK(ask("94000000 0e000000 02000000 00000000 00000000 2a000000", 76) ==
        invalid("00000000 2a000000 0e000000", "b90b0000"));
  CHECK(ask("18000000 e2070000 02000000 00000000 00000000 01000000", 76) ==
        invalid("00000000 00000000 e2070000", "b90b0000"));
  CHECK(ask("0c000000 d3070000 02000000 00000000", 76) ==
        invalid("ffffffff ffffffff d3070000", "b90b0000"));
  CHECK(ask("0c000000 e0070000 02000000 00000000 09000000 01000000", 76) ==
        invalid("00000000 01000000 e0070000", "b90b0000"));
  CHECK(ask("000000", 76) == invalid("ffffffff ffffffff 00000000", "b90b0000"));
  // Comm type and reply code do not count, but answers are not answered.
  const std::string ready = " 00000000 00000000 a50d0300 00*40";
  const std::string is_ready = hex(reply + "00000000 00000000 a50d0300 00000000 00000000 00*40");
  CHECK(ask("40000000 d1070000 00000000 05000000" + ready, 76) == is_ready);
  CHECK(ask("40000000 d1070000 01000000 00000000" + ready, 76) == is_ready);
  CHECK(ask("40000000 d1070000 03000000 01000000" + ready, 76).empty());
  CHECK(ask("0c000000 63070000 03000000 00000000", 76).empty());
  // I/O by the motion port: bits and groups.
  CHECK(ask("14000000 d5070000 02000000 00000000 1a270000 01000000", 20) ==
        hex("10000000 d6070000 03000000 01000000 00000000"));
  CHECK(ask("10000000 d7070000 02000000 00000000 e9030000", 24) ==
        hex("14000000 d8070000 03000000 01000000 01000000 00000000"));
  CHECK(ask("10000000 d3070000 02000000 00000000 00000000", 24) ==
        hex("14000000 d4070000 03000000 02000000 00000000 e9030000"));
  CHECK(ask("14000000 d9070000 02000000 00000000 e9030000 00010000", 20) ==
        hex("10000000 da070000 03000000 02000000 eb030000"));
  // A tool.
  CHECK(ask("18000000 e2070000 02000000 00000000 00000000 3f000000 07000000", 76) ==
        hex(reply + "00000000 07000000 e2070000 00000000 00000000 00*40"));
  CHECK(ask("18000000 e2070000 02000000 00000000 00000000 40000000 07000000", 76) ==
        invalid("00000000 07000000 e2070000", "c90b0000"));
  CHECK(ask("18000000 e2070000 02000000 00000000 01000000 40000000 07000000", 76) ==
        invalid("01000000 07000000 e2070000", "bc0b0000"));
}

TEST_CASE("groups that are not there may be left out or sent", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  const std::string whole = sm::Encode(sm::Request(sm::JointPointEx{1, 0, {Here(rig)}}));
  REQUIRE(whole.size() == 552);
  constexpr std::size_t kOneGroup = 16 + 8 + 132;
  motion.Send(whole);
  CHECK(motion.Collect(20).size() == 76);
  motion.Send(whole.substr(0, kOneGroup));
  CHECK(motion.Collect(20).size() == 76);
  motion.Send(whole.substr(0, kOneGroup - 1));
  CHECK(ToHex(motion.Collect(20)).find("b90b0000") != std::string::npos);
  // Without a group there is nothing new to answer.
  const std::string none = sm::Encode(sm::Request(sm::JointPointEx{0, 5, {}})).substr(0, 24);
  const std::string before = sm::Encode(motion.Ask(sm::Request(sm::Ping{})));
  motion.Send(none);
  CHECK(ToHex(motion.Collect(20)) == ToHex(before));
}

TEST_CASE("what only a controller sends ends the connection", "[unit]") {
  const auto [id, size] = GENERATE(table<int, std::size_t>({{13, 44}, {15, 148}, {2002, 76}}));
  CAPTURE(id);
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  std::string bytes(size, '\0');
  bytes[4] = static_cast<char>(id & 0xff);
  bytes[5] = static_cast<char>(id >> 8);
  motion.Send(bytes.substr(0, size - 1));
  CHECK(motion.Receive(76, 20).size() == 76);
  motion.Send(bytes);
  CHECK(motion.closed());
}

TEST_CASE("the geometry that is told leads to the flange", "[unit]") {
  ArmRig rig;
  ArmRig::Socket motion = rig.Motion();
  const sm::Message reply = motion.Ask(sm::Request(sm::GetDhParameters{}));
  CHECK(reply.reply == sm::ReplyCode::kSuccess);
  const auto& values = std::get<sm::DhParameters>(reply.body).values;
  for (std::size_t i = 24; i < values.size(); ++i) CHECK(values[i] == 0.0f);
  const ArmModel& arm = PaperCell().arm;
  const auto at = [&](const JointVector& q) {
    RigidTransform X = RigidTransform::Identity();
    for (int i = 0; i < kNumJoints; ++i) {
      const float* const link = values.data() + 4 * i;
      X = X * Eigen::AngleAxisd(link[0] + q[i], Vector3::UnitZ()) *
          Eigen::Translation3d(0, 0, link[1]) * Eigen::Translation3d(link[2], 0, 0) *
          Eigen::AngleAxisd(link[3], Vector3::UnitX());
    }
    return X;
  };
  // The base's frame drops out of where the flange goes from its place at zero.
  const JointVector zero = JointVector::Zero();
  const RigidTransform X_0F = at(zero), X_BF = FlangePose(arm, zero);
  for (int i = 0; i < 20; ++i) {
    JointVector q;
    for (int k = 0; k < kNumJoints; ++k) q[k] = std::sin(1.7 * i + 0.9 * k);
    const double told_m = (X_0F.inverse() * at(q).translation()).norm();
    const double real_m = (X_BF.inverse() * FlangePose(arm, q).translation()).norm();
    CHECK(told_m == Approx(real_m).margin(1e-5));
  }
}

}  // namespace tubetwin::test
