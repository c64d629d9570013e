#include "twin/live/jog.h"

#include <algorithm>
#include <cmath>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

constexpr double kSpeed_deg_s = 1.0;
constexpr double kPeak = 1.5;  ///< Of a cubic from rest to rest, against its mean speed.
constexpr double kShortest_s = 0.5, kPatience_s = 3.0;
const double kThere_rad = Radians(0.05);

CheckedTrajectory JogTurn(const ArmModel& model, const JointVector& q, const JogOptions& options) {
  TrajectoryPoint from, to;
  from.q = to.q = q;
  to.q[options.joint - 1] += Radians(options.degrees);
  to.time_s = std::max(kShortest_s, kPeak * std::abs(options.degrees) / kSpeed_deg_s);
  const auto checked = CheckTrajectory(model, {{from, to}});
  if (const auto* refused = std::get_if<TrajectoryRejection>(&checked)) {
    throw Error(ErrorKind::kUsage, "jog: " + refused->reason + "; turn the joint the other way");
  }
  return std::get<CheckedTrajectory>(checked);
}

void RequireAllowed(const JogOptions& options) {
  if (options.joint < 1 || options.joint > kNumJoints) {
    throw Error(ErrorKind::kUsage, "--joint is " + std::to_string(options.joint) +
                                       ", allowed are 1 (next to the base) to 6");
  }
  if (!(std::abs(options.degrees) <= kMaxJog_deg) || std::abs(options.degrees) < kLeastJog_deg) {
    throw Error(ErrorKind::kUsage, "--degrees is " + Number(options.degrees) +
                                       ", allowed are -1 to 1, at least 0.001 either way: "
                                       "jog once more to go on");
  }
}

std::string Told(const ArmState& state) {
  return std::string("arm is ") + ToString(state.mode) +
         (state.fault.empty() ? "" : ": " + state.fault);
}

}  // namespace

JointVector Jog(Arm& arm, const ArmModel& model, CellClock& clock, const JogOptions& options) {
  RequireAllowed(options);
  const CheckedTrajectory turn = JogTurn(model, arm.State().q, options);
  const CommandResult started = arm.Start(turn);
  if (!started.accepted()) throw Error(ErrorKind::kDevice, "jog: " + started.reason);
  const TimeNs end = clock.Now() + FromSeconds(2.0 * turn.duration_s() + kPatience_s);
  ArmState state = arm.State();
  bool stopped = false;
  while (state.mode == ArmMode::kMoving || state.mode == ArmMode::kHolding) {
    const bool late = clock.Now() >= end;
    if (!stopped && (late || (options.stop_requested && options.stop_requested()))) {
      arm.Stop(StopKind::kOnPath);
      stopped = true;
    }
    if (late && clock.Now() >= end + FromSeconds(kPatience_s)) break;
    clock.AdvanceTo(clock.Now() + kControlPeriod);
    state = arm.State();
  }
  if (stopped) throw Error(ErrorKind::kDevice, "jog: stopped on the way; " + Told(state));
  const JointVector& goal = turn.trajectory().points.back().q;
  if (state.mode != ArmMode::kReady || (state.q - goal).cwiseAbs().maxCoeff() > kThere_rad) {
    throw Error(ErrorKind::kDevice,
                "jog: joint " + std::to_string(options.joint) + " is at " +
                    Number(Degrees(state.q[options.joint - 1])) + " degrees, it should be at " +
                    Number(Degrees(goal[options.joint - 1])) + "; " + Told(state));
  }
  return state.q;
}

}  // namespace tubetwin
