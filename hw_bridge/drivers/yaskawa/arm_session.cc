#include "hw_bridge/drivers/yaskawa/arm_session.h"

#include <algorithm>
#include <utility>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin {
namespace {

namespace sm = simple_message;

constexpr double kConnect_s = 8.0;
constexpr double kAnswer_s = 0.4, kTrajectoryMode_s = 10.0;
constexpr double kSilence_s = 0.2, kSilenceAtRest_s = 1.0;  ///< Of the state stream.
constexpr auto kLeave = std::chrono::milliseconds(300), kHeartbeat = std::chrono::milliseconds(500);
constexpr auto kOverslept = std::chrono::milliseconds(60);  ///< Turns are 20 ms apart at most.
constexpr double kAtRest_rad_s = 0.02;
constexpr double kSettle_s = 1.0;
/// A controller may say that trajectory mode is on before the job has got to its WAIT: motion is
/// then not possible for 50 ms once more. Cell time.
constexpr double kJobWaits_s = 0.15, kJobMustWait_s = 1.0;
/// An arm that has just been stopped comes to rest by then.
constexpr double kComesToRest_s = 1.0;
const double kEndTolerance_rad = Radians(0.2);

}  // namespace

ArmSession::ArmSession(const YaskawaConfig& config, const ArmModel& arm, const CellClock& clock,
                       NetLoop& loop)
    : config_(config),
      arm_(arm),
      clock_(clock),
      loop_(loop),
      state_link_(loop, config.host, config.state_port),
      motion_link_(loop, config.host, config.motion_port) {}

std::chrono::nanoseconds ArmSession::Limit(double s) const {
  // Hosts and networks are never faster than the wall's clock.
  return std::chrono::nanoseconds(
      static_cast<std::int64_t>(1e9 * s * std::max(1.0, 1.0 / config_.rate)));
}

void ArmSession::Connect() {
  const auto deadline = Wall::now() + Limit(kConnect_s);
  state_link_.Connect(deadline);
  AwaitState(deadline);
  turned_ = Wall::now();
  if (!config_.armed) return;
  RequireRest(deadline);
  motion_link_.Connect(deadline);
  // Whatever an earlier connection has left waiting runs from here on: first of all, nothing moves.
  motion_link_.Send(sm::MotionControl{0, 0, sm::Command::kStopMotion, {}},
                    Wall::now() + Limit(kAnswer_s));
  Ask(Question::kWhyNotReady);
  AwaitAnswer(deadline);
  // A stop, an alarm or a mode is a person's matter.
  if (!answered_ready_ && OnlyNotStarted(answered_subcode_)) {
    latch_.reset();
    Ask(Question::kTrajectoryMode);
    AwaitAnswer(deadline);
  }
  // The state that follows the answer.
  while (lost_.empty() && (Settling() || question_ != Question::kNone) && Wall::now() < deadline) {
    loop_.Wait(std::chrono::milliseconds(5));
    Turn();
  }
  if (!lost_.empty()) throw Error(ErrorKind::kDevice, lost_);
}

bool ArmSession::Settling() const {
  if (statuses_ < believe_from_) return true;
  const double since_s = Now_s() - started_at_s_;
  return since_s < kJobWaits_s || (status_->motion_possible == 0 && since_s < JobLimit_s());
}

double ArmSession::JobLimit_s() const { return kJobMustWait_s * std::max(1.0, config_.rate); }

void ArmSession::RequireRest(Wall::time_point deadline) {
  const auto until = std::min(deadline, Wall::now() + Limit(kComesToRest_s));
  bool moved = false;
  const JointVector q = state_.q;
  while (status_->in_motion == 1) {
    moved = moved || state_.qd.cwiseAbs().maxCoeff() > kAtRest_rad_s ||
            (state_.q - q).cwiseAbs().maxCoeff() > kEndTolerance_rad;
    if (Wall::now() >= until || !state_link_.problem().empty()) {
      throw Error(ErrorKind::kDevice,
                  state_link_.name() + ": " + UncommandedMotion(moved) + "; nothing was sent");
    }
    loop_.Wait(std::chrono::milliseconds(5));
    TakeState();
  }
}

void ArmSession::AwaitState(Wall::time_point deadline) {
  while (!heard_ || !status_) {
    const std::string missing = !heard_ ? "joint feedback" : "robot status";
    if (!state_link_.problem().empty() || Wall::now() >= deadline) {
      const std::string& why = state_link_.problem();
      throw Error(ErrorKind::kDevice, state_link_.name() + ": no " + missing + " within 8 s" +
                                          (why.empty() ? "" : ": " + why));
    }
    loop_.Wait(std::chrono::milliseconds(20));
    TakeState();
  }
}

