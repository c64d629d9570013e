#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hw_bridge/cell/servo_arm.h"
#include "hw_bridge/codecs/hses.h"
#include "hw_bridge/codecs/simple_message.h"
#include "hw_bridge/emulators/yaskawa/controller_io.h"
#include "hw_bridge/emulators/yaskawa/increment_queue.h"
#include "models/arm/arm.h"

namespace tubetwin {

/// How closely points are looked at.
enum class ArmServer {
  kMotoRos1,  ///< As MotoROS 1.9.12 does.
  kStrict,    ///< Refuses what that takes without a look: see README.md beside this room.
};

/// What a YRC1000 with MotoROS 1 does, without its sockets: servo power, job INIT_ROS, alarms,
/// hold, contact stop, the increment queue, and the answer to each request. One thread.
///
/// INIT_ROS tells by OUT#889 that it waits for motion and ends when OUT#890 is on; nothing turns
/// OUT#889 off when it ends. So the controller believes in a job that has just been started again
/// until its second line, and then for 50 ms does not.
class ArmController {
 public:
  struct Settings {
    double pulses_per_degree = 1000;
    double servo_on_s = 0.2;    ///< From the request to powered drives.
    double job_line_s = 0.005;  ///< From a job's start to what its first lines do.
    double job_start_s = 0.05;  ///< TIMER of INIT_ROS, to its WAIT.
    bool servo_on = false;      ///< At the start.
    ArmServer server = ArmServer::kMotoRos1;
  };
  /// `arm` and `model` must outlive it.
  ArmController(ServoArm& arm, const ArmModel& model, const Settings& settings);

  /// After every control period.
  void Tick(TimeNs now);

  // Motion port. A request has one answer: at once, or later by TakeLate(), before which no other
  // request is handled.
  struct Reaction {
    std::optional<simple_message::Message> answer;
    bool disconnect = false;  ///< The connection is closed, without an answer.
    /// Whatever was answered last is sent once more instead, if anything was.
    bool same_again = false;
  };
  Reaction Handle(const simple_message::Message& request);
  bool busy() const { return late_.has_value(); }
  std::optional<simple_message::Message> TakeLate();
  /// Somebody has connected: increments run, those that wait from an earlier client too.
  void JoinMotion();
  /// The motion client is gone. What it has sent still runs for 50 ms, until the tasks of its
  /// connection have ended; the rest waits for the next client. `at_once`: the newcomer has it
  /// ended.
  void LeaveMotion(bool at_once);
  /// A client that has left is still being seen to.
  bool leaving() const { return left_at_.has_value(); }
  bool queue_holds_data() const { return queue_.size() > 0; }

  // State port.
  simple_message::JointFeedback Feedback() const;
  simple_message::RobotStatus Status() const;

  /// I/O and registers, with the controller's status as it is now.
  ControllerIo& io();

  // Supervision.
  bool remote() const { return remote_; }
  bool held() const { return hold_; }
  bool servo_on() const { return servo_on_; }
  bool emergency_stop() const { return emergency_stop_; }
  std::int32_t alarm() const { return alarm_; }
  bool moving() const;
  bool running() const { return job_ != Job::kStopped; }
  /// At its WAIT.
  bool waiting() const { return job_ == Job::kWaiting; }
  bool contact_stop() const { return contact_stop_; }
  bool speed_limited() const { return speed_limit_m_s_ > 0.0; }
  double pulses_per_rad() const { return 1.0 / PulseAngle(); }
  const std::string& job() const { return job_name_; }
  std::array<std::int32_t, kNumJoints> Pulses() const;  ///< Measured.
  ServoState servo() const { return arm_.Servo(); }
  const ArmModel& model() const { return model_; }

  /// False with the drives in an alarm or emergency stop, or held.
  bool SwitchServo(bool on);
  void SetHold(bool on);
  void ResetAlarm();
  /// False when no job may start now.
  bool StartJob();
  void SelectJob(const std::string& name) { job_name_ = name; }

  // What happens to it.
  void ProtectiveStop();
  void EmergencyStop();
  void ReleaseEmergencyStop();
  /// `lasting`: cannot be reset until ClearAlarmCause().
  void RaiseAlarm(std::int32_t code, bool lasting);
  void ClearAlarmCause() { alarm_lasts_ = false; }
  /// The job does not get past its TIMER.
  void StickJob(bool sticks) { job_sticks_ = sticks; }
  /// The functional safety unit lets the flange move no faster; 0: no limit. Increments then take
  /// longer, and nothing else tells.
  void LimitSpeed(double limit_m_s) { speed_limit_m_s_ = limit_m_s; }
  void SetRemote(bool remote);
  void SetPlay(bool play);
  /// The next `count` points are refused.
  void RefusePoints(simple_message::Result result, std::int32_t subcode, int count);
  int points_taken() const { return points_taken_; }
  int busy_answers() const { return busy_answers_; }

 private:
  enum class Job { kStopped, kStarted, kTimer, kWaiting };
  struct Late {
    simple_message::MotionReply reply;  ///< When it succeeds.
    TimeNs until{0};
    bool servo_only = false;
  };

  /// Why external motion is not possible; nothing: it is.
  std::optional<simple_message::NotReady> WhyNot() const;
  Reaction Answered(simple_message::MotionReply reply) const;
  simple_message::MotionReply HandlePoint(const simple_message::JointPoint& point);
  Reaction HandlePoints(const simple_message::JointPointEx& points);
  struct Verdict {
    simple_message::Result result = simple_message::Result::kSuccess;
    std::int32_t subcode = 0;
  };
  Verdict JudgePoint(const simple_message::JointPoint& point);
  /// What is left to judge once group and fields are right.
  Verdict TakePoint(const simple_message::JointPoint& point);
  std::optional<std::int32_t> WhyNotBegin(const simple_message::JointPoint& point) const;
  bool TooFast(const simple_message::Slots& qd_rad_s, int slots) const;
  Reaction HandleControl(const simple_message::MotionControl& control);
  Reaction Unknown(simple_message::MotionReply reply) const;
  Reaction StartTrajectoryMode(simple_message::MotionReply reply);
  void PowerDrives();
  void RunJob();
  void StepJob();
  void StopJob();
  void StopMotion();
  void RunQueue();
  double Rate(const JointVector& qd);
  void UpdateStatusBits();
  double PulseAngle() const { return 1.0 / (settings_.pulses_per_degree * 180.0 / kPi); }

  ServoArm& arm_;
  const ArmModel& model_;
  Settings settings_;
  ControllerIo io_;
  IncrementQueue queue_;
  TimeNs now_{0};

  bool remote_ = true, play_ = true, servo_on_ = false, hold_ = false, emergency_stop_ = false;
  bool contact_stop_ = false, increment_error_ = false, job_sticks_ = false;
  double speed_limit_m_s_ = 0, rate_ = 1;
  bool motion_client_ = false;
  std::optional<TimeNs> left_at_;
  std::int32_t alarm_ = 0;
  bool alarm_lasts_ = false;
  Job job_ = Job::kStopped;
  std::string job_name_ = "INIT_ROS";
  std::optional<TimeNs> servo_on_at_, next_line_at_;
  std::optional<Late> late_;
  bool start_job_after_servo_ = false;

  simple_message::Result refusal_ = simple_message::Result::kInvalid;
  std::int32_t refusal_subcode_ = 0;
  int refusals_ = 0;
  int points_taken_ = 0, busy_answers_ = 0;
};

}  // namespace tubetwin
