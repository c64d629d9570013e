#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hw_bridge/drivers/yaskawa/arm_trouble.h"
#include "hw_bridge/drivers/yaskawa/motion_link.h"
#include "hw_bridge/drivers/yaskawa/state_link.h"
#include "hw_bridge/drivers/yaskawa/streamed_motion.h"
#include "hw_bridge/drivers/yaskawa/yaskawa_config.h"

namespace tubetwin {

/// YaskawaArm without its thread and lock. Only Connect() and Leave() wait.
///
/// The reason why a motion ended early or the controller is not ready is kept until Recover(), even
/// when somebody clears it at the pendant.
class ArmSession {
 public:
  ArmSession(const YaskawaConfig& config, const ArmModel& arm, const CellClock& clock,
             NetLoop& loop);

  /// Connects, awaits the first state and, when armed, makes sure of trajectory mode; a stop or an
  /// alarm is left as it is. An arm in motion is refused before the motion port is connected, which
  /// might make it go on. The first message there is STOP_MOTION. Throws Error(kDevice).
  void Connect();
  /// One turn of the I/O thread: takes what came, sends what is due.
  void Turn();
  /// How long the next turn may wait for something to come in.
  std::chrono::nanoseconds Patience() const;
  /// Stops a motion, ends trajectory mode. At most 0.4 s.
  void Leave();

  /// The number of an alarm whose name would be of use, 0 for whichever it is; the motion it ended
  /// counts as running until NameAlarm(), with an empty name where nobody knows.
  std::optional<std::int32_t> UnnamedAlarm() const { return unnamed_alarm_; }
  void NameAlarm(const std::string& name);
  /// What the encoders really have, in place of the configuration's word.
  void UsePulses(double pulses_per_degree) { config_.pulses_per_degree = pulses_per_degree; }

  ArmState State() const;
  CommandResult Start(const CheckedTrajectory& trajectory);
  CommandResult Append(const CheckedTrajectory& continuation);
  void Stop(StopKind kind);
  CommandResult Recover();

 private:
  using Wall = std::chrono::steady_clock;
  enum class Question { kNone, kWhyNotReady, kTrajectoryMode };

  double Now_s() const { return Seconds(clock_.Now()); }
  /// Wall time of a limit in cell time.
  std::chrono::nanoseconds Limit(double s) const;
  void AwaitState(Wall::time_point deadline);
  void RequireRest(Wall::time_point deadline);
  void AwaitAnswer(Wall::time_point deadline);
  void Ask(Question question);
  /// What the controller says of itself may still be from before trajectory mode, or from before
  /// its job has got to its WAIT.
  bool Settling() const;
  double JobLimit_s() const;

  void TakeState();
  void TakeAnswers();
  void TakeAnswerToQuestion(const simple_message::MotionReply& reply);
  void TakeRefusal(const StreamedMotion::Problem& problem);
  void Watch();
  void Send();
  void FinishMotion();
  void EndMotion(bool done);
  /// Clears what the controller still has of the motion.
  void DropMotion();
  /// `subcode`: what the controller said; an alarm's name is then asked for.
  void Latch(const ArmTrouble& trouble, std::int32_t subcode = 0);
  void Lose(const std::string& why);
  std::optional<std::string> WhyNotStart(const JointTrajectory& trajectory) const;
  /// What hinders motion while none is under way.
  std::optional<ArmTrouble> Hindrance() const;
  /// Where the controller holds the arm.
  JointVector StartPoint() const;

  YaskawaConfig config_;
  const ArmModel& arm_;
  const CellClock& clock_;
  NetLoop& loop_;
  StateLink state_link_;
  MotionLink motion_link_;

  ArmState state_;  ///< Time, q and qd of the newest feedback; the last motion's end.
  bool heard_ = false;
  std::optional<simple_message::RobotStatus> status_;
  int statuses_ = 0;            ///< That came.
  int believe_from_ = 0;        ///< Older ones may be from before the last change.
  double started_at_s_ = -1e9;  ///< When trajectory mode was said to be on.
  std::string lost_;            ///< Why the link is lost; empty: it is not.
  std::optional<ArmTrouble> latch_;
  /// What ended a motion, until the controller has said whether it knows more of it.
  std::optional<ArmTrouble> pending_;
  std::optional<std::int32_t> unnamed_alarm_;
  bool alarm_ended_motion_ = false;
  Question question_ = Question::kNone;
  bool recover_ = false;         ///< Somebody asked for it.
  bool answered_ready_ = false;  ///< The last question's answer.
  std::int32_t answered_subcode_ = 0;

  std::optional<StreamedMotion> motion_;
  std::optional<int> over_at_;  ///< Statuses that had come when the motion was over.
  double over_since_s_ = 0;
  std::optional<JointVector> commanded_;  ///< Where the controller holds the arm, where known.
  Wall::time_point sent_{}, turned_{};
};

}  // namespace tubetwin
