#include "twin/cell/twin_arm.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "models/base/error.h"
#include "models/base/json.h"
#include "scenes/engine/mj_handles.h"
#include "twin/cell/arm_body.h"

namespace tubetwin {
namespace {

// Stiffness of the drives' position loops (motion.md 4), Nm/rad.
constexpr std::array<double, kNumJoints> kStiffness_Nm = {30e3, 30e3, 18e3, 5e3, 4e3, 4e3};

constexpr double kEncoderStep_rad = 1e-5;
constexpr double kSpeedStep_rad_s = 1e-4;
const double kStartTolerance_rad = Radians(0.2);  ///< The vendor's 30 pulses.
/// Points of a continuation must meet the end of what runs.
constexpr double kJoinTolerance_rad = 1e-4;
/// A joint this far behind its reference is blocked: protective stop, as the controller does.
constexpr double kFollowingError_rad = 0.05;
/// Friction feed-forward changes sign over this speed, to stay smooth through standstill.
constexpr double kFrictionSpeed_rad_s = 0.01;

// Share of the acceleration limits that a stop uses, and its shortest ramp.
constexpr double kOnPathShare = 0.5, kOnPathShortest_s = 0.020;
constexpr double kFastShare = 0.9, kFastShortest_s = 0.008;

/// A halting arm's reference stands below this.
constexpr double kStandstill_rad_s = 1e-9;

double Quantised(double value, double step) { return std::round(value / step) * step; }

}  // namespace

TwinArm::TwinArm(const ArmModel& arm, CellWorld& world)
    : arm_(arm),
      world_(world),
      model_(world.model()),
      data_(world.data()),
      acceleration_(model_.nv),
      inertia_(model_.nv) {
  const mjModel& model = model_;
  std::vector<mjtNum> M(static_cast<std::size_t>(model.nv) * model.nv);
  mj_fullM(&model, &data_, M.data());
  for (int i = 0; i < kNumJoints; ++i) {
    const int joint = IdOf(model, mjOBJ_JOINT, ArmJointName(i));
    qpos_[i] = model.jnt_qposadr[joint];
    dof_[i] = model.jnt_dofadr[joint];
    motor_[i] = IdOf(model, mjOBJ_ACTUATOR, ArmJointName(i));
    kp_[i] = kStiffness_Nm[i];
    // Critical damping at the pose of construction; the reflected rotors dominate everywhere.
    kv_[i] = 2.0 * std::sqrt(kp_[i] * M[static_cast<std::size_t>(dof_[i]) * (model.nv + 1)]);
  }
  link6_ = model.jnt_bodyid[IdOf(model, mjOBJ_JOINT, ArmJointName(kNumJoints - 1))];
  reference_.q = TruePosition();
}

JointVector TwinArm::TruePosition() const {
  JointVector q;
  for (int i = 0; i < kNumJoints; ++i) q[i] = data_.qpos[qpos_[i]];
  return q;
}

ArmState TwinArm::State() const {
  ArmState state;
  state.time = world_.now();
  state.mode = mode_;
  for (int i = 0; i < kNumJoints; ++i) {
    state.q[i] = Quantised(data_.qpos[qpos_[i]], kEncoderStep_rad);
    state.qd[i] = Quantised(data_.qvel[dof_[i]], kSpeedStep_rad_s);
  }
  state.progress_s = progress_s_;
  state.planned_s = trajectory_.duration_s();
  state.done = done_;
  state.fault = fault_;
  return state;
}

CommandResult TwinArm::Start(const CheckedTrajectory& trajectory) {
  const auto rejected = [](const std::string& reason) {
    return CommandResult{CommandResult::Status::kRejected, reason};
  };
  if (mode_ != ArmMode::kReady) {
    return rejected(std::string("arm is ") + ToString(mode_) +
                    (fault_.empty() ? "" : ": " + fault_));
  }
  const JointVector off = TruePosition() - trajectory.trajectory().points.front().q;
  int worst = 0;
  const double largest = off.cwiseAbs().maxCoeff(&worst);
  if (largest > kStartTolerance_rad) {
    return rejected("joint " + std::to_string(worst + 1) + " is " +
                    std::to_string(Degrees(largest)) +
                    " degrees from the trajectory's first point, 0.2 allowed");
  }
  trajectory_ = trajectory.trajectory();
  progress_s_ = 0.0;
  done_ = false;
  stopping_ = false;
  rate_ = 1.0;
  mode_ = ArmMode::kMoving;
  return {};
}

CommandResult TwinArm::Append(const CheckedTrajectory& continuation) {
  const auto rejected = [](const std::string& reason) {
    return CommandResult{CommandResult::Status::kRejected, reason};
  };
  if (mode_ != ArmMode::kMoving || stopping_ || servo_) {
    return rejected("no trajectory is running");
  }
  const std::vector<TrajectoryPoint>& points = continuation.trajectory().points;
  const double gap = (points.front().q - trajectory_.points.back().q).cwiseAbs().maxCoeff();
  if (gap > kJoinTolerance_rad) {
    return rejected("the continuation begins " + std::to_string(Degrees(gap)) +
                    " degrees from the end of the running trajectory");
  }
  const double offset_s = trajectory_.duration_s() - points.front().time_s;
  for (std::size_t i = 1; i < points.size(); ++i) {
    TrajectoryPoint point = points[i];
    point.time_s += offset_s;
    trajectory_.points.push_back(point);
  }
  return {};
}

double TwinArm::HaltTime_s(const JointVector& qd, double share, double shortest_s) const {
  double ramp_s = shortest_s;
  for (int i = 0; i < kNumJoints; ++i) {
    // A half cosine's steepest slope is pi/2 of its mean.
    const double mean_rad_s2 = share * arm_.joints[i].max_acceleration_rad_s2 * 2.0 / kPi;
    ramp_s = std::max(ramp_s, std::abs(qd[i]) / mean_rad_s2);
  }
  return ramp_s;
}

void TwinArm::Stop(StopKind kind) {
  if (mode_ != ArmMode::kMoving || servo_) return;
  const double share = kind == StopKind::kFast ? kFastShare : kOnPathShare;
  const double shortest_s = kind == StopKind::kFast ? kFastShortest_s : kOnPathShortest_s;
  const double ramp_s = HaltTime_s(reference_.qd, share, shortest_s);
  // A second stop may only shorten what is left of the first.
  if (stopping_ && ramp_s >= ramp_s_ - ramp_elapsed_s_) return;
  stopping_ = true;
  ramp_from_ = rate_;
  ramp_s_ = ramp_s;
  ramp_elapsed_s_ = 0.0;
}

void TwinArm::SetPayload(double mass_kg, const Vector3& p_FC) {
  TT_CHECK(mass_kg >= 0.0);
  payload_kg_ = mass_kg;
  p_FPayload_ = p_FC;
}

CommandResult TwinArm::Recover() {
  if (mode_ == ArmMode::kMoving) {
    return {CommandResult::Status::kRejected, "the arm is moving"};
  }
  mode_ = ArmMode::kReady;
  fault_.clear();
  done_ = true;
  return {};
}

Json TwinArm::StoredState() const {
  TT_CHECK(mode_ == ArmMode::kReady);
  return Json{{"q_reference", std::vector<double>(reference_.q.begin(), reference_.q.end())},
              {"payload_kg", payload_kg_},
              {"p_FPayload_m", ToJson(p_FPayload_)}};
}

void TwinArm::Restore(const JsonView& state) {
  const JsonView q = state.Field("q_reference");
  if (q.Size() != kNumJoints) q.Fail("one number for each of the 6 joints is needed");
  constexpr double kFarthestTurn_rad = 20.0, kHeaviest_kg = 1000.0, kFarthest_m = 10.0;
  mode_ = ArmMode::kReady;
  reference_ = {};
  for (std::size_t k = 0; k < kNumJoints; ++k) {
    reference_.q[k] = q.Item(k).AsNumber(-kFarthestTurn_rad, kFarthestTurn_rad);
  }
  payload_kg_ = state.Field("payload_kg").AsNumber(0.0, kHeaviest_kg);
  const JsonView place = state.Field("p_FPayload_m");
  for (std::size_t k = 0; k < place.Size(); ++k) place.Item(k).AsNumber(-kFarthest_m, kFarthest_m);
  p_FPayload_ = place.AsVector3();
}

ServoState TwinArm::Servo() const {
  const ArmState state = State();
  return {state.time, state.q, state.qd, reference_.q, servo_, fault_};
}

void TwinArm::Follow(const ServoReference& reference) {
  TT_CHECK(servo_ || mode_ != ArmMode::kMoving);
  if (mode_ != ArmMode::kReady && !servo_) return;
  servo_ = true;
  mode_ = ArmMode::kMoving;
  followed_ = reference;
  halt_s_ = 0.0;
}

void TwinArm::ClearServoFault() {
  if (mode_ == ArmMode::kMoving) return;
  mode_ = ArmMode::kReady;
  fault_.clear();
}

void TwinArm::AdvanceServo() {
  if (followed_) {
    reference_ = *followed_;
    followed_.reset();
    return;
  }
  // Where the last reference went in one step.
  const double step_s = model_.opt.timestep;
  reference_.q += step_s * (reference_.qd + 0.5 * step_s * reference_.qdd);
  reference_.qd += step_s * reference_.qdd;
  if (reference_.qd.cwiseAbs().maxCoeff() < kStandstill_rad_s) {
    reference_.qd.setZero();
    reference_.qdd.setZero();
    servo_ = false;
    mode_ = ArmMode::kReady;
    return;
  }
  if (halt_s_ == 0.0) {
    halt_qd_ = reference_.qd;
    halt_s_ = HaltTime_s(halt_qd_, kFastShare, kFastShortest_s);
    halted_s_ = 0.0;
  }
  halted_s_ += step_s;
  const double u = std::min(1.0, halted_s_ / halt_s_);
  const JointVector next_qd = 0.5 * (1.0 + std::cos(kPi * u)) * halt_qd_;
  reference_.qdd = (next_qd - reference_.qd) / step_s;
}

void TwinArm::Fault(const std::string& text) {
  mode_ = ArmMode::kProtectiveStop;
  servo_ = false;
  followed_.reset();
  halt_s_ = 0.0;
  fault_ = text;
  reference_ = {};
  reference_.q = TruePosition();
}

void TwinArm::AdvanceReference() {
  if (servo_) return AdvanceServo();
  reference_.qdd.setZero();
  if (mode_ != ArmMode::kMoving) {
    reference_.qd.setZero();
    return;
  }
  const double step_s = model_.opt.timestep;
  const TrajectoryPoint now = Sample(trajectory_, progress_s_);
  reference_.q = now.q;
  reference_.qd = rate_ * now.qd;
  const bool at_end = progress_s_ >= trajectory_.duration_s();
  if (at_end || (stopping_ && rate_ == 0.0)) {
    reference_.qd.setZero();
    done_ = at_end;
    mode_ = ArmMode::kReady;
    return;
  }
  double next_rate = rate_;
  if (stopping_) {
    ramp_elapsed_s_ += step_s;
    const double u = std::min(1.0, ramp_elapsed_s_ / ramp_s_);
    next_rate = u >= 1.0 ? 0.0 : ramp_from_ * 0.5 * (1.0 + std::cos(kPi * u));
  }
  // The mean of both rates: the path's time is the integral of the rate.
  progress_s_ =
      std::min(progress_s_ + 0.5 * (rate_ + next_rate) * step_s, trajectory_.duration_s());
  const TrajectoryPoint next = Sample(trajectory_, progress_s_);
  reference_.qdd = (next_rate * next.qd - reference_.qd) / step_s;
  rate_ = next_rate;
}

JointVector TwinArm::PayloadTorque() const {
  JointVector tau = JointVector::Zero();
  if (payload_kg_ == 0.0) return tau;
  const RigidTransform X_BF = BodyPose(data_, link6_) * arm_.X_6F;
  const Vector3 p_BC = X_BF * p_FPayload_;
  const Vector3 lift_N(0, 0, payload_kg_ * kGravity);
  for (int i = 0; i < kNumJoints; ++i) {
    const int joint = model_.dof_jntid[dof_[i]];
    const Vector3 axis(data_.xaxis + 3 * joint), anchor(data_.xanchor + 3 * joint);
    tau[i] = axis.cross(p_BC - anchor).dot(lift_N);
  }
  return tau;
}

void TwinArm::Control() {
  AdvanceReference();
  std::fill(acceleration_.begin(), acceleration_.end(), 0.0);
  for (int i = 0; i < kNumJoints; ++i) acceleration_[dof_[i]] = reference_.qdd[i];
  mj_mulM(&model_, &data_, inertia_.data(), acceleration_.data());
  const JointVector payload = PayloadTorque();
  for (int i = 0; i < kNumJoints; ++i) {
    const double error = reference_.q[i] - data_.qpos[qpos_[i]];
    if (std::abs(error) > kFollowingError_rad && mode_ == ArmMode::kMoving) {
      Fault("joint " + std::to_string(i + 1) + " is " + std::to_string(Degrees(error)) +
            " degrees behind its reference: blocked");
      return Control();
    }
    const double speed = reference_.qd[i];
    const ArmModel::Joint& joint = arm_.joints[i];
    const double wanted_Nm =
        kp_[i] * error + kv_[i] * (speed - data_.qvel[dof_[i]]) + data_.qfrc_bias[dof_[i]] +
        inertia_[dof_[i]] + joint.damping_Nms * speed +
        joint.friction_Nm * std::tanh(speed / kFrictionSpeed_rad_s) + payload[i];
    torque_Nm_[i] = std::clamp(wanted_Nm, -joint.max_effort_Nm, joint.max_effort_Nm);
    clamped_ = clamped_ || torque_Nm_[i] != wanted_Nm;
    data_.ctrl[motor_[i]] = torque_Nm_[i];
  }
}

}  // namespace tubetwin
