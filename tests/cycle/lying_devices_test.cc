// Devices that say what is not so, each from each moment of a pick on: the round stops, the fingers
// keep what they hold, and nothing is called placed.

#include <cmath>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/fake_round.h"

namespace tubetwin {
namespace {

using test::FakeRound;
using test::FakeTube;
using test::FakeWorld;
using test::MotionKind;
using test::TwoTubes;

/// Since when a device lies.
enum class Since { kScan, kReach, kHeld, kLift, kCarry };
constexpr Since kMoments[] = {Since::kScan, Since::kReach, Since::kHeld, Since::kLift,
                              Since::kCarry};
const char* ToString(Since since) {
  constexpr const char* kNames[] = {"scan", "reach", "held", "lift", "carry"};
  return kNames[static_cast<int>(since)];
}

struct Lie {
  const char* name;
  const char* says;  ///< The reason of the round's end, in part.
  std::function<void(FakeWorld&)> begin;
  /// From this moment on nobody can tell it from the truth any more, or need not.
  Since first = Since::kScan;
};

Lie Wrist(const char* name, const char* says, std::function<void(WrenchSample&)> lie,
          Since first = Since::kScan) {
  return {name, says, [lie](FakeWorld& w) { w.wrist.lie = lie; }, first};
}
Lie Fingers(const char* name, const char* says, std::function<void(GripperState&)> lie,
            Since first = Since::kScan) {
  return {name, says, [lie](FakeWorld& w) { w.gripper.lie = lie; }, first};
}
Lie TheArm(const char* name, const char* says, std::function<void(ArmState&)> lie) {
  return {name, says, [lie](FakeWorld& w) { w.arm.lie = lie; }};
}
Lie Stop(const char* name, ArmMode mode) {
  return {name, "", [mode](FakeWorld& w) { w.StopArm(mode, "told so"); }};
}

std::vector<Lie> WristLies() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto scaled = [](double factor) {
    return [factor](WrenchSample& s) { s.wrench_K = s.wrench_K * factor; };
  };
  const auto shifted = [](double force_N) {
    return [force_N](WrenchSample& s) { s.wrench_K.force_N.z() += force_N; };
  };
  const auto fixed = [](double force_N) {
    return [force_N](WrenchSample& s) { s.wrench_K.force_N.setConstant(force_N); };
  };
  // A bias before the round's first weighing is one that all weighings share: no lie.
  return {
      Wrist("zero", "", scaled(0.0)),
      Wrist("biased by another client", "wrist", shifted(-10.1), Since::kReach),
      Wrist("least counts", "force x is -2147.5 N, its range ends at 65.0 N", fixed(-2147.483648)),
      Wrist("most counts", "force x is 2147.5 N", fixed(2147.483647)),
      Wrist("beyond one axis", "torque x is 5.1 N m, its range ends at 5.0 N m",
            [](WrenchSample& s) { s.wrench_K.torque_Nm.x() = 5.1; }),
      Wrist("no number", "force z is nan N",
            [nan](WrenchSample& s) { s.wrench_K.force_N.z() = nan; }),
      Wrist("stuck", "the same counts for 0.1 s",
            [](WrenchSample& s) { s.problem = "the same counts for 0.1 s"; }),
      {"silent", "s old", [](FakeWorld& w) { w.wrist.silent = true; }},
      {"saturated", "saturated", [](FakeWorld& w) { w.wrist.saturated = true; }},
      Wrist("half of it", "", scaled(0.5)),
      Wrist("twice as much", "", scaled(2.0), Since::kReach),
      Wrist("upside down", "", scaled(-1.0)),
      Wrist("30 N more", "wrist", shifted(30.0), Since::kReach),
      Wrist("5 N less", "wrist", shifted(-5.0), Since::kReach),
      Wrist("4 N more than when it was lifted", "it weighed 0.5 N before", shifted(4.0),
            Since::kCarry),
      Wrist("what empty fingers weigh", "wrist and gripper disagree: the wrist weighs",
            fixed(std::numeric_limits<double>::infinity())),
  };
}

std::vector<Lie> GripperLies() {
  std::vector<Lie> out;
  for (const int fault : {0x08, 0x09, 0x0A, 0x0B, 0x0C, 0x0D, 0x0E, 0x0F}) {
    static const std::string names[] = {"fault 8",  "fault 9",  "fault 10", "fault 11",
                                        "fault 12", "fault 13", "fault 14", "fault 15"};
    const char* const name = names[fault - 8].c_str();
    out.push_back(Fingers(name, name, [fault](GripperState& s) { s.fault = fault; }));
  }
  out.push_back({"gripper silent", "s old", [](FakeWorld& w) { w.gripper.silent = true; }});
  out.push_back(
      Fingers("not activated", "not activated", [](GripperState& s) { s.activated = false; }));
  out.push_back(Fingers("commanded by another", "another client", [](GripperState& s) {
    s.problem = "another client commands the gripper";
  }));
  // Fingers that say so when they close are believed: they open again, where they are.
  out.push_back(Fingers(
      "closed on nothing", "",
      [](GripperState& s) {
        s.object = GripperObject::kAtPosition;
        s.opening_m = s.requested_m = 0.0;
      },
      Since::kLift));
  out.push_back(Fingers(
      "apart and pressing on nothing", "",
      [](GripperState& s) { s.object = GripperObject::kAtPosition; }, Since::kHeld));
  out.push_back(Fingers(
      "wide open", "gripper",
      [](GripperState& s) {
        s.object = GripperObject::kContactOpening;
        s.opening_m = 0.08;
      },
      Since::kHeld));
  return out;
}

std::vector<Lie> ArmLies() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {
      {"arm silent", "s old", [](FakeWorld& w) { w.arm.silent = true; }},
      {"arm stands still", "", [](FakeWorld& w) { w.arm.stuck = true; }},
      TheArm("a joint jumps by 1 rad", "", [](ArmState& s) { s.q[0] += 1.0; }),
      TheArm("joints that are no numbers", "no numbers", [nan](ArmState& s) { s.q[2] = nan; }),
      Stop("link lost", ArmMode::kDisconnected),
      Stop("emergency stop", ArmMode::kEmergencyStop),
      Stop("protective stop", ArmMode::kProtectiveStop),
      Stop("alarm", ArmMode::kFault),
  };
}

