#pragma once

#include "hw_bridge/cell/devices.h"
#include "models/base/json_fwd.h"
#include "models/gripper_spec.h"
#include "twin/cell/cell_world.h"

namespace tubetwin {

/// The gripper of the twin, with the real one's register behaviour: position, speed and force come
/// in steps; the fingers move at the set speed until they stand at the request (kAtPosition) or
/// have pressed with the set force without moving (kContactClosing, kContactOpening); an object
/// that is lost lets them move on to the request.
class TwinGripper : public Gripper {
 public:
  /// `world` must outlive it; the force range of the grip actuator is its own to write.
  explicit TwinGripper(CellWorld& world);

  void Command(const GripperCommand& command) override;
  GripperState State() const override;

  /// Sets the servo of the coming step. Call between mj_step1 and mj_step2.
  void Control();
  /// What the servo's coming steps depend on besides the world, and back.
  Json StoredState() const;
  void Restore(const JsonView& state);
  /// True opening between the pads, not quantised.
  double TrueOpening() const;

 private:
  enum class Phase { kMoving, kPressing, kContact, kAtPosition };
  double Travel() const;
  void MoveOn();
  void SetForceRange();

  CellWorld& world_;
  GripperSpec spec_;
  mjModel& model_;
  mjData& data_;
  int tendon_ = 0, actuator_ = 0;
  Phase phase_ = Phase::kAtPosition;
  double target_m_ = 0.0;     ///< Sum of both travels: stroke - opening.
  double reference_m_ = 0.0;  ///< Where the servo pulls to.
  double speed_m_s_ = 0.1;
  double force_N_ = 20.0;
  double contact_m_ = 0.0;  ///< Travel where the fingers met something.
  int still_ = 0;           ///< Samples in a row without motion.
};

}  // namespace tubetwin
