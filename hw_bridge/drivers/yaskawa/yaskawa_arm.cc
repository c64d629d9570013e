#include "hw_bridge/drivers/yaskawa/yaskawa_arm.h"

#include <mutex>
#include <stop_token>
#include <thread>

#include "hw_bridge/drivers/yaskawa/arm_session.h"
#include "models/base/error.h"
#include "models/base/parallel.h"

namespace tubetwin {

struct YaskawaArm::Impl {
  Impl(const YaskawaConfig& config, const ArmModel& model, const CellClock& clock)
      : session(config, model, clock, loop) {
    session.Connect();
    thread = std::jthread([this](const std::stop_token& stop) { Serve(stop); });
  }
  ~Impl() {
    thread.request_stop();
    loop.Wake();
  }

  void Serve(const std::stop_token& stop) {
    KeepTime();
    std::chrono::nanoseconds wait{0};
    while (!stop.stop_requested()) {
      loop.Wait(wait);
      const std::lock_guard lock(mutex);
      session.Turn();
      wait = session.Patience();
    }
    const std::lock_guard lock(mutex);
    session.Leave();
  }

  template <typename Command>
  auto Locked(Command command) {
    const std::lock_guard lock(mutex);
    return command(session);
  }

  NetLoop loop;
  std::mutex mutex;
  ArmSession session;   ///< Its sockets: of the thread, once it runs.
  std::jthread thread;  ///< Last: ends before what it uses.
};

YaskawaArm::YaskawaArm(const YaskawaConfig& config, const ArmModel& model, const CellClock& clock) {
  config.ValidateOrThrow();
  impl_ = std::make_unique<Impl>(config, model, clock);
}

YaskawaArm::~YaskawaArm() = default;

ArmState YaskawaArm::State() const {
  return impl_->Locked([](const ArmSession& session) { return session.State(); });
}

CommandResult YaskawaArm::Start(const CheckedTrajectory& trajectory) {
  const CommandResult result =
      impl_->Locked([&](ArmSession& session) { return session.Start(trajectory); });
  impl_->loop.Wake();
  return result;
}

CommandResult YaskawaArm::Append(const CheckedTrajectory& continuation) {
  const CommandResult result =
      impl_->Locked([&](ArmSession& session) { return session.Append(continuation); });
  impl_->loop.Wake();
  return result;
}

void YaskawaArm::Stop(StopKind kind) {
  impl_->Locked([kind](ArmSession& session) { session.Stop(kind); });
  impl_->loop.Wake();
}

void YaskawaArm::SetPayload(double mass_kg, const Vector3&) { TT_CHECK(mass_kg >= 0.0); }

CommandResult YaskawaArm::Recover() {
  const CommandResult result = impl_->Locked([](ArmSession& session) { return session.Recover(); });
  impl_->loop.Wake();
  return result;
}

}  // namespace tubetwin
