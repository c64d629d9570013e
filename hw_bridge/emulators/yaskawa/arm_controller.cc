#include "hw_bridge/emulators/yaskawa/arm_controller.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tubetwin {
namespace {

namespace sm = simple_message;

constexpr double kInMotionPulses = 30.0;
constexpr TimeNs kLeaving = std::chrono::milliseconds(50);
/// How much of its increments a controller runs changes by this much each period, at most.
constexpr double kRateStep = 0.01;
/// Increments that are longer than what an axis can do in their time are not taken at all.
constexpr double kTooLong = 1.5;

// Bits of the controller's status, by their I/O addresses.
constexpr std::int32_t kMajorAlarm = 50010, kMinorAlarm = 50011, kSystemAlarm = 50012,
                       kUserAlarm = 50013, kTeachMode = 50053, kPlayMode = 50054,
                       kRemoteMode = 50056, kOperating = 50070, kHeld = 50071, kServoPower = 50073,
                       kRemoteChosen = 80011, kNoExternalStop = 80025, kNoPendantStop = 80026,
                       kNoControllerStop = 80027, kContactStopped = 81702;
constexpr std::int32_t kFirstMinor = 4000, kFirstSystem = 8000, kFirstUser = 9000;

}  // namespace

ArmController::ArmController(ServoArm& arm, const ArmModel& model, const Settings& settings)
    : arm_(arm), model_(model), settings_(settings), servo_on_(settings.servo_on) {
  io_.SetOutput(kOutInitDone, true);
  io_.SetOutput(kOutServer, true);
}

std::optional<sm::NotReady> ArmController::WhyNot() const {
  if (alarm_ != 0) return sm::NotReady::kAlarm;
  if (emergency_stop_) return sm::NotReady::kEmergencyStop;
  if (!play_) return sm::NotReady::kNotPlay;
  if (!remote_) return sm::NotReady::kNotRemote;
  if (!servo_on_) return sm::NotReady::kServoOff;
  if (hold_) return sm::NotReady::kHold;
  if (contact_stop_) return sm::NotReady::kContactStop;
  if (increment_error_) return sm::NotReady::kIncrementMove;
  if (job_ == Job::kStopped) return sm::NotReady::kNotStarted;
  if (!io_.Output(kOutWaiting)) return sm::NotReady::kWaiting;
  return std::nullopt;
}

void ArmController::Tick(TimeNs now) {
  now_ = now;
  if (servo_on_at_ && now >= *servo_on_at_) {
    servo_on_at_.reset();
    servo_on_ = true;
    if (std::exchange(start_job_after_servo_, false)) RunJob();
  }
  if (left_at_ && now >= *left_at_ + kLeaving) {
    left_at_.reset();
    motion_client_ = false;
    queue_.Halt();
  }
  StepJob();
  // Drives that gave up are what a contact looks like from here.
  if (!contact_stop_ && !arm_.Servo().fault.empty()) ProtectiveStop();
  queue_.Cut();
  RunQueue();
}

void ArmController::StepJob() {
  if (job_ == Job::kWaiting && io_.Output(kOutDone)) {
    io_.SetOutput(kOutDone, false);
    return StopJob();
  }
  if (!next_line_at_ || now_ < *next_line_at_) return;
  if (job_ == Job::kStarted) {
    io_.SetOutput(kOutDone, false);
    io_.SetOutput(kOutWaiting, false);
    StopMotion();
    job_ = Job::kTimer;
    next_line_at_ = now_ + FromSeconds(settings_.job_start_s);
  } else if (!job_sticks_) {
    io_.SetOutput(kOutWaiting, true);
    job_ = Job::kWaiting;
    next_line_at_.reset();
  }
}

void ArmController::RunQueue() {
  // The increments are run by a task that lives as long as a motion client's connection.
  if (!motion_client_ || WhyNot()) return;
  const JointVector qd = queue_.Speed();
  for (int i = 0; i < kNumJoints; ++i) {
    if (std::abs(qd[i]) <= kTooLong * model_.joints[i].max_speed_rad_s) continue;
    increment_error_ = true;
    return StopMotion();
  }
  const JointVector commanded = arm_.Servo().q_commanded;
  if (const auto reference = queue_.Next(commanded, Rate(qd))) arm_.Follow(*reference);
}

