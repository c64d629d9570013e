#pragma once

#include <string>
#include <type_traits>
#include <vector>

namespace tubetwin {

/// Makes MuJoCo safe to use from this program: refuses any library but 4.0.1 (throws
/// Error(kInternal) naming both versions) and routes every engine message here, so that a fatal
/// engine error becomes an Error instead of ending the process, and nothing is printed or written
/// to MUJOCO_LOG.TXT. Done once per process; MakeSpec (mj_handles.h) calls it. Thread safe.
void InitEngine();

/// Version of the loaded library, "4.0.1".
std::string EngineVersion();

/// The engine's warnings since the last call, oldest first, of all threads (at most 100 are kept).
/// Thread safe. Tests use it: a warning that nobody expects is a failure.
std::vector<std::string> TakeEngineWarnings();

namespace internal {
void RunGuarded(void (*call)(void*), void* context);
}

/// Runs `call`, which calls into MuJoCo; a fatal engine error inside throws Error(kInternal) with
/// the engine's text. The error leaves `call` by longjmp: no object with a destructor may live in
/// it across an engine call. An mjData that was in use is spoilt afterwards, the mjModel is not.
/// Outside a guard a fatal error throws through the engine's own frames, which works with this
/// library but leaks what the engine had allocated.
template <class Call>
void GuardEngine(Call&& call) {
  using Plain = std::remove_reference_t<Call>;
  internal::RunGuarded([](void* context) { (*static_cast<Plain*>(context))(); }, &call);
}

}  // namespace tubetwin
