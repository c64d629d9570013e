#include "twin/app/calibrate/take_view.h"

#include "hw_bridge/cell/wall_clock.h"
#include "models/base/error.h"
#include "models/base/text.h"
#include "twin/live/live_cell.h"

namespace tubetwin {
namespace {

/// What an arm at rest may be off between two readings, and how fast it seems to be.
const double kSame_rad = Radians(0.01);
constexpr double kRest_rad_s = 0.002;

void RequireRest(const ArmState& state) {
  if (state.q.allFinite() && state.qd.allFinite() && state.qd.cwiseAbs().maxCoeff() < kRest_rad_s) {
    return;
  }
  throw Error(ErrorKind::kDevice, std::string("calibrate: the arm (") + ToString(state.mode) +
                                      ") is not at rest; wait until it stands still");
}

}  // namespace

TakenView TakeView(const Scenario& scenario, Parallelism parallelism) {
  LiveCell live(scenario, CellPurpose::kLook, parallelism);
  Cell& cell = live.cell();
  const ArmState before = cell.arm.State();
  RequireRest(before);
  TakenView out{Scan(cell), before.q};
  const ArmState after = cell.arm.State();
  RequireRest(after);
  const double moved_rad = (after.q - before.q).cwiseAbs().maxCoeff();
  if (moved_rad > kSame_rad) {
    throw Error(ErrorKind::kDevice, "calibrate: a joint turned by " + Number(Degrees(moved_rad)) +
                                        " degrees during the scan, allowed are " +
                                        Number(Degrees(kSame_rad)) + "; nothing was written");
  }
  return out;
}

Vector3 TakeTouch(const Scenario& scenario, const Vector3& p_FTip) {
  scenario.cell.ValidateOrThrow();
  if (!scenario.cell.arm.IsDevice()) {
    throw Error(ErrorKind::kConfig, "cell.arm.driver: is '" + scenario.cell.arm.driver +
                                        "', whose joints nobody guided to a place; allowed is a "
                                        "cell file with a device");
  }
  const WallClock clock(scenario.rate);
  const CellModel model = ScenarioModel(scenario);
  const auto arm =
      scenario.cell.arm.Connect(ScenarioContext(scenario, model, clock, CellPurpose::kLook));
  const ArmState state = arm->State();
  RequireRest(state);
  return FlangePose(model.arm, state.q) * p_FTip;
}

}  // namespace tubetwin