void ArmSession::AwaitAnswer(Wall::time_point deadline) {
  const char* what =
      question_ == Question::kTrajectoryMode ? "START_TRAJ_MODE" : "CHECK_MOTION_READY";
  while (question_ != Question::kNone && lost_.empty()) {
    if (Wall::now() >= deadline) {
      throw Error(ErrorKind::kDevice,
                  motion_link_.name() + ": no answer to " + what + " within 8 s");
    }
    loop_.Wait(std::chrono::milliseconds(20));
    Turn();
  }
  if (!lost_.empty()) throw Error(ErrorKind::kDevice, lost_);
}

void ArmSession::Ask(Question question) {
  const bool mode = question == Question::kTrajectoryMode;
  question_ = question;
  motion_link_.Send(
      sm::MotionControl{
          0, 0, mode ? sm::Command::kStartTrajectoryMode : sm::Command::kCheckMotionReady, {}},
      Wall::now() + Limit(mode ? kTrajectoryMode_s : kAnswer_s));
  sent_ = Wall::now();
}

std::chrono::nanoseconds ArmSession::Patience() const {
  if (!motion_) return std::chrono::milliseconds(20);
  constexpr double kTurn_s = 0.004;
  return std::chrono::nanoseconds(
      static_cast<std::int64_t>(std::clamp(1e9 * kTurn_s / config_.rate, 1e6, 4e6)));
}

void ArmSession::Turn() {
  // A host that was busy elsewhere: what came meanwhile is taken now.
  const auto slept = Wall::now() - turned_;
  if (slept > kOverslept) {
    state_link_.Forgive(slept);
    motion_link_.Forgive(slept);
  }
  turned_ = Wall::now();
  TakeState();
  TakeAnswers();
  if (!lost_.empty()) return;
  Watch();
  if (!lost_.empty() || !config_.armed) return;
  Send();
  FinishMotion();
}

void ArmSession::TakeState() {
  const StateLink::News news = state_link_.Take();
  if (news.feedback && lost_.empty()) {
    const TimeNs now = clock_.Now();
    const JointVector q = sm::ToJoints(news.feedback->q_rad);
    const double passed_s = Seconds(now - state_.time);
    if ((news.feedback->valid_fields & sm::kVelocity) != 0) {
      state_.qd = sm::ToJoints(news.feedback->qd_rad_s);
    } else if (heard_ && passed_s > 0.0) {
      state_.qd = (q - state_.q) / passed_s;
    }
    state_.q = q;
    state_.time = now;
    heard_ = true;
    if (motion_) {
      state_.progress_s = std::max(state_.progress_s, motion_->Progress_s(Seconds(now)));
    }
  }
  if (news.status) {
    status_ = news.status;
    ++statuses_;
  }
}

void ArmSession::TakeAnswers() {
  for (const MotionLink::Answer& answer : motion_link_.Take()) {
    const auto* control = std::get_if<sm::MotionControl>(&answer.request);
    if (control != nullptr && (control->command == sm::Command::kCheckMotionReady ||
                               control->command == sm::Command::kStartTrajectoryMode)) {
      TakeAnswerToQuestion(answer.reply);
    } else if (!motion_ && control != nullptr && control->command == sm::Command::kStopMotion &&
               answer.reply.result != sm::Result::kSuccess) {
      Lose(motion_link_.name() + ": STOP_MOTION was answered with " +
           sm::ToString(answer.reply.result));
    } else if (motion_) {
      const auto problem = motion_->Take(answer.request, answer.reply, Now_s());
      if (problem) TakeRefusal(*problem);
    }
  }
}

void ArmSession::TakeAnswerToQuestion(const sm::MotionReply& reply) {
  const Question asked = std::exchange(question_, Question::kNone);
  answered_ready_ = reply.result == sm::Result::kSuccess;
  answered_subcode_ = reply.subcode;
  if (asked == Question::kTrajectoryMode) {
    if (answered_ready_) {
      started_at_s_ = Now_s();
      latch_.reset();
      state_.done = true;
      commanded_.reset();
    } else {
      ArmTrouble trouble = TroubleOf(reply.subcode);
      trouble.text = "START_TRAJ_MODE was refused: " + trouble.text;
      // What the arm stood in before is still so.
      if (latch_) trouble.mode = latch_->mode;
      latch_ = trouble;
    }
  } else if (!answered_ready_) {
    Latch(TroubleOf(reply.subcode), reply.subcode);
  } else if (pending_) {
    Latch(*pending_);
  }
  pending_.reset();
  // The next status may have been on its way before the answer.
  constexpr int kOnTheWay = 1;
  believe_from_ = statuses_ + kOnTheWay + 1;
}

void ArmSession::TakeRefusal(const StreamedMotion::Problem& problem) {
  if (problem.subcode != 0) {
    return Latch({TroubleOf(problem.subcode).mode, problem.text}, problem.subcode);
  }
  // A stop or an alarm may be what is behind it.
  DropMotion();
  pending_ = ArmTrouble{ArmMode::kFault, problem.text};
  if (question_ == Question::kNone) Ask(Question::kWhyNotReady);
}

