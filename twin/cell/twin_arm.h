#pragma once

#include <array>
#include <optional>

#include "hw_bridge/cell/devices.h"
#include "hw_bridge/cell/servo_arm.h"
#include "models/arm/arm.h"
#include "models/base/json_fwd.h"
#include "twin/cell/cell_world.h"

namespace tubetwin {

/// The arm of the twin: computed torque at the control period through torque motors. Every step the
/// reference is interpolated on the running trajectory (never held), tau = kp e + kv ed + bias +
/// M qdd_ref + damping and friction at the reference's speed + the payload's weight, clamped to the
/// joints' effort. Stops slow the time along the path down, so they never leave it. As a ServoArm
/// it follows the references of an emulated controller in the same way.
class TwinArm : public Arm, public ServoArm {
 public:
  /// `arm` and `world` must outlive it; holds the position that the world has now.
  TwinArm(const ArmModel& arm, CellWorld& world);

  ArmState State() const override;
  CommandResult Start(const CheckedTrajectory& trajectory) override;
  CommandResult Append(const CheckedTrajectory& continuation) override;
  void Stop(StopKind kind) override;
  void SetPayload(double mass_kg, const Vector3& p_FC) override;
  CommandResult Recover() override;

  ServoState Servo() const override;
  void Follow(const ServoReference& reference) override;
  void ClearServoFault() override;

  /// Sets the motors' torques for the coming step. Call between mj_step1 and mj_step2.
  void Control();

  /// What the arm's coming steps depend on besides the world, and back. Precondition of State: no
  /// trajectory is running.
  Json StoredState() const;
  void Restore(const JsonView& state);

  /// True joint positions, not quantised; for the world's own use.
  JointVector TruePosition() const;
  /// Reference of the coming step, and whether any torque was cut to the effort limit so far: for
  /// tests of tracking.
  const JointVector& reference_q() const { return reference_.q; }
  bool clamped() const { return clamped_; }
  const JointVector& torque_Nm() const { return torque_Nm_; }

 private:
  void AdvanceReference();
  void AdvanceServo();
  double HaltTime_s(const JointVector& qd, double share, double shortest_s) const;
  JointVector PayloadTorque() const;
  void Fault(const std::string& text);

  const ArmModel& arm_;
  CellWorld& world_;
  const mjModel& model_;
  mjData& data_;
  std::array<int, kNumJoints> qpos_{}, dof_{}, motor_{};
  int link6_ = 0;
  JointVector kp_, kv_;
  std::vector<double> acceleration_, inertia_;  ///< [nv] scratch of M qdd.

  ArmMode mode_ = ArmMode::kReady;
  std::string fault_;
  JointTrajectory trajectory_;
  double progress_s_ = 0.0;
  bool done_ = true;
  /// Time along the path runs at rate_; a stop takes it to zero from ramp_from_ within ramp_s_.
  double rate_ = 1.0, ramp_from_ = 1.0, ramp_s_ = 0.0, ramp_elapsed_s_ = 0.0;
  bool stopping_ = false;
  ServoReference reference_;
  /// As a ServoArm: a reference is followed, or the arm halts from one that was the last.
  bool servo_ = false;
  std::optional<ServoReference> followed_;  ///< Of the coming period.
  double halt_s_ = 0.0, halted_s_ = 0.0;    ///< Length of the halt, 0: none; and its time.
  JointVector halt_qd_ = JointVector::Zero();
  double payload_kg_ = 0.0;
  Vector3 p_FPayload_ = Vector3::Zero();
  JointVector torque_Nm_ = JointVector::Zero();
  bool clamped_ = false;
};

}  // namespace tubetwin
