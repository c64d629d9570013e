// What happens to a controller, by its own functions and from outside.

#include "hw_bridge/emulators/yaskawa/arm_controller.h"

namespace tubetwin {

void ArmController::StopMotion() { queue_.Clear(); }  // The arm halts without a reference.

void ArmController::PowerDrives() { servo_on_at_ = now_ + FromSeconds(settings_.servo_on_s); }

void ArmController::RunJob() {
  job_ = Job::kStarted;
  next_line_at_ = now_ + FromSeconds(settings_.job_line_s);
}

void ArmController::StopJob() {
  job_ = Job::kStopped;
  next_line_at_.reset();
  StopMotion();
}

bool ArmController::SwitchServo(bool on) {
  if (!on) {
    servo_on_ = false;
    servo_on_at_.reset();
    start_job_after_servo_ = false;
    StopJob();
    return true;
  }
  if (emergency_stop_ || alarm_ != 0 || hold_) return false;
  if (!servo_on_) PowerDrives();
  return true;
}

void ArmController::SetHold(bool on) {
  // A hold ends the job; only a start begins it again.
  if (on) StopJob();
  hold_ = on;
}

void ArmController::ResetAlarm() {
  if (!alarm_lasts_) alarm_ = 0;
}

bool ArmController::StartJob() {
  if (emergency_stop_ || alarm_ != 0 || hold_ || !servo_on_ || !play_ || !remote_) return false;
  RunJob();
  return true;
}

void ArmController::ProtectiveStop() {
  contact_stop_ = true;
  StopMotion();
}

void ArmController::EmergencyStop() {
  emergency_stop_ = true;
  SwitchServo(false);
}

void ArmController::ReleaseEmergencyStop() { emergency_stop_ = false; }

void ArmController::RaiseAlarm(std::int32_t code, bool lasting) {
  alarm_ = code;
  alarm_lasts_ = lasting;
  SwitchServo(false);
}

void ArmController::SetRemote(bool remote) {
  remote_ = remote;
  if (!remote) StopJob();
}

void ArmController::SetPlay(bool play) {
  play_ = play;
  if (!play) StopJob();
}

void ArmController::RefusePoints(simple_message::Result result, std::int32_t subcode, int count) {
  refusal_ = result;
  refusal_subcode_ = subcode;
  refusals_ = count;
}

}  // namespace tubetwin
