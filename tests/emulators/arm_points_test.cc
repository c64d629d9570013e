// Which points of a trajectory the emulated controller takes, and which it refuses.

#include <cmath>
#include <functional>
#include <optional>

#include "tests/emulators/arm_rig.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin::test {
namespace {

namespace sm = simple_message;
using sm::Invalid;
using sm::NotReady;
using sm::Result;

/// What a point is answered with that differs from a good first one by `change`.
std::pair<Result, std::int32_t> AskPoint(ArmRig& rig, ArmRig::Socket& motion,
                                         const std::function<void(sm::JointPoint&)>& change) {
  sm::JointPoint point;
  point.q_rad = sm::ToSlots(rig.arm.Servo().q);
  change(point);
  const auto reply = std::get<sm::MotionReply>(motion.Ask(sm::Request(point)).body);
  CHECK(reply.command == 14);
  CHECK(reply.sequence == point.sequence);
  return std::pair(reply.result, reply.subcode);
}

std::pair<Result, std::int32_t> InvalidFor(Invalid why) {
  return std::pair(Result::kInvalid, Code(why));
}

}  // namespace

TEST_CASE("points are refused with the documented subcodes", "[unit]") {
  ArmEmulatorConfig config = ArmRig::Loopback();
  config.server = GENERATE(ArmServer::kMotoRos1, ArmServer::kStrict);
  ArmRig rig(config);
  ArmRig::Socket motion = rig.Motion();
  const auto ask = [&](auto change) { return AskPoint(rig, motion, change); };

  CHECK(ask([](sm::JointPoint&) {}) == std::pair(Result::kNotReady, Code(NotReady::kNotStarted)));
  Ready(motion);
  CHECK(ask([](sm::JointPoint& p) { p.valid_fields = 3; }) == InvalidFor(Invalid::kInsufficient));
  CHECK(ask([](sm::JointPoint& p) { p.group = 1; }) == InvalidFor(Invalid::kGroup));
  CHECK(ask([](sm::JointPoint& p) { p.sequence = -1; }) == InvalidFor(Invalid::kSequence));
  CHECK(ask([](sm::JointPoint& p) { p.time_s = 14400; }) == InvalidFor(Invalid::kTime));
  CHECK(ask([](sm::JointPoint& p) { p.time_s = NAN; }) == InvalidFor(Invalid::kData));
  CHECK(ask([](sm::JointPoint& p) { p.q_rad[2] = NAN; }) == InvalidFor(Invalid::kData));
  CHECK(ask([](sm::JointPoint& p) { p.qd_rad_s[1] = NAN; }) == InvalidFor(Invalid::kData));
  CHECK(ask([](sm::JointPoint& p) { p.qd_rad_s[1] = 3.0f; }) == InvalidFor(Invalid::kSpeed));
  // Of the order in which they are looked for.
  CHECK(ask([](sm::JointPoint& p) { p.group = 1, p.valid_fields = 0, p.sequence = -1; }) ==
        InvalidFor(Invalid::kGroup));
  CHECK(ask([](sm::JointPoint& p) { p.valid_fields = 0, p.time_s = 1e6f; }) ==
        InvalidFor(Invalid::kInsufficient));
  CHECK(ask([](sm::JointPoint& p) { p.time_s = 1e6f, p.sequence = -1; }) ==
        InvalidFor(Invalid::kTime));
  // 30 pulses at 1000 for each degree are 0.03 degrees.
  const auto off = [&](double degrees) {
    return [degrees](sm::JointPoint& p) { p.q_rad[3] += static_cast<float>(Radians(degrees)); };
  };
  CHECK(ask(off(0.0311)) == InvalidFor(Invalid::kStartPosition));
  CHECK(ask(off(-0.0311)) == InvalidFor(Invalid::kStartPosition));
  CHECK(ask(off(0.029)).first == Result::kSuccess);

  rig.emulator.Refuse(Code(Invalid::kAcceleration), 2);
  const auto next = [](sm::JointPoint& p) { p.sequence = 1, p.time_s = 0.1f; };
  CHECK(ask(next) == InvalidFor(Invalid::kAcceleration));
  CHECK(ask(next) == InvalidFor(Invalid::kAcceleration));
  CHECK(ask(next).first == Result::kSuccess);
}

TEST_CASE("what MotoROS takes without a look is refused by the strict choice alone", "[unit]") {
  const bool strict = GENERATE(false, true);
  ArmEmulatorConfig config = ArmRig::Loopback();
  config.server = strict ? ArmServer::kStrict : ArmServer::kMotoRos1;
  ArmRig rig(config);
  ArmRig::Socket motion = rig.Motion();
  Ready(motion);
  const std::pair taken(Result::kSuccess, 0);
  const auto ask = [&](auto change) { return AskPoint(rig, motion, change); };
  const auto either = [&](Invalid why) { return strict ? InvalidFor(why) : taken; };

  // Speeds are compared by their whole part: joint 2 turns 2.269 rad/s at most.
  CHECK(ask([](sm::JointPoint& p) { p.qd_rad_s[1] = 2.28f; }) == either(Invalid::kSpeed));
  CHECK(ask([](sm::JointPoint& p) { p.time_s = -1.0f; }) == either(Invalid::kTime));
  CHECK(ask([](sm::JointPoint&) {}) == taken);
  // Not later than the last one: dropped, and nothing moves.
  CHECK(ask([](sm::JointPoint& p) { p.sequence = 1; }) == either(Invalid::kTime));
  rig.Run(5);
  CHECK(ask([](sm::JointPoint& p) { p.sequence = 2, p.q_rad[0] += 0.1f; }) ==
        either(Invalid::kTime));
  rig.Run(20);
  CHECK(rig.arm.references == 0);
  // The order of numbers is nobody's matter; the trajectory's start while another runs is.
  CHECK(ask([](sm::JointPoint& p) { p.sequence = 7, p.time_s = 0.4f; }) == taken);
  rig.Run(5);
  CHECK(ask([](sm::JointPoint&) {}) == either(Invalid::kSequence));
  CHECK(Command(motion, sm::Command::kStopMotion).result == Result::kSuccess);
  CHECK(ask([](sm::JointPoint& p) { p.sequence = 8, p.time_s = 0.5f; }) ==
        either(Invalid::kSequence));
}

}  // namespace tubetwin::test
