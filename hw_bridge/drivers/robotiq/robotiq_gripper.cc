#include "hw_bridge/drivers/robotiq/robotiq_gripper.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "hw_bridge/drivers/robotiq/modbus_client.h"
#include "models/base/error.h"
#include "models/base/parallel.h"

namespace tubetwin {
namespace {

using Wall = std::chrono::steady_clock;
using Result = ModbusClient::Result;

constexpr double kConnect_s = 8.0;
constexpr double kPoll_s = 0.010, kShortestPoll_s = 0.002;
constexpr double kAnswer_s = 0.2, kLongestAnswer_s = 0.4;
constexpr double kSilence_s = 1.0;
/// After a request that changes nothing the gripper never says that it moves.
constexpr double kGrace_s = 0.1, kShortestGrace_s = 0.04;
constexpr int kFirstMajorFault = 0x0A;
/// How long a gripper may tell of the request before the newest.
constexpr double kEcho_s = 0.3, kShortestEcho_s = 0.1;
/// Statuses that tell of somebody else's request: one may be an answer that came late.
constexpr int kForeignStatuses = 2;
/// Fingers this near to closed hold nothing, this near to wide open neither.
constexpr double kClosed_m = 0.004, kWide_m = 0.003;

std::chrono::nanoseconds Wait(double s) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(s * 1e9));
}
/// Cell time in wall time where the cell is slower; hosts and networks are never faster.
std::chrono::nanoseconds Patience(double s, double rate) {
  return Wait(s * std::max(1.0, 1.0 / rate));
}

std::string StatusText(const GripperStatus& status) {
  char text[64];
  std::snprintf(text, sizeof text, "gSTA %d, gFLT 0x%02X", static_cast<int>(status.activation),
                status.fault);
  const std::string fault = GripperFaultText(status.fault);
  return fault.empty() ? text : text + (" (" + fault + ")");
}

GripperObject ObjectOf(GripperMotion motion) {
  switch (motion) {
    case GripperMotion::kMoving:
      return GripperObject::kMoving;
    case GripperMotion::kStoppedOpening:
      return GripperObject::kContactOpening;
    case GripperMotion::kStoppedClosing:
      return GripperObject::kContactClosing;
    case GripperMotion::kArrived:
      return GripperObject::kAtPosition;
  }
  return GripperObject::kMoving;
}

}  // namespace

RobotiqGripper::RobotiqGripper(const RobotiqConfig& config, const CellClock& clock)
    : config_(config), clock_(clock) {
  config_.ValidateOrThrow();
  Connect();
  thread_ = std::jthread([this](std::stop_token stop) { Serve(stop); });
}

RobotiqGripper::~RobotiqGripper() = default;  // The thread ends first, within one answer's limit.

void RobotiqGripper::Connect() {
  const auto limit = Patience(kConnect_s, config_.rate);
  const auto deadline = Wall::now() + limit;
  client_ = std::make_unique<ModbusClient>(config_, limit);
  client_->SetAnswerLimit(std::min(Patience(kAnswer_s, config_.rate), Wait(kLongestAnswer_s)));
  GripperStatus status = AwaitStatus(deadline);
  const bool ready = status.activate && status.activation == GripperActivation::kDone &&
                     status.fault < kFirstMajorFault;
  if (!ready && config_.activate) {
    RequireEmptyFingers(status);
    const auto from_here = Wall::now() + limit;
    Activate(from_here);
    status = AwaitStatus(from_here);
  }
  Take(status);
  heard_ = Wall::now();
}

GripperStatus RobotiqGripper::AwaitStatus(Wall::time_point deadline) {
  while (true) {
    GripperRegisters words{};
    const Result result = client_->Read(words);
    std::string problem = client_->problem();
    if (result == Result::kDone) {
      const auto status = DecodeGripperStatus(words);
      if (const auto* understood = std::get_if<GripperStatus>(&status)) return *understood;
      problem = std::get<DecodeError>(status).reason;
    }
    if (result == Result::kLost || Wall::now() >= deadline) {
      throw Error(ErrorKind::kDevice, config_.Name() + ": no status of a gripper at slave " +
                                          std::to_string(config_.slave) + ": " + problem);
    }
    std::this_thread::sleep_for(Wait(kPoll_s));
  }
}

void RobotiqGripper::RequireEmptyFingers(const GripperStatus& status) const {
  const double opening_m = config_.scale.OpeningOf(status.position);
  if (opening_m < kClosed_m || opening_m > config_.scale.stroke_m - kWide_m) return;
  char opening[32];
  std::snprintf(opening, sizeof opening, "%.1f mm", 1e3 * opening_m);
  const std::string what = config_.Name() + ": needs activation (" + StatusText(status) +
                           "), which opens and closes its fingers; they stand " + opening +
                           " apart and may hold something";
  if (config_.confirm && config_.confirm(what + ": take it out first")) return;
  throw Error(ErrorKind::kDevice,
              what +
                  "\ntake it out and close the fingers by the maker's own program, or run at a "
                  "terminal and say so when asked");
}

void RobotiqGripper::Activate(Wall::time_point deadline) {
  GripperAction activate;
  activate.activate = true;
  // A major fault needs the rising edge, and so does an activation that went half way.
  for (const GripperAction& action : {GripperAction(), activate}) {
    while (true) {
      const Result result = client_->Write(EncodeGripperAction(action));
      if (result == Result::kDone) break;
      if (result == Result::kLost || Wall::now() >= deadline) {
        throw Error(ErrorKind::kDevice,
                    config_.Name() + ": does not let itself be activated: " + client_->problem());
      }
      std::this_thread::sleep_for(Wait(kPoll_s));
    }
  }
  while (true) {
    const GripperStatus status = AwaitStatus(deadline);
    if (status.activation == GripperActivation::kDone) return;
    if (Wall::now() >= deadline) {
      throw Error(ErrorKind::kDevice, config_.Name() + ": the activation is not done within 8 s: " +
                                          StatusText(status));
    }
    std::this_thread::sleep_for(Wait(kPoll_s));
  }
}

