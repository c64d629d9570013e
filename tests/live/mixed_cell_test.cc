// Cells of which some devices are emulated and the others the twin's.

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

#include "hw_bridge/cell/wall_clock.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/live/emulated_cell.h"
#include "twin/live/live_cell.h"
#include "twin/round/twin_setup.h"

namespace tubetwin {
namespace {

/// An emulated cell that runs by itself, as `emulate` does.
class RunningEmulation {
 public:
  RunningEmulation() {
    scenario.pile.count = 1;
    const Pile pile = ScenarioPile(scenario);
    twin_.emplace(pile, ScenarioTwin(scenario, ScenarioPhysics(scenario, pile.part), {1}));
    cell_.emplace(*twin_, scenario, EmulationPlaces{"127.0.0.1", true, folder_.path(), false});
    reaching = cell_->Reaching();
    thread_ = std::jthread([this](const std::stop_token& stop) {
      Pace pace(1.0, std::chrono::milliseconds(40));
      while (!stop.stop_requested()) {
        const TimeNs next = cell_->now() + kControlPeriod;
        if (pace.Due(cell_->now()) < next) {
          cell_->Poll();
          std::this_thread::sleep_for(std::chrono::microseconds(200));
        } else {
          cell_->Step();
        }
      }
    });
  }
  Scenario scenario, reaching;

 private:
  TemporaryFolder folder_;
  std::optional<TwinCell> twin_;
  std::optional<EmulatedCell> cell_;
  std::jthread thread_;  ///< Last: ends before what it uses.
};

/// From where the arm stands, `angle_rad` with joint 6.
CheckedTrajectory Turn(const Cell& cell, double angle_rad) {
  JointTrajectory trajectory;
  trajectory.points.resize(2);
  trajectory.points[0].q = trajectory.points[1].q = cell.arm.State().q;
  trajectory.points[1].q[5] += angle_rad;
  trajectory.points[1].time_s = 1.0;
  const auto checked = CheckTrajectory(cell.model.arm, trajectory);
  REQUIRE(std::holds_alternative<CheckedTrajectory>(checked));
  return std::get<CheckedTrajectory>(checked);
}

/// Whether the devices can be used after the program has computed for a second.
void CheckAfterPause(Cell& cell) {
  cell.safety.arm_silence_s = 0.4;  // A busy host; the pause is far longer.
  for (int i = 0; i < 2; ++i) {
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const GripperOutcome fingers = MoveGripper(cell, {i == 0 ? 0.06 : 0.08, 0.1, 60.0});
    INFO(fingers.outcome.reason);
    CHECK(fingers.outcome.status == WaitOutcome::Status::kDone);
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const WaitOutcome moved = RunTrajectory(cell, Turn(cell, i == 0 ? 0.3 : -0.3));
    INFO(moved.reason);
    CHECK(moved.status == WaitOutcome::Status::kDone);
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const WrenchOutcome weighed = AverageWrench(cell, 0.1);
  INFO(weighed.outcome.reason);
  CHECK(weighed.outcome.status == WaitOutcome::Status::kDone);
  CHECK(weighed.mean_K.force_N.z() > 9.0);  // The tool hangs down.
}

}  // namespace

TEST_CASE(
    "An emulated arm before the twin's other devices, and the other way round, outlast pauses",
    "[unit]") {
  RunningEmulation emulation;
  Scenario mixed = emulation.scenario;
  SECTION("the arm alone is emulated, and the twin's arm goes with it") {
    mixed.cell.arm = emulation.reaching.cell.arm;
    LiveCell live(mixed, CellPurpose::kRun, {1});
    CheckAfterPause(live.cell());
  }
  SECTION("the gripper alone is emulated") {
    mixed.cell.gripper = emulation.reaching.cell.gripper;
    LiveCell live(mixed, CellPurpose::kRun, {1});
    CheckAfterPause(live.cell());
  }
}

TEST_CASE("A second program on the same devices is refused by name, and looking is not moving",
          "[unit]") {
  RunningEmulation emulation;
  Scenario mixed = emulation.scenario;
  mixed.cell.arm = emulation.reaching.cell.arm;
  mixed.cell.wrist = emulation.reaching.cell.wrist;
  const LiveCell live(mixed, CellPurpose::kRun, {1});
  CHECK_THROWS_WITH(LiveCell(mixed, CellPurpose::kRun, {1}),
                    Catch::Contains("arm 127.0.0.1:") && Catch::Contains("is in use by process"));
  CHECK_THROWS_WITH(LiveCell(mixed, CellPurpose::kLook, {1}), Catch::Contains("wrist 127.0.0.1:"));
  Scenario arm_only = emulation.scenario;
  arm_only.cell.arm = emulation.reaching.cell.arm;
  CHECK_NOTHROW(LiveCell(arm_only, CellPurpose::kLook, {1}));
}

}  // namespace tubetwin
