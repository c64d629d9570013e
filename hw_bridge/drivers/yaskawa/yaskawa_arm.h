#pragma once

#include <memory>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/drivers/yaskawa/yaskawa_config.h"
#include "models/arm/arm.h"

namespace tubetwin {

/// An arm behind a Yaskawa controller with MotoROS 1 (YRC1000: little-endian), by simple_message. A
/// thread of its own talks to the motion and state ports; the methods only take a lock.
///
/// Trajectories are streamed as points up to 40 ms apart with velocities, 0.2 s ahead of the arm:
/// what the controller has of them it runs, whatever happens to this program. So StopKind::kOnPath
/// ramps down behind that, except for slow motions (joints up to 0.1 rad/s), which stop at once as
/// kFast does: STOP_MOTION, whose ramp is the controller's.
///
/// State().time is when the newest feedback came; progress_s is where the controller is by its
/// queue. kHolding: the controller makes the arm wait or crawl. A refusal, an alarm, a stop, a
/// controller that is no longer ready: the rest of the motion is dropped, and the mode with its
/// text stays until Recover(), which resets alarms, powers the drives and starts the job (one
/// START_TRAJ_MODE). A link that is closed, silent (states: 0.2 s in motion, 1 s at rest; answers:
/// 0.4 s) or speaks nonsense is lost for good: STOP_MOTION is sent if it still can be, then
/// kDisconnected.
///
/// SetPayload changes nothing: the controller knows its tools' loads by itself.
class YaskawaArm : public Arm {
 public:
  /// Connects, awaits the first state and, when armed, turns trajectory mode on if servo power and
  /// job are all that is missing (a stop or an alarm stays, see State()). At most 8 s (of cell time
  /// where that is slower than the wall's). Not armed: the motion port is not connected, no byte is
  /// sent, Start and Recover are rejected. `model` and `clock` must outlive it; the clock tells
  /// Now() to any thread. Throws Error(kConfig), and Error(kDevice) naming device, place and what
  /// was awaited.
  YaskawaArm(const YaskawaConfig& config, const ArmModel& model, const CellClock& clock);
  /// Stops a motion and ends trajectory mode. Within 1 s.
  ~YaskawaArm() override;

  ArmState State() const override;
  CommandResult Start(const CheckedTrajectory& trajectory) override;
  CommandResult Append(const CheckedTrajectory& continuation) override;
  void Stop(StopKind kind) override;
  void SetPayload(double mass_kg, const Vector3& p_FC) override;
  CommandResult Recover() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tubetwin