void ArmSession::Watch() {
  if (!state_link_.problem().empty()) {
    return Lose(state_link_.name() + ": " + state_link_.problem());
  }
  const double limit_s = motion_ ? kSilence_s : kSilenceAtRest_s;
  if (state_link_.Silence() > Limit(limit_s)) {
    return Lose(state_link_.name() + ": no joint feedback for " + Number(limit_s) + " s");
  }
  if (!config_.armed || !status_) return;
  if (!motion_link_.problem().empty()) {
    return Lose(motion_link_.name() + ": " + motion_link_.problem());
  }
  if (question_ != Question::kNone || statuses_ < believe_from_) return;
  if (const auto trouble = TroubleOf(*status_)) return Latch(*trouble);
  if (status_->motion_possible == 0 && !latch_ && !Settling()) Ask(Question::kWhyNotReady);
}

void ArmSession::Send() {
  if (!motion_link_.open()) return;
  const bool stop = motion_ && motion_->StopDue();
  if (motion_link_.waiting() && !stop) return;
  if (motion_) {
    if (const auto request = motion_->Next(Now_s())) {
      motion_link_.Send(*request, Wall::now() + Limit(kAnswer_s));
      sent_ = Wall::now();
    }
  } else if (recover_) {
    recover_ = false;
    Ask(Question::kTrajectoryMode);
  } else if (Wall::now() - sent_ > kHeartbeat) {
    motion_link_.Send(sm::Ping{}, Wall::now() + Limit(kAnswer_s));
    sent_ = Wall::now();
  }
}

void ArmSession::FinishMotion() {
  if (!motion_ || !motion_->over() || motion_link_.waiting()) {
    over_at_.reset();
    return;
  }
  if (!over_at_) {
    over_at_ = statuses_;
    over_since_s_ = Now_s();
    return;
  }
  const bool settled = statuses_ > *over_at_ && status_->in_motion == 0 &&
                       state_.qd.cwiseAbs().maxCoeff() < kAtRest_rad_s;
  const bool short_of_end = motion_->stream().finished() && !motion_->halted();
  int worst = 0;
  const double off_rad = (state_.q - motion_->q_last()).cwiseAbs().maxCoeff(&worst);
  if (settled && (!short_of_end || off_rad <= kEndTolerance_rad)) {
    return EndMotion(!motion_->stopped());
  }
  if (short_of_end && Now_s() - over_since_s_ > kSettle_s * std::max(1.0, config_.rate)) {
    Latch({ArmMode::kFault, "joint " + std::to_string(worst + 1) + " is " +
                                Number(Degrees(off_rad)) +
                                " degrees from where the motion ends, 0.2 allowed"});
  }
}

void ArmSession::EndMotion(bool done) {
  state_.planned_s = motion_->stream().planned_s();
  state_.done = done;
  if (done) {
    state_.progress_s = state_.planned_s;
    commanded_ = motion_->q_last();
  } else {
    state_.progress_s = motion_->stream().NearestTime(state_.q, state_.progress_s);
    commanded_.reset();
  }
  motion_.reset();
  over_at_.reset();
}

void ArmSession::DropMotion() {
  if (!motion_) return;
  EndMotion(false);
  motion_link_.Send(sm::MotionControl{0, 0, sm::Command::kStopMotion, {}},
                    Wall::now() + Limit(kAnswer_s));
}

void ArmSession::Latch(const ArmTrouble& trouble, std::int32_t subcode) {
  if (!latch_ || Outweighs(trouble, *latch_)) {
    latch_ = trouble;
    const std::int32_t code = status_ ? std::max(0, status_->error_code) : 0;
    const bool alarm = code > 0 || subcode == static_cast<std::int32_t>(sm::NotReady::kAlarm);
    if (alarm && trouble.mode == ArmMode::kFault && config_.hses_port != 0) {
      unnamed_alarm_ = code;
      // A refusal has dropped the motion before the controller was asked why.
      alarm_ended_motion_ = motion_.has_value() || pending_.has_value();
    }
  }
  DropMotion();
}

void ArmSession::NameAlarm(const std::string& name) {
  unnamed_alarm_.reset();
  alarm_ended_motion_ = false;
  if (latch_ && !name.empty()) latch_->text += ": " + name;
}

void ArmSession::Lose(const std::string& why) {
  lost_ = why;
  question_ = Question::kNone;
  DropMotion();
}

void ArmSession::Leave() {
  if (!config_.armed || !motion_link_.open()) return;
  DropMotion();
  if (!lost_.empty()) return;
  motion_link_.Send(sm::MotionControl{0, 0, sm::Command::kStopTrajectoryMode, {}},
                    Wall::now() + Limit(kAnswer_s));
  const auto until = Wall::now() + kLeave;
  while (motion_link_.waiting() && motion_link_.open() && Wall::now() < until) {
    loop_.Wait(std::chrono::milliseconds(5));
    motion_link_.Take();
  }
}

}  // namespace tubetwin