double ArmController::Rate(const JointVector& qd) {
  double allowed = 1.0;
  if (speed_limit_m_s_ > 0.0) {
    const JacobianMatrix J = Jacobian(model_, arm_.Servo().q_commanded, RigidTransform::Identity());
    const double speed_m_s = (J * qd).head<3>().norm();
    if (speed_m_s > speed_limit_m_s_) allowed = speed_limit_m_s_ / speed_m_s;
  }
  rate_ += std::clamp(allowed - rate_, -kRateStep, kRateStep);
  return rate_;
}

void ArmController::JoinMotion() {
  motion_client_ = true;
  left_at_.reset();
  io_.SetOutput(kOutMotionClient, true);
}

void ArmController::LeaveMotion(bool at_once) {
  late_.reset();
  queue_.DropRest();
  io_.SetOutput(kOutMotionClient, false);
  if (!at_once) {
    left_at_ = now_;
    return;
  }
  motion_client_ = false;
  queue_.Halt();
}

ControllerIo& ArmController::io() {
  UpdateStatusBits();
  return io_;
}

void ArmController::UpdateStatusBits() {
  const auto between = [this](std::int32_t from, std::int32_t to) {
    return alarm_ >= from && alarm_ < to;
  };
  io_.SetBit(kMajorAlarm, between(1, kFirstMinor));
  io_.SetBit(kMinorAlarm, between(kFirstMinor, kFirstSystem));
  io_.SetBit(kSystemAlarm, between(kFirstSystem, kFirstUser));
  io_.SetBit(kUserAlarm, alarm_ >= kFirstUser);
  io_.SetBit(kTeachMode, !play_);
  io_.SetBit(kPlayMode, play_);
  io_.SetBit(kRemoteMode, remote_);
  io_.SetBit(kRemoteChosen, remote_);
  io_.SetBit(kOperating, running());
  io_.SetBit(kHeld, hold_);
  io_.SetBit(kServoPower, servo_on_);
  io_.SetBit(kNoExternalStop, true);
  io_.SetBit(kNoPendantStop, !emergency_stop_);
  io_.SetBit(kNoControllerStop, true);
  io_.SetBit(kContactStopped, contact_stop_);
}

bool ArmController::moving() const {
  const ServoState servo = arm_.Servo();
  const double off = (servo.q - servo.q_commanded).cwiseAbs().maxCoeff();
  return queue_holds_data() || servo.moving || off > kInMotionPulses * PulseAngle();
}

std::array<std::int32_t, kNumJoints> ArmController::Pulses() const {
  std::array<std::int32_t, kNumJoints> pulses{};
  const JointVector q = arm_.Servo().q;
  for (int i = 0; i < kNumJoints; ++i) {
    pulses[i] = static_cast<std::int32_t>(std::lround(q[i] / PulseAngle()));
  }
  return pulses;
}

sm::JointFeedback ArmController::Feedback() const {
  const ServoState servo = arm_.Servo();
  sm::JointFeedback feedback;
  feedback.q_rad = sm::ToSlots(servo.q);
  feedback.qd_rad_s = sm::ToSlots(servo.qd);
  return feedback;
}

sm::RobotStatus ArmController::Status() const {
  sm::RobotStatus status;
  status.drives_powered = servo_on_ ? 1 : 0;
  status.e_stopped = emergency_stop_ ? 1 : 0;
  status.error_code = alarm_;
  status.in_error = alarm_ != 0 ? 1 : 0;
  status.in_motion = moving() ? 1 : 0;
  status.mode = play_ ? sm::RobotStatus::kPlay : sm::RobotStatus::kTeach;
  status.motion_possible = WhyNot() ? 0 : 1;
  return status;
}

}  // namespace tubetwin
