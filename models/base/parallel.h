#pragma once

#include <functional>

namespace tubetwin {

/// How many threads a call may use; one unless the caller says otherwise. Results never depend on
/// it.
struct Parallelism {
  int threads = 1;
  /// All cores of this machine.
  static Parallelism All();
};

/// Calls `body(index, worker)` once for every index in [0, count), `worker` in [0, threads).
/// Returns when all have run; joins its threads. The exception of the lowest failing index is
/// rethrown. Results must be written per index, scratch kept per worker.
void ParallelFor(int count, Parallelism parallelism,
                 const std::function<void(int index, int worker)>& body);

/// From here on the calling thread, and threads that it starts, give way to the other threads of
/// this program (POSIX nice value + 5): for computing beside what must keep time.
void GiveWay();

/// Asks the system to run the calling thread, but not threads that it starts, before all that
/// compute: for threads that keep time and mostly sleep. Where the user may not ask for that (no
/// CAP_SYS_NICE) all stays as it is.
void KeepTime();

}  // namespace tubetwin
