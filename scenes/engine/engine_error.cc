#include "scenes/engine/engine_error.h"

#include <csetjmp>
#include <cstring>
#include <mutex>
#include <utility>

#include <mujoco/mujoco.h>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr int kEngineVersion = 4000001;  // 4.0.1; 4.0.0 solves sparse systems wrongly.
static_assert(mjVERSION_HEADER == kEngineVersion, "headers must be those of MuJoCo 4.0.1");
constexpr std::size_t kMaxWarnings = 100;

// Where a fatal error of this thread jumps to. Plain data only: longjmp runs no destructors.
struct JumpTarget {
  std::jmp_buf buffer;
  JumpTarget* previous;
};
thread_local JumpTarget* t_target = nullptr;
thread_local char t_message[2048];

std::mutex g_warnings_mutex;
std::vector<std::string>& Warnings() {
  static std::vector<std::string> warnings;
  return warnings;
}

void ComposeMessage(const mjLogMessage& message) {
  std::snprintf(t_message, sizeof t_message, "MuJoCo: %s%s%s", message.subject,
                message.body ? ": " : "", message.body ? message.body : "");
}

// Global handler: any thread may enter.
void HandleMessage(const mjLogMessage* message) {
  if (message->level == mjLOG_ERROR) {
    ComposeMessage(*message);
    if (t_target != nullptr) std::longjmp(t_target->buffer, 1);
    throw Error(ErrorKind::kInternal, t_message);
  }
  if (message->level == mjLOG_WARNING) {
    const std::lock_guard<std::mutex> lock(g_warnings_mutex);
    if (Warnings().size() < kMaxWarnings) Warnings().push_back(message->subject);
  }
}

}  // namespace

std::string EngineVersion() { return mj_versionString(); }

void InitEngine() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (mj_version() != kEngineVersion) {
      throw Error(ErrorKind::kInternal, std::string("the MuJoCo library loaded here is ") +
                                            mj_versionString() +
                                            "; tubetwin is built for 4.0.1 and runs with no other");
    }
    mjLogConfig config = mju_getLogConfig();
    config.logto_console = false;
    config.logto_file = false;
    config.logfile[0] = '\0';
    mju_setLogConfig(config);
    mju_setLogHandler(HandleMessage);
  });
}

std::vector<std::string> TakeEngineWarnings() {
  const std::lock_guard<std::mutex> lock(g_warnings_mutex);
  return std::exchange(Warnings(), {});
}

namespace internal {

void RunGuarded(void (*call)(void*), void* context) {
  InitEngine();
  JumpTarget target;
  target.previous = t_target;
  t_target = &target;
  if (setjmp(target.buffer) != 0) {
    t_target = target.previous;
    throw Error(ErrorKind::kInternal, t_message);
  }
  try {
    call(context);
  } catch (...) {
    t_target = target.previous;
    throw;
  }
  t_target = target.previous;
}

}  // namespace internal
}  // namespace tubetwin
