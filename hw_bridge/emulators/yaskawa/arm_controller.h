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

/// What a YRC1000 with MotoROS 1 does, without its sockets: servo power, job INIT_ROS, alarms,
/// hold, contact stop, the increment queue, and the answer to each request. One thread.
class ArmController {
 public:
  struct Settings {
    double pulses_per_degree = 1000;
    double servo_on_s = 0.2;    ///< From the request to powered drives.
    double job_start_s = 0.05;  ///< TIMER of INIT_ROS, to its WAIT.
    bool servo_on = false;      ///< At the start.
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
  };
  Reaction Handle(const simple_message::Message& request);
  bool busy() const { return late_.has_value(); }
  std::optional<simple_message::Message> TakeLate();
  /// The motion client is gone: with it goes its increment task.
  void DropMotion();
  bool queue_holds_data() const { return !queue_.empty(); }

  // State port.
  simple_message::JointFeedback Feedback() const;
  simple_message::RobotStatus Status() const;

  /// I/O and registers; the controller writes its status outputs.
  ControllerIo& io() { return io_; }

  // Supervision.
  bool remote() const { return remote_; }
  bool held() const { return hold_; }
  bool servo_on() const { return servo_on_; }
  bool emergency_stop() const { return emergency_stop_; }
  std::int32_t alarm() const { return alarm_; }
  bool moving() const;
  bool running() const { return job_ != Job::kStopped; }
  bool contact_stop() const { return contact_stop_; }
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
  void SetRemote(bool remote);
  void SetPlay(bool play);
  /// The next `count` points are refused.
  void RefusePoints(simple_message::Result result, std::int32_t subcode, int count);
  int points_taken() const { return points_taken_; }
  int busy_answers() const { return busy_answers_; }

 private:
  enum class Job { kStopped, kStarting, kWaiting };
  struct Late {
    simple_message::MotionReply reply;  ///< When it succeeds.
    TimeNs until{0};
    bool servo_only = false;
  };

  /// Why external motion is not possible; nothing: it is.
  std::optional<simple_message::NotReady> WhyNot() const;
  Reaction Answered(simple_message::MotionReply reply) const;
  simple_message::MotionReply HandlePoint(const simple_message::JointPoint& point);
  std::optional<std::int32_t> WhyInvalid(const simple_message::JointPoint& point) const;
  Reaction HandleControl(const simple_message::MotionControl& control);
  Reaction StartTrajectoryMode(simple_message::MotionReply reply);
  void PowerDrives();
  void StartWaiting();
  void StopJob();
  void StopMotion();
  void UpdateOutputs();
  double PulseAngle() const { return 1.0 / (settings_.pulses_per_degree * 180.0 / kPi); }

  ServoArm& arm_;
  const ArmModel& model_;
  Settings settings_;
  ControllerIo io_;
  IncrementQueue queue_;
  TimeNs now_{0};

  bool remote_ = true, play_ = true, servo_on_ = false, hold_ = false, emergency_stop_ = false;
  bool contact_stop_ = false;
  std::int32_t alarm_ = 0;
  bool alarm_lasts_ = false;
  Job job_ = Job::kStopped;
  std::string job_name_ = "INIT_ROS";
  std::optional<TimeNs> servo_on_at_, waiting_at_;
  std::optional<Late> late_;
  bool start_job_after_servo_ = false;

  simple_message::Result refusal_ = simple_message::Result::kInvalid;
  std::int32_t refusal_subcode_ = 0;
  int refusals_ = 0;
  int points_taken_ = 0, busy_answers_ = 0;
};

}  // namespace tubetwin
