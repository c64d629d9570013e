#include "hw_bridge/drivers/yaskawa/yaskawa_arm.h"

#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "hw_bridge/drivers/yaskawa/arm_session.h"
#include "hw_bridge/drivers/yaskawa/supervision.h"
#include "models/base/error.h"
#include "models/base/parallel.h"
#include "models/base/text.h"

namespace tubetwin {

struct YaskawaArm::Impl {
  Impl(const YaskawaConfig& config, const ArmModel& model, const CellClock& clock)
      : session(config, model, clock, loop) {
    session.Connect();
    if (config.hses_port != 0) supervision = Supervision(config);
    if (supervision && config.armed) ComparePulses();
    thread = std::jthread([this](const std::stop_token& stop) { Serve(stop); });
  }
  ~Impl() {
    thread.request_stop();
    loop.Wake();
  }

  static std::unique_ptr<HsesClient> Supervision(const YaskawaConfig& config) {
    // So short that states are read in time meanwhile.
    constexpr double kAnswer_s = 0.05;
    HsesConfig hses = SupervisionOf(config, 1);
    hses.answer_s = kAnswer_s;
    try {
      return std::make_unique<HsesClient>(hses);
    } catch (const Error&) {
      return nullptr;  // It makes texts better; `doctor` tells that it is missing.
    }
  }

  void ComparePulses() {
    const auto read = supervision->ReadPosition(hses::kPulses);
    const auto* position = std::get_if<hses::Position>(&read);
    if (position == nullptr) return;
    const auto scale = PulsesPerDegree(position->axes, session.State().q).pulses_per_degree;
    if (scale) session.UsePulses(*scale);
  }

  /// Without the lock: nothing moves in an alarm, and others may look at the state meanwhile.
  void NameAlarm(std::int32_t code) {
    constexpr int kTries = 4;
    std::string name;
    if (supervision) {
      const auto read = supervision->ReadAlarm();
      const auto* problem = std::get_if<HsesProblem>(&read);
      if (problem != nullptr && problem->silent && ++silences < kTries) return;
      const auto* alarm = std::get_if<hses::Alarm>(&read);
      if (alarm != nullptr && (code == 0 || alarm->code == static_cast<std::uint32_t>(code))) {
        name = Printable(alarm->name);
      }
    }
    silences = 0;
    const std::lock_guard lock(mutex);
    session.NameAlarm(name);
  }

  void Serve(const std::stop_token& stop) {
    KeepTime();
    std::chrono::nanoseconds wait{0};
    while (!stop.stop_requested()) {
      loop.Wait(wait);
      std::optional<std::int32_t> alarm;
      {
        const std::lock_guard lock(mutex);
        session.Turn();
        wait = session.Patience();
        alarm = session.UnnamedAlarm();
      }
      if (alarm) NameAlarm(*alarm);
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
  int silences = 0;                         ///< Of supervision, while an alarm has no name.
  std::unique_ptr<HsesClient> supervision;  ///< Of the thread, once it runs; may be missing.
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