void RobotiqGripper::Command(const GripperCommand& command) {
  TT_CHECK(std::isfinite(command.opening_m) && std::isfinite(command.speed_m_s) &&
           std::isfinite(command.force_N));
  {
    const std::lock_guard lock(mutex_);
    action_ = GripperAction();
    action_.activate = action_.go_to = true;
    action_.position = config_.scale.PositionOf(command.opening_m);
    action_.speed = config_.scale.SpeedOf(command.speed_m_s);
    action_.force = config_.scale.ForceOf(command.force_N);
    fresh_ = pending_ = unsettled_ = ever_ = true;
    state_.object = GripperObject::kMoving;
    state_.requested_m = config_.scale.OpeningOf(action_.position);
  }
  commanded_.notify_one();
}

GripperState RobotiqGripper::State() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

std::string RobotiqGripper::LinkProblem() const {
  const std::lock_guard lock(mutex_);
  return lost_;
}

int RobotiqGripper::unanswered() const {
  const std::lock_guard lock(mutex_);
  return unanswered_;
}

void RobotiqGripper::Serve(const std::stop_token& stop) {
  KeepTime();
  const auto period = Wait(std::max(kShortestPoll_s, kPoll_s / config_.rate));
  while (!stop.stop_requested() && Exchange()) {
    std::unique_lock lock(mutex_);
    commanded_.wait_for(lock, stop, period, [this] { return fresh_; });
  }
}

bool RobotiqGripper::Exchange() {
  std::optional<GripperAction> action;
  {
    const std::lock_guard lock(mutex_);
    if (pending_) {
      action = action_;
      sent_ = Request{action_.go_to, action_.position};
    }
    fresh_ = false;
  }
  if (action) {
    const Result result = client_->Write(EncodeGripperAction(*action));
    if (!Heard(result == Result::kDone, result == Result::kLost)) return false;
    if (result != Result::kDone) return true;  // Again, unless there is a newer one.
    written_ = Wall::now();
    const std::lock_guard lock(mutex_);
    if (action_ == *action) pending_ = false;
  }
  GripperRegisters words{};
  const Result result = client_->Read(words);
  std::optional<GripperStatus> status;
  if (result == Result::kDone) {
    const auto decoded = DecodeGripperStatus(words);
    if (const auto* understood = std::get_if<GripperStatus>(&decoded)) status = *understood;
  }
  if (!Heard(status.has_value(), result == Result::kLost)) return false;
  if (status) Take(*status);
  return true;
}

bool RobotiqGripper::Heard(bool answered, bool lost) {
  const auto now = Wall::now();
  if (answered) {
    heard_ = now;
    return true;
  }
  {
    const std::lock_guard lock(mutex_);
    ++unanswered_;
  }
  const std::string problem = client_->problem();
  if (lost) {
    Lose(problem);
  } else if (now - heard_ > Patience(kSilence_s, config_.rate)) {
    Lose("no answer for 1 s" + (problem.empty() ? "" : ", the last problem was: " + problem));
  } else {
    return true;
  }
  return false;
}

void RobotiqGripper::Take(const GripperStatus& status) {
  const TimeNs now = clock_.Now();
  const auto grace = Wait(std::max(kShortestGrace_s, kGrace_s / config_.rate));
  const std::lock_guard lock(mutex_);
  state_.time = now;
  state_.activated = status.activate && status.activation == GripperActivation::kDone;
  state_.opening_m = config_.scale.OpeningOf(status.position);
  state_.fault = status.fault;
  if (state_.activated) JudgeRequest(status);
  if (!ever_) {
    state_.requested_m =
        status.go_to ? config_.scale.OpeningOf(status.position_request) : state_.opening_m;
    state_.object = status.go_to ? ObjectOf(status.motion) : GripperObject::kAtPosition;
    return;
  }
  // A status from before the request, or of another client's.
  if (pending_ || !status.go_to || status.position_request != action_.position) return;
  if (unsettled_) {
    if (status.motion != GripperMotion::kMoving && Wall::now() - written_ < grace) return;
    unsettled_ = false;
  }
  state_.object = ObjectOf(status.motion);
}

// With the lock. A gripper that is not activated says so itself.
void RobotiqGripper::JudgeRequest(const GripperStatus& status) {
  const Request said{status.go_to, status.position_request};
  const auto echo = Wait(std::max(kShortestEcho_s, kEcho_s / config_.rate));
  const bool may_be_old = !sent_ || pending_ || Wall::now() - written_ < echo;
  if (!told_ || said == sent_) told_ = said;
  if (said == sent_ || (may_be_old && said == told_)) {
    foreign_ = 0;
    return;
  }
  if (++foreign_ < kForeignStatuses || !state_.problem.empty()) return;
  const auto text = [this](const Request& request) -> std::string {
    if (!request.go_to) return "nowhere";
    char opening[32];
    std::snprintf(opening, sizeof opening, "to %.1f mm",
                  1e3 * config_.scale.OpeningOf(request.position));
    return opening;
  };
  state_.problem = "another client commands the gripper: it was told to go " + text(said) +
                   ", by this program " + (sent_ ? text(*sent_) : "nowhere");
}

void RobotiqGripper::Lose(const std::string& problem) {
  const std::lock_guard lock(mutex_);
  lost_ = config_.Name() + ": the link is lost: " + problem;
  state_.fault = kGripperFaultSilence;
}

}  // namespace tubetwin
