// The devices' contracts on the twin, on the recorder before it, and on the replay of that.

#include "hw_bridge/recording/cell_recorder.h"
#include "hw_bridge/recording/replay_cell.h"
#include "tests/contract/device_contract.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "tests/twin_cell/cell_fixture.h"

namespace tubetwin {
namespace {

using Suite = void (*)(Cell&);

TwinCellOptions SmallScans(const Pile& pile) {
  TwinCellOptions options = test::NominalOptions(pile);
  options.scan.width = 129;
  options.scan.height = 96;
  return options;
}

TEST_CASE("Twin, recorder and replay keep the contract of each device", "[contract]") {
  const auto [name, suite] = GENERATE(table<const char*, Suite>({
      {"clock", test::CheckClockContract},
      {"arm", test::CheckArmContract},
      {"gripper", test::CheckGripperContract},
      {"wrist", test::CheckWristContract},
      {"scanner", test::CheckScannerContract},
      {"all, one after another", test::CheckDeviceContracts},
  }));
  CAPTURE(name);
  const Pile pile = test::OneTube("pvc_a", Vector3(0.1, 0.1, 0.0125));
  {
    INFO("twin");
    TwinCell twin(pile, SmallScans(pile));
    suite(twin.cell());
  }
  const TemporaryFolder folder;
  {
    INFO("recorder");
    TwinCell twin(pile, SmallScans(pile));
    CellRecorder recorder(twin.cell(), {}, folder / "cell.rec.zst");
    suite(recorder.cell());
    recorder.Finish("the suite is over");
  }
  INFO("replay");
  ReplayCell replay{CellRecording(folder / "cell.rec.zst")};
  suite(replay.cell());
  replay.Finish();
  CHECK_FALSE(replay.tally().difference.has_value());
  CHECK(replay.tally().more_reads == 0);
  CHECK(replay.tally().missing_reads == 0);
}

}  // namespace
}  // namespace tubetwin