/// Has `begin` happen at the moment.
void At(FakeWorld& world, Since since, const std::function<void()>& begin) {
  switch (since) {
    case Since::kScan:
      world.scanner.look = [begin, look = world.scanner.look] {
        begin();
        return look();
      };
      return;
    case Since::kReach:
      return world.During(MotionKind::kDown, 1, begin);
    case Since::kHeld:
      world.gripper.on_command = [&world, begin,
                                  move = world.gripper.on_command](const GripperCommand& command) {
        const bool held = world.held() > 0;
        move(command);
        if (!held && world.held() > 0) begin();
      };
      return;
    case Since::kLift:
      return world.During(MotionKind::kLift, 2, begin);
    case Since::kCarry:
      return world.During(MotionKind::kCarry, 1, begin);
  }
}

void CheckStopped(const Lie& lie, Since since) {
  CAPTURE(lie.name, ToString(since));
  FakeWorld world(TwoTubes());
  FakeRound round(world);
  bool lies = false;
  int held = 0;
  std::size_t before = 0;
  At(world, since, [&] {
    if (lies) return;
    lies = true;
    held = world.held();
    before = world.log.size();
    lie.begin(world);
  });
  round.Run(6);
  INFO(round.attempts_text());
  REQUIRE(lies);
  CHECK(round.end() == "fault");
  CHECK_THAT(round.report.reason, Catch::Contains(lie.says));
  CHECK(round.report.placed_believed == 0);
  CHECK(world.Count(FakeTube::Place::kTray) == 0);
  CHECK(world.Count(FakeTube::Place::kLost) == 0);
  // What was held is held, and no command opened the fingers on it.
  CHECK(world.held() >= held);
}

/// As the wrist says it when nothing hangs in the fingers, from the last tare on.
std::vector<Lie> AllLies() {
  std::vector<Lie> out = WristLies();
  out.back().begin = [](FakeWorld& w) {
    w.wrist.lie = [&w](WrenchSample& s) {
      s.wrench_K.force_N = s.wrench_K.force_N.normalized() *
                           (w.model.gripper.mass_kg + w.model.gripper.coupling_mass_kg) * kGravity;
    };
  };
  for (const std::vector<Lie>& more : {GripperLies(), ArmLies()}) {
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

TEST_CASE("Whatever device lies, and from whatever moment on, the round stops with nothing placed",
          "[unit]") {
  const std::vector<Lie> lies = AllLies();
  CHECK(lies.size() >= 30);
  for (const Lie& lie : lies) {
    for (const Since since : kMoments) {
      if (since >= lie.first) CheckStopped(lie, since);
    }
  }
}

/// A round that ends with a fault, not one that lost or misplaced anything.
void CheckFault(FakeWorld& world, const std::string& says, int held) {
  FakeRound round(world);
  round.Run(4);
  INFO(round.attempts_text());
  CHECK(round.end() == "fault");
  CHECK_THAT(round.report.reason, Catch::Contains(says));
  CHECK(world.held() == held);
}

TEST_CASE("The fingers let go only where arm and gripper say that a tube is held over its slot",
          "[unit]") {
  FakeWorld elsewhere(TwoTubes());
  elsewhere.After(MotionKind::kLay, 2, [&] {
    // Less than the arm may leave its path, and yet beside the slot.
    elsewhere.arm.lie = [](ArmState& state) { state.q[0] += 0.04; };
  });
  CheckFault(elsewhere, "mm from where the tube is to be laid", 1);
  FakeWorld nothing(TwoTubes());
  nothing.After(MotionKind::kLay, 2, [&] {
    nothing.gripper.lie = [](GripperState& s) { s.object = GripperObject::kAtPosition; };
  });
  CheckFault(nothing, "the gripper holds nothing", 1);
}

TEST_CASE("A hose that others hold down may push up on the fingers while it is drawn out",
          "[unit]") {
  FakeWorld world(TwoTubes());
  world.During(MotionKind::kLift, 1,
               [&] { world.wrist.lie = [](WrenchSample& s) { s.wrench_K.force_N.z() -= 5.0; }; });
  world.During(MotionKind::kLift, 2, [&] { world.wrist.lie = {}; });
  FakeRound round(world);
  round.Run();
  INFO(round.attempts_text());
  CHECK(round.end() == "empty");
  CHECK(world.Count(FakeTube::Place::kTray) == 2);
}

TEST_CASE("A sensor that is biased between two attempts is noticed when empty fingers are weighed",
          "[unit]") {
  FakeWorld world(TwoTubes());
  world.After(MotionKind::kLay, 2,
              [&] { world.wrist.lie = [](WrenchSample& s) { s.wrench_K.force_N.z() -= 2.5; }; });
  FakeRound round(world);
  round.Run();
  CHECK(round.end() == "fault");
  CHECK_THAT(round.report.reason, Catch::Contains("2.5 N off what it was in this round") &&
                                      Catch::Contains("another client may have biased it"));
  CHECK(world.Count(FakeTube::Place::kTray) == 1);
}

}  // namespace
}  // namespace tubetwin
