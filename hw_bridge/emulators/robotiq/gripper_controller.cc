#include "hw_bridge/emulators/robotiq/gripper_controller.h"

#include <algorithm>
#include <array>
#include <utility>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr TimeNs kSilence = std::chrono::seconds(1);
constexpr int kFirstMajorFault = 0x0A;
constexpr double kActivationSpeed_m_s = 0.10, kActivationForce_N = 40.0;
/// The motor of moving fingers, 10 mA each: what the force lets it draw.
constexpr int kIdleCurrent = 5, kFullCurrent = 25;

/// Clients read and write more registers than have a meaning: the ROS 2 driver reads six.
constexpr int kRegisters = 16;
/// Fingers on their way that stand so long press on something.
constexpr TimeNs kPressing = std::chrono::milliseconds(20);

bool IsWithin(int start, int count, int first) {
  return start >= first && start + count <= first + kRegisters;
}

}  // namespace

bool GripperController::IsWritable(int start, int count) const {
  return IsWithin(start, count, action_start_);
}

bool GripperController::IsReadable(int start, int count) const {
  return IsWithin(start, count, status_start_) || IsWithin(start, count, action_start_);
}

std::vector<std::uint16_t> GripperController::Read(int start, int count) {
  TT_CHECK(IsReadable(start, count));
  const bool status = IsWithin(start, count, status_start_);
  const GripperRegisters known =
      status ? EncodeGripperStatus(Status()) : EncodeGripperAction(action_);
  if (status) silence_told_ = silent_;
  std::array<std::uint16_t, kRegisters> words{};
  std::copy(known.begin(), known.end(), words.begin());
  const auto* from = words.data() + (start - (status ? status_start_ : action_start_));
  return {from, from + count};
}

void GripperController::Write(int start, const std::vector<std::uint16_t>& values) {
  TT_CHECK(IsWritable(start, static_cast<int>(values.size())));
  const GripperRegisters known = EncodeGripperAction(action_);
  std::array<std::uint16_t, kRegisters> words{};
  std::copy(known.begin(), known.end(), words.begin());
  std::copy(values.begin(), values.end(), words.begin() + (start - action_start_));
  Take(DecodeGripperAction({words[0], words[1], words[2]}));
}

void GripperController::Heard(TimeNs now) {
  heard_ = now;
  if (silence_told_) silent_ = silence_told_ = false;
}

void GripperController::Take(const GripperAction& action) {
  const GripperAction before = action_;
  action_ = action;
  if (!action.activate) {
    Halt();
    phase_ = Phase::kReset;
    executed_ = delayed_ = false;
    return;
  }
  if (action.automatic_release) {
    if (before.automatic_release && before.activate) return;
    phase_ = Phase::kReleasing;
    executed_ = delayed_ = false;
    Move(action.release_opens ? scale_.stroke_m : 0.0, scale_.min_speed_m_s, scale_.min_force_N);
    return;
  }
  if (!before.activate) {
    if (raised_ >= kFirstMajorFault) raised_ = 0;
    phase_ = Phase::kActivating;
    executed_ = false;
    step_ = 0;
    NextStepOfActivation();
  }
  if (raised_ >= kFirstMajorFault) return;
  if (!action.go_to) {
    if (phase_ == Phase::kActive && before.go_to) Halt();
    executed_ = delayed_ = false;
  } else if (phase_ == Phase::kActivating) {
    delayed_ = true;
  } else if (phase_ == Phase::kActive && (!executed_ || before != action)) {
    Execute();
  }
}

void GripperController::Execute() {
  executed_ = true;
  delayed_ = lost_ = false;
  Move(scale_.OpeningOf(action_.position), scale_.SpeedFrom(action_.speed),
       scale_.ForceFrom(action_.force));
}

void GripperController::Move(double opening_m, double speed_m_s, double force_N) {
  gripper_.Command({opening_m, speed_m_s, force_N});
}

void GripperController::Halt() {
  const GripperState state = gripper_.State();
  if (state.object != GripperObject::kMoving) return;
  const bool closing = state.requested_m < state.opening_m;
  if (closing && now_ - still_since_ > kPressing) return;
  Move(state.opening_m, scale_.min_speed_m_s, scale_.ForceFrom(action_.force));
}

void GripperController::NextStepOfActivation() {
  if (step_ == 3) {
    phase_ = Phase::kActive;
    if (delayed_) Execute();
    return;
  }
  Move(step_ == 1 ? 0.0 : scale_.stroke_m, kActivationSpeed_m_s, kActivationForce_N);
  ++step_;
}

void GripperController::Tick(TimeNs now) {
  now_ = now;
  const double opening_m = gripper_.State().opening_m;
  if (opening_m != std::exchange(opening_m_, opening_m)) still_since_ = now;
  if (now - heard_ > kSilence) silent_ = true;
  if (raised_ >= kFirstMajorFault) return;
  if (gripper_.State().object == GripperObject::kMoving) return;
  if (phase_ == Phase::kActivating) NextStepOfActivation();
  if (phase_ == Phase::kReleasing) phase_ = Phase::kReleased;
}

int GripperController::Fault() const {
  if (raised_ != 0) return raised_;
  if (phase_ == Phase::kReleasing) return kGripperFaultReleasing;
  if (phase_ == Phase::kReleased) return kGripperFaultReleased;
  if (silent_) return kGripperFaultSilence;
  if (delayed_) return kGripperFaultDelayed;
  if (phase_ == Phase::kReset && action_.go_to) return kGripperFaultNotActivated;
  return 0;
}

GripperMotion GripperController::Motion() const {
  if (lost_) return GripperMotion::kArrived;
  switch (gripper_.State().object) {
    case GripperObject::kMoving:
      return GripperMotion::kMoving;
    case GripperObject::kContactOpening:
      return GripperMotion::kStoppedOpening;
    case GripperObject::kContactClosing:
      return GripperMotion::kStoppedClosing;
    case GripperObject::kAtPosition:
      return GripperMotion::kArrived;
  }
  return GripperMotion::kMoving;
}

GripperStatus GripperController::Status() const {
  GripperStatus status;
  status.activate = action_.activate;
  status.go_to = action_.go_to;
  status.activation = phase_ == Phase::kActive       ? GripperActivation::kDone
                      : phase_ == Phase::kActivating ? GripperActivation::kRunning
                                                     : GripperActivation::kReset;
  // Without rGTO these bits mean nothing; real grippers clear them.
  status.motion = !action_.go_to || delayed_ ? GripperMotion::kMoving : Motion();
  status.fault = static_cast<std::uint8_t>(Fault());
  status.position_request = action_.position;
  status.position =
      scale_.PositionOf(lost_ ? scale_.OpeningOf(action_.position) : gripper_.State().opening_m);
  if (gripper_.State().object == GripperObject::kMoving) {
    status.current = static_cast<std::uint8_t>(kIdleCurrent +
                                               action_.force * (kFullCurrent - kIdleCurrent) / 255);
  }
  return status;
}

void GripperController::RaiseFault(int code) {
  TT_CHECK(code >= kGripperFaultDelayed && code <= kGripperFaultReleased);
  raised_ = code;
  if (code < kFirstMajorFault) return;
  Halt();
  executed_ = delayed_ = false;
}

void GripperController::ClearFault() { raised_ = 0; }

}  // namespace tubetwin
